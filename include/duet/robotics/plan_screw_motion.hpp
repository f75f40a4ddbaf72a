// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/chain_view.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/robotics/follow_path.hpp>

/// \file
/// Joint paths along the screw motion between two poses.

namespace duet {

namespace detail {
DUET_ABI_BEGIN

/// `duet::plan_screw_motion` of a chain of any type.
motion_plan plan_screw_motion(const chain_view& chain,
                              const Eigen::Ref<const Eigen::VectorXd>& start,
                              const dual_quaternion<double>& goal, const plan_options& options,
                              const solution_preferences& preferences);

DUET_ABI_END
} // namespace detail

/// Joint path that moves the tip of a chain from its pose at `start` to the pose `goal` along the
/// shorter screw motion between the two (N19): `follow_path` along it.
///
/// Resolves what the notes' algorithm (N24, `printed_screw_plan`) leaves open: targets are taken
/// from the initial motion, so nothing drifts; each is met exactly and within the limits; the step
/// in τ follows from the distance of the tip from the screw half way between waypoints; and the arm
/// makes a self-motion where it would get stuck otherwise.
///
/// \return the plan; unless `reason` is `reached`, the part of it up to there. It is the start
/// alone if the goal is certainly `out_of_reach`: farther away than the total length of the links
/// and prismatic joints between the first joint and the last
/// \throws invalid_input for a start outside the limits and for a goal that is not a pose, and as
/// `follow_path`
template <SerialChain C, VectorLike Start, class Objective = no_objective, class Scene = no_scene>
[[nodiscard]] motion_plan
plan_screw_motion(const C& chain, const Start& start, const dual_quaternion<double>& goal,
                  const plan_options& options = {}, const Objective& objective = {},
                  const Scene& around = {}) {
  return detail::plan_screw_motion(chain, detail::start_of(chain, start), goal, options,
                                   detail::preferences_of(chain, objective, around));
}

DUET_ASKS_FOR_ONE_CONFIGURATION(plan_screw_motion, motion_plan)

} // namespace duet
