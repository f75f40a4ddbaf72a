// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/mechanism/serial_chain.hpp>
#include <duet/planning/joint_trajectory.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/timing/joint_paths.hpp>
#include <duet/planning/timing/time_parametrisation_input.hpp>
#include <duet/planning/timing/timed_curve.hpp>

#include <Eigen/Core>

#include <optional>
#include <vector>

/// \file
/// Time-optimal parametrisation of joint paths under limits of velocity, acceleration and jerk.

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
[[nodiscard]] joint_trajectory<N> timed_along(const time_parametrisation_input<N>& problem,
                                              bool is_smooth) {
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

/// Interpolating curve of the joints through waypoints.
enum class waypoint_interpolation {
  /// Monotone cubic interpolation: every joint stays between its coordinates at neighbouring
  /// waypoints, and rises and falls as they do, except near ends with given velocities. Continuous
  /// slopes, those of Fritsch and Butland.
  monotone,
  /// Cubic spline with continuous second derivatives: faster motions, as joints that reverse do so
  /// beyond waypoints instead of at them.
  smooth
};

/// Options of `time_optimal_trajectory`.
struct time_parametrisation_options {
  /// Minimum number of intervals of the path with an s̈ each, and sixteen between waypoints; with
  /// jerk limits half as many, and none for waypoints.
  int min_intervals = 360;
  /// Velocity of each joint at the start, in the direction of the path there; empty: at rest.
  std::vector<double> initial_velocities = {};
  /// Velocity of each joint at the end, in the direction of the path there; empty: at rest.
  std::vector<double> final_velocities = {};
  /// Interpolating curve. Default: smooth for chains, where joints keep to their ranges on it, and
  /// with jerk limits; otherwise monotone.
  std::optional<waypoint_interpolation> curve = {};
  /// Limits of |q⃛| of each joint, positive or infinite, for motions on a smooth curve; empty:
  /// none. Accelerations are zero at an end at rest; at an end in motion they are the fastest
  /// within limits.
  std::vector<double> jerk = {};
};

/// Time-optimal motion of joints along a curve through waypoints that keeps |q̇| and |q̈| of each
/// joint within limits, from rest to rest or from given velocities to given velocities.
///
/// s̈ is constant on each interval of the path in the phase plane (s, ṡ), and the largest squared
/// path velocities ṡ² come from one pass backwards and one forwards, as in Pham and Pham, A new
/// approach to time-optimal path parameterization based on reachability analysis, IEEE T-RO 2018
/// (TOPP-RA).
/// Limits are kept everywhere, not only at samples: they bound Bernstein coefficients. With jerk
/// limits the motion is the fastest of those near it (docs/time_parametrisation.md), and
/// accelerations are continuous: from and to zero at ends at rest; at ends in motion they are not
/// given, but are the fastest.
///
/// \param waypoints  joint coordinates, equal neighbours allowed
/// \param velocity  limit of each joint, in coordinates per second, positive or infinite
/// \param acceleration  limit of each joint, per second², positive and finite
/// \return `joint_trajectory<N>`
/// \throws invalid_input for no waypoints, coordinates that are not finite, limits that are not
/// positive or of another number than the joints, and velocities at ends that the limits do not
/// allow: the message states which fraction of them they do, with jerk limits also because of which
/// joint; with jerk limits for a curve whose second derivative jumps
template <class V, VectorLike Velocity, VectorLike Acceleration>
[[nodiscard]] auto time_optimal_trajectory(const std::vector<V>& waypoints,
                                           const Velocity& velocity,
                                           const Acceleration& acceleration,
                                           const time_parametrisation_options& options = {}) {
  const auto problem = detail::timing_problem_of(waypoints, velocity, acceleration, options);
  const auto usual =
      options.jerk.empty() ? waypoint_interpolation::monotone : waypoint_interpolation::smooth;
  return detail::timed_along(problem,
                             options.curve.value_or(usual) == waypoint_interpolation::smooth);
}

/// Time-optimal motion along a plan's joint positions within limits of the joints' velocities and
/// accelerations.
///
/// \return `joint_trajectory<N>`
template <int N, VectorLike Velocity, VectorLike Acceleration>
[[nodiscard]] auto time_optimal_trajectory(const motion_plan<N>& plan, const Velocity& velocity,
                                           const Acceleration& acceleration,
                                           const time_parametrisation_options& options = {}) {
  return time_optimal_trajectory(plan.joints, velocity, acceleration, options);
}

/// Time-optimal motion of a chain's joints within its own limits of velocity and range and given
/// ones of acceleration, along a smooth curve: if a joint would leave its range on it, its slopes
/// are those of the monotone curve.
///
/// \param way  joint path: a `motion_plan` or a vector of joint coordinates
/// \param acceleration  limit of each joint, per second², positive and finite
/// \return `joint_trajectory<N>`
/// \throws invalid_input as with velocities; for another number of coordinates than joints; and if
/// velocities at an end take a joint out of its range
template <SerialChain C, class Way, VectorLike Acceleration>
[[nodiscard]] auto time_optimal_trajectory(const C& chain, const Way& way,
                                           const Acceleration& acceleration,
                                           const time_parametrisation_options& options = {}) {
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
  return detail::timed_along(problem, options.curve.value_or(waypoint_interpolation::smooth) ==
                                          waypoint_interpolation::smooth);
}

} // namespace duet
