// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Searches for joints and plans.

#include <duet/core/compiled.hpp>

#define DUET_DEFINES_COMPILED
#undef DUET_COMPILED_TEMPLATE
#define DUET_COMPILED_TEMPLATE template

#include <duet/robotics/enclosing_capsule.hpp>
#include <duet/robotics/goals.hpp>
#include <duet/robotics/inverse_kinematics.hpp>
#include <duet/robotics/plan_screw_motion.hpp>
#include <duet/robotics/start_search.hpp>
