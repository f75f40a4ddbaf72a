// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/robotics/all_inverse_kinematics.hpp>
#include <duet/robotics/bounding_capsules.hpp>
#include <duet/robotics/choose_start.hpp>
#include <duet/robotics/clearance.hpp>
#include <duet/robotics/closed_tree.hpp>
#include <duet/robotics/differentiable_branch.hpp>
#include <duet/robotics/follow_path.hpp>
#include <duet/robotics/goals.hpp>
#include <duet/robotics/inverse_kinematics.hpp>
#include <duet/robotics/loop_motion.hpp>
#include <duet/robotics/objective.hpp>
#include <duet/robotics/pairs_apart.hpp>
#include <duet/robotics/plan_screw_motion.hpp>
#include <duet/robotics/self_motion_curves.hpp>
#include <duet/robotics/time_parametrised.hpp>

/// \file
/// All of duet::robotics: inverse kinematics, all solutions, path planning, obstacles, time
/// parametrisation, closed chains.
