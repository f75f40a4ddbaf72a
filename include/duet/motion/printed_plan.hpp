// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/dual_quaternion/nearest.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/motion/resolved_motion.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>

/// \file
/// Planner of the lecture notes as printed (N24), and its variants by their notes 1 and 2 (N25).
/// The copy of the notes has lost the letter of its first three steps; they are as N19, N22 and N23
/// have them.

namespace duet {

/// Options of `printed_screw_plan` and `printed_path_plan`.
struct printed_plan_options {
  double tau = .01;                ///< step of ScLERP; not used for paths given by poses
  double beta = 1;                 ///< step factor β of N23
  pose_tolerance tolerance = 1e-4; ///< maximum error of the tip at the goal
  int max_iterations = 10000;      ///< maximum number of steps
};

namespace detail {

/// Steps of N23 towards `next(k, current)`, k = 1, 2, …, until the tip is close to `goal` after
/// `min_steps` steps or more. `record(k, joints, pose)` is called with every waypoint.
template <class C, class Next, class Record>
[[nodiscard]] stop_reason printed_steps(const C& chain, joint_vector<double, C::joints> theta,
                                        const dual_quaternion<double>& goal, int min_steps,
                                        const printed_plan_options& options, const Next& next,
                                        const Record& record) {
  dual_quaternion<double> current = chain.pose(theta);
  record(0, theta, current);
  for (int k = 0;; ++k) {
    const pose_error remaining = pose_error_between(current, goal);
    if (k >= min_steps && options.tolerance.ratio(remaining) <= 1) {
      return stop_reason::reached;
    }
    if (k == options.max_iterations) {
      return stop_reason::iteration_limit;
    }
    bool is_singular = false;
    catching<invalid_input>(
        [&] { theta = resolved_step(chain, theta, next(k + 1, current), options.beta); },
        [&](const auto&) { is_singular = true; });
    if (is_singular) {
      return stop_reason::singular;
    }
    for (int i = 0; i < chain.size(); ++i) {
      if (!(theta[i] >= chain.limits(i).lower && theta[i] <= chain.limits(i).upper)) {
        return stop_reason::joint_limit;
      }
    }
    current = chain.pose(theta);
    record(k + 1, theta, current);
  }
}

} // namespace detail

/// Planner N24 as printed: (1) from the start's pose A_s (2) one step of ScLERP towards the goal,
/// (3) the joints after it by N23, (4) their pose is the next A_s, (5) until it is close to the
/// goal. With note 2 this is inverse kinematics too, from any start: the last joints are the
/// result.
///
/// For study. Every step starts where the last one ended, so the path drifts from the screw motion
/// (`deviations`, from its nearest pose); joint limits are only checked to stop; and with a fixed τ
/// of the remaining motion the approach to the goal slows down: each step leaves about 1 − βτ of
/// the motion, so β and τ have the same effect.
///
/// \return `motion_plan`
/// \throws invalid_input for a start outside the limits and for a goal that is not a pose
template <SerialChain C, VectorLike Start>
[[nodiscard]] motion_plan printed_screw_plan(const C& chain, const Start& start,
                                             const dual_quaternion<double>& goal,
                                             const printed_plan_options& options = {}) {
  detail::require_start(chain, start, "printed_screw_plan");
  detail::require_pose(goal, "printed_screw_plan", "the goal");
  motion_plan plan;
  const auto theta = detail::start_of(chain, start);
  const dual_quaternion<double> first = chain.pose(theta);
  const auto motion = screw_parameters(conj(first) * goal);
  plan.reason = detail::printed_steps(
      chain, theta, goal, 0, options,
      [&](int, const dual_quaternion<double>& current) {
        return sclerp(current, goal, options.tau);
      },
      [&](int k, const auto& joints, const dual_quaternion<double>& current) {
        const auto nearest = nearest_on_screw(first, motion, current, 1);
        detail::add_waypoint(plan, chain, joints, current, nearest.tau,
                             pose_error_between(nearest.pose, current));
        plan.iterations = k;
      });
  return plan;
}

/// Planner N24 along a path given by poses, without the interpolation (N25, note 1). One step of
/// N23 towards each pose in turn, from wherever the last step ended, and further steps towards the
/// last pose until the tip is close to it. `tau` of a waypoint is the number of its target pose, 0
/// at the start; `deviations` are from that pose, at the start from the first one.
///
/// For study; with limits as in `printed_screw_plan`. A step leaves 1 − β of the motion, so with
/// steps of the length h the tip lags (1 − β)/β h behind; it follows for 0 < β < 2, with β = 1 to
/// second order in h.
///
/// \return `motion_plan`
/// \throws invalid_input for a start outside the limits, for no poses, and for one that is not a
/// pose
template <SerialChain C, VectorLike Start>
[[nodiscard]] motion_plan printed_path_plan(const C& chain, const Start& start,
                                            std::span<const dual_quaternion<double>> path,
                                            const printed_plan_options& options = {}) {
  detail::require_start(chain, start, "printed_path_plan");
  detail::require(!path.empty(), "duet: printed_path_plan: the path has no poses");
  for (std::size_t i = 0; i < path.size(); ++i) {
    detail::require_pose(path[i], "printed_path_plan",
                         "pose " + std::to_string(i) + " of the path");
  }
  motion_plan plan;
  const auto target = [&](int k) { return std::min(std::size_t(std::max(k, 1)), path.size()) - 1; };
  plan.reason = detail::printed_steps(
      chain, detail::start_of(chain, start), path.back(), int(path.size()), options,
      [&](int k, const dual_quaternion<double>&) { return path[target(k)]; },
      [&](int k, const auto& joints, const dual_quaternion<double>& current) {
        detail::add_waypoint(plan, chain, joints, current, k == 0 ? 0. : double(target(k) + 1),
                             pose_error_between(path[target(k)], current));
        plan.iterations = k;
      });
  return plan;
}

} // namespace duet
