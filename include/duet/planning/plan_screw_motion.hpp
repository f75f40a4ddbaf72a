// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/screw.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/mechanism/jacobian.hpp>
#include <duet/planning/bounded_step.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/quaternion/exponential.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

/// \file
/// Joint paths along the screw motion between two poses.

namespace duet {

/// Settings of `plan_screw_motion`.
struct plan_options {
  /// How close waypoints come to the screw, in units of length and radians.
  double tolerance = 1e-6;
  /// How far the tip may be from it where joints move straight on between waypoints.
  double deviation = 1e-5;
  /// Of τ.
  double largest_step = .1;
  /// Of τ; below it the planner gives up.
  double smallest_step = 1e-6;
  /// How fast joints move away from their limits where that leaves the tip in place, in coordinates
  /// per unit of τ.
  double centring = 1;
  /// Of Newton's method, in all.
  int iterations = 20000;
};

namespace detail {

/// The twist, in `frame::hybrid`, of the shorter screw motion from one pose to another in unit
/// time.
[[nodiscard]] inline vector6<double> error_twist(const dual_quaternion<double>& from,
                                                 const dual_quaternion<double>& to) {
  dual_quaternion<double> difference = to * conj(from);
  if (innermost(difference.w()) < 0) {
    difference = -difference;
  }
  vector6<double> v = 2 * twist_of(dual_vector<double>(log(difference).vec()));
  const Eigen::Vector3d omega = v.tail<3>();
  v.head<3>() += omega.cross(translation(from));
  return v;
}

/// Where joints would rather be: away from their limits by a step that grows towards them.
template <class V>
[[nodiscard]] V away_from_limits(const V& theta, const V& lower, const V& upper, double step) {
  V result = theta;
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    const double half = (upper[i] - lower[i]) / 2;
    if (half > 0 && half - half == 0) {
      const double x = (theta[i] - lower[i]) / half - 1; // from -1 to 1
      result[i] -= std::min(step, half) * x * x * x;     // never beyond the middle
    }
  }
  return result;
}

/// What became of an attempt to bring the tip to a pose.
template <class V>
struct correction {
  V theta;
  pose_deviation left;
  double smallest_singular_value;
  bool is_bounded;
  int iterations;
};

/// Newton's method from θ, each step of least norm within the limits.
template <class C, class V>
[[nodiscard]] correction<V> correct(const C& chain, V theta, const V& lower, const V& upper,
                                    const dual_quaternion<double>& target, double tolerance,
                                    int most) {
  correction<V> result{theta, {}, std::numeric_limits<double>::infinity(), false, 0};
  double before = std::numeric_limits<double>::infinity();
  for (;;) {
    const auto [a, m] = pose_and_jacobian(chain, result.theta, frame::hybrid);
    result.left = deviation_between(a, target);
    const double size = std::max(result.left.length, result.left.angle);
    // What does not at least halve the error will not get there.
    if (size <= tolerance || result.iterations == most || size > before / 2) {
      return result;
    }
    before = size;
    const auto step =
        bounded_step(m, error_twist(a, target), V(lower - result.theta), V(upper - result.theta));
    result.smallest_singular_value =
        std::min(result.smallest_singular_value, step.smallest_singular_value);
    result.is_bounded = step.is_bounded;
    result.theta += step.step;
    ++result.iterations;
  }
}

} // namespace detail

/// Joint coordinates that take the tip of a chain from where it is at `start` to the pose `goal`
/// along the screw motion between the two (N19), the shorter way round.
///
/// What the notes' algorithm (N24, `printed_screw_plan`) leaves open: targets are taken from the
/// motion of the beginning, so nothing drifts; each is met by Newton's method on the exact twist
/// 2 log(A_target A*), with steps of least norm that keep the limits, and damped where the smallest
/// singular value is small; the step in τ follows from how far the tip is from the screw half way
/// between waypoints. Waypoints are within `tolerance` of it, the straight joint paths between them
/// within about `deviation`.
///
/// \return the plan; where `reason` is not `reached`, the part of it up to there
/// \throws invalid_input for a start outside the limits and for a goal that is no pose
template <SerialChain C, VectorLike Start>
[[nodiscard]] auto plan_screw_motion(const C& chain, const Start& start,
                                     const dual_quaternion<double>& goal,
                                     const plan_options& options = {}) {
  using vector = detail::joint_vector<double, C::joints>;
  detail::require_problem(chain, start, goal);
  const vector lower = lower_limits(chain), upper = upper_limits(chain);
  motion_plan<C::joints> plan;
  vector theta(chain.size());
  for (int i = 0; i < chain.size(); ++i) {
    theta[i] = detail::vector_argument<Start>::get(start, i);
  }
  const dual_quaternion<double> first = chain.pose(theta);
  const auto target = [&](double tau) { return sclerp(first, goal, tau); };
  const auto keep = [&](double tau, const pose_deviation& deviation) {
    plan.joints.push_back(theta);
    plan.poses.push_back(chain.pose(theta));
    plan.tau.push_back(tau);
    plan.deviations.push_back(deviation);
  };
  keep(0, {});
  double tau = 0, step = options.largest_step / 4;
  while (tau < 1) {
    const double next = std::min(1.0, tau + step);
    const vector guess =
        detail::away_from_limits(theta, lower, upper, options.centring * (next - tau));
    const auto there = detail::correct(chain, guess, lower, upper, target(next), options.tolerance,
                                       std::min(12, options.iterations - plan.iterations));
    plan.iterations += there.iterations;
    const bool is_met =
        there.left.length <= options.tolerance && there.left.angle <= options.tolerance;
    double change = .25;
    if (is_met) {
      const pose_deviation half_way = deviation_between(
          chain.pose(vector((theta + there.theta) / 2)), target((tau + next) / 2));
      // Between waypoints the deviation grows with the square of the step.
      const double excess = std::max(half_way.length, half_way.angle) / options.deviation;
      change = std::clamp(.85 / std::sqrt(std::max(excess, 1e-12)), .2, 2.0);
      if (excess <= 1) {
        theta = there.theta;
        tau = next;
        plan.smallest_singular_value =
            std::min(plan.smallest_singular_value, there.smallest_singular_value);
        keep(tau, there.left);
      }
    }
    step = std::min(options.largest_step, step * change);
    if (tau < 1 && plan.iterations >= options.iterations) {
      plan.reason = stop_reason::iteration_limit;
      return plan;
    }
    if (tau < 1 && step < options.smallest_step) {
      plan.reason = there.is_bounded ? stop_reason::joint_limit
                    : there.smallest_singular_value < 10 * detail::damped_gram::threshold
                        ? stop_reason::singular
                        : stop_reason::no_progress;
      return plan;
    }
  }
  plan.reason = stop_reason::reached;
  return plan;
}

} // namespace duet
