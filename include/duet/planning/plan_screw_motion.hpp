// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/screw.hpp>
#include <duet/planning/follow_path.hpp>
#include <duet/planning/reach.hpp>

/// \file
/// Joint paths along the screw motion between two poses.

namespace duet {

/// Joint coordinates that take the tip of a chain from where it is at `start` to the pose `goal`
/// along the screw motion between the two (N19), the shorter way round: `follow_path` along it.
///
/// What the notes' algorithm (N24, `printed_screw_plan`) leaves open: targets are taken from the
/// motion of the beginning, so nothing drifts; each is met exactly and within the limits; the step
/// in τ follows from how far the tip is from the screw half way between waypoints; and the arm
/// moves in place where it would get stuck otherwise.
///
/// \return the plan; where `reason` is not `reached`, the part of it up to there. It is the start
/// alone where the goal is certainly `out_of_reach`: farther away than the links and sliding joints
/// between the first joint and the last are long
/// \throws invalid_input for a start outside the limits and for a goal that is no pose, and as
///         `follow_path`
template <SerialChain C, VectorLike Start, class Objective = no_objective, class Scene = no_scene>
[[nodiscard]] motion_plan<C::joints>
plan_screw_motion(const C& chain, const Start& start, const dual_quaternion<double>& goal,
                  const plan_options& options = {}, const Objective& objective = {},
                  const Scene& around = {}) {
  detail::require_problem(chain, start, goal);
  const auto first = chain.pose(start);
  auto between = conj(first) * normalized(goal);
  if (innermost(between.w()) < 0) {
    between = -between;
  }
  const auto half = detail::log_vector(between, "plan_screw_motion");
  const auto target = [&](double tau) {
    return dual_quaternion<double>(first *
                                   exp(dual_vector<double>(half * screw_dual<double>(tau))));
  };
  const bool is_out_of_reach = detail::chain_reach(chain).is_beyond(target(1), options.tolerance);
  return detail::follow(chain, start, target, {0, 1}, options, objective, around, is_out_of_reach);
}

} // namespace duet
