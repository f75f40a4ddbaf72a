// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/robotics/follow_path.hpp>

/// \file
/// Joint paths along the screw motion between two poses.

namespace duet {

namespace detail {

/// Shorter screw motion between two poses (N19), as a function of τ.
template <class T>
[[nodiscard]] path_function screw_path(const dual_quaternion<T>& first,
                                       const dual_quaternion<T>& last) {
  dual_quaternion<T> between = conj(first) * normalized(last);
  if (innermost(between.w()) < 0) {
    between = -between;
  }
  return [first, half = log_vector(between, "plan_screw_motion")](T tau) {
    return dual_quaternion<T>(first * exp(dual_vector<T>(half * screw_dual<T>(tau))));
  };
}

#ifdef DUET_COMPILED
DUET_COMPILED_TEMPLATE path_function screw_path(const dual_quaternion<double>&,
                                                const dual_quaternion<double>&);
#endif

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
[[nodiscard]] motion_plan<C::joints>
plan_screw_motion(const C& chain, const Start& start, const dual_quaternion<double>& goal,
                  const plan_options& options = {}, const Objective& objective = {},
                  const Scene& around = {}) {
  detail::require_start(chain, start, "plan_screw_motion");
  detail::require_pose(goal, "plan_screw_motion", "the goal");
  const detail::chain_model<C> model(chain);
  const auto first = model.unscaled_pose(model.at(model.joints(start)).tip);
  const auto target = detail::screw_path(first, goal);
  return detail::follow(chain, start, target, {0, 1}, options, objective, around, true);
}

DUET_ASKS_FOR_ONE_CONFIGURATION(plan_screw_motion, motion_plan<C::joints>)

} // namespace duet
