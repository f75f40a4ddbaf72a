// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/mechanism/serial_chain.hpp>
#include <duet/planning/joint_trajectory.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/timing/joint_paths.hpp>
#include <duet/planning/timing/timed_curve.hpp>
#include <duet/planning/timing/timing_problem.hpp>

#include <Eigen/Core>

#include <optional>
#include <vector>

/// \file
/// When a joint path may be where, under limits of velocity, acceleration and jerk.

namespace duet {
namespace detail {

template <int N>
[[nodiscard]] const auto& waypoints_of(const motion_plan<N>& plan) {
  return plan.joints;
}
template <class V>
[[nodiscard]] const auto& waypoints_of(const std::vector<V>& waypoints) {
  return waypoints;
}

template <int N>
[[nodiscard]] joint_trajectory<N> timed_along(const timing_problem<N>& problem, bool is_smooth) {
  const auto& polygon = problem.polygon;
  if (polygon.edges() == 0) {
    const auto zero = joint_vector<double, N>::Zero(problem.velocity.size());
    return joint_trajectory<N>({{{0, 0, 0}, {polygon.points[0], zero, zero, zero, 0}}},
                               std::vector<double>(problem.waypoints, 0.0));
  }
  const auto slopes = is_smooth ? smooth_slopes(polygon) : monotone_slopes(polygon);
  return timed(problem, hermite_curve(polygon, slopes_within_ranges(problem, slopes)));
}

} // namespace detail

/// Which curve through waypoints joints follow.
enum class joint_curve {
  /// Every joint stays between its coordinates at neighbouring waypoints, and rises and falls as
  /// they do, save near ends where rates are given: continuous slopes, those of Fritsch and
  /// Butland.
  monotone,
  /// The cubic spline, with continuous second derivatives: quicker, as joints that turn back don't
  /// do so at waypoints, but beyond.
  smooth
};

/// Settings of `time_parametrised`.
struct time_options {
  /// At least so many parts of the path have an s̈ of their own, and sixteen between waypoints; with
  /// limits of jerk half as many, and none for waypoints.
  int parts = 360;
  /// Of each joint at the start, the path's direction there; empty: at rest.
  std::vector<double> initial_rates = {};
  /// Of each joint at the end, the path's direction there; empty: at rest.
  std::vector<double> final_rates = {};
  /// Not said: smooth for chains, where joints keep to their ranges on it, and with limits of jerk;
  /// otherwise monotone.
  std::optional<joint_curve> curve = {};
  /// Limits of each joint's |q⃛|, positive or infinite, for motions on a smooth curve; empty: none.
  /// At rest at an end accelerations are zero; in motion they are what is quickest, within limits.
  std::vector<double> jerk = {};
};

/// The fastest motion of joints along a curve through waypoints that keeps |q̇| and |q̈| of each
/// within limits, from rest to rest or from given rates to given rates.
///
/// In the phase plane (s, ṡ) of the path the parts have constant s̈ each, and the largest ṡ² come
/// from one pass backwards and one forwards, as in Pham and Pham, A new approach to time-optimal
/// path parameterization based on reachability analysis, IEEE T-RO 2018.
/// Limits are kept everywhere, not only at samples: what bounds them are Bernstein coefficients.
/// With limits of jerk it is the fastest of those near it (docs/time_parametrisation.md), and
/// accelerations are continuous: from and to zero at ends at rest; at ends in motion they are not
/// given, but what is quickest.
///
/// \param waypoints  joint coordinates, equal neighbours allowed
/// \param velocity  of each joint, in coordinates per second, positive or infinite
/// \param acceleration  of each joint, per second², positive and finite
/// \return `joint_trajectory<N>`
/// \throws invalid_input for no waypoints, coordinates that are not finite, for limits that are not
/// positive or of another number than the joints, and for rates that the limits do not allow: the
/// message says which part of them they do, with limits of jerk also by reason of which joint; with
/// limits of jerk for a curve whose second derivative jumps
template <class V, VectorLike Velocity, VectorLike Acceleration>
[[nodiscard]] auto time_parametrised(const std::vector<V>& waypoints, const Velocity& velocity,
                                     const Acceleration& acceleration,
                                     const time_options& options = {}) {
  const auto problem = detail::timing_problem_of(waypoints, velocity, acceleration, options);
  const auto usual = options.jerk.empty() ? joint_curve::monotone : joint_curve::smooth;
  return detail::timed_along(problem, options.curve.value_or(usual) == joint_curve::smooth);
}

/// The quickest motion along a plan's joint positions that keeps to limits of the joints'
/// velocities and accelerations. \return `joint_trajectory<N>`
template <int N, VectorLike Velocity, VectorLike Acceleration>
[[nodiscard]] auto time_parametrised(const motion_plan<N>& plan, const Velocity& velocity,
                                     const Acceleration& acceleration,
                                     const time_options& options = {}) {
  return time_parametrised(plan.joints, velocity, acceleration, options);
}

/// The fastest motion of a chain's joints within its own limits of velocity and range and given
/// ones of acceleration, along a smooth curve: where a joint would leave its range on it, its
/// slopes are those of the monotone curve.
///
/// \param way  a `motion_plan` or a vector of joint coordinates
/// \param acceleration  of each joint, per second², positive and finite
/// \return `joint_trajectory<N>`
/// \throws invalid_input as with velocities; for another number of coordinates than joints; and
/// where rates at an end take a joint out of its range
template <SerialChain C, class Way, VectorLike Acceleration>
[[nodiscard]] auto time_parametrised(const C& chain, const Way& way,
                                     const Acceleration& acceleration,
                                     const time_options& options = {}) {
  const auto& waypoints = detail::waypoints_of(way);
  Eigen::VectorXd velocity(chain.size());
  for (int i = 0; i < chain.size(); ++i) {
    velocity[i] = chain.limits(i).velocity;
  }
  auto problem = detail::timing_problem_of(waypoints, velocity, acceleration, options);
  for (int i = 0; i < chain.size(); ++i) {
    problem.lower[i] = chain.limits(i).lower;
    problem.upper[i] = chain.limits(i).upper;
  }
  return detail::timed_along(problem,
                             options.curve.value_or(joint_curve::smooth) == joint_curve::smooth);
}

} // namespace duet
