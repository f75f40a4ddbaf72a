// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/dual_quaternion/nearest.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/resolved_motion.hpp>

/// \file
/// The planner of the lecture notes, to the letter (N24).

namespace duet {

/// Settings of `printed_screw_plan`.
struct printed_plan_options {
  double tau = .01;        ///< of the small step of ScLERP
  double beta = 1;         ///< N23
  double tolerance = 1e-4; ///< how close the tip must come, in units of length and radians
  int iterations = 10000;
};

/// N24, as the notes have it: (1) from the start's pose A_s (2) one step of ScLERP towards the
/// goal, (3) the joints after it by N23, (4) their pose is the next A_s, (5) until it is close to
/// the goal.
///
/// For study. Every step starts where the last one ended, so the path drifts from the screw motion
/// (`deviations`, from its nearest pose); limits of joints are looked at only to stop; and with a
/// fixed τ of what is left the goal is approached slower and slower.
/// \throws invalid_input for a start outside the limits and for a goal that is no pose
template <SerialChain C, VectorLike Start>
[[nodiscard]] auto printed_screw_plan(const C& chain, const Start& start,
                                      const dual_quaternion<double>& goal,
                                      const printed_plan_options& options = {}) {
  detail::require_problem(chain, start, goal);
  motion_plan<C::joints> plan;
  auto theta = detail::joint_vector_of(chain, start);
  const dual_quaternion<double> first = chain.pose(theta);
  const auto motion = screw_parameters(conj(first) * goal);
  const auto keep = [&](const dual_quaternion<double>& here) {
    const auto nearest = nearest_on_screw(first, motion, here, 1);
    detail::add_waypoint(plan, chain, theta, here, nearest.tau,
                         deviation_between(nearest.pose, here));
  };
  dual_quaternion<double> here = first;
  keep(here);
  for (;; ++plan.iterations) {
    const pose_deviation left = deviation_between(here, goal);
    if (left.length <= options.tolerance && left.angle <= options.tolerance) {
      plan.reason = stop_reason::reached;
      return plan;
    }
    if (plan.iterations == options.iterations) {
      plan.reason = stop_reason::iteration_limit;
      return plan;
    }
    try {
      theta = resolved_step(chain, theta, sclerp(here, goal, options.tau), options.beta);
    } catch (const invalid_input&) {
      plan.reason = stop_reason::singular;
      return plan;
    }
    for (int i = 0; i < chain.size(); ++i) {
      if (!(theta[i] >= chain.limits(i).lower && theta[i] <= chain.limits(i).upper)) {
        plan.reason = stop_reason::joint_limit;
        return plan;
      }
    }
    here = chain.pose(theta);
    keep(here);
  }
}

} // namespace duet
