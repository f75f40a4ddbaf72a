// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/kinematics/joint_trajectory.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/robotics/timing/joint_paths.hpp>
#include <duet/robotics/timing/time_parametrisation_input.hpp>
#include <duet/robotics/timing/timed_curve.hpp>

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
[[nodiscard]] joint_trajectory<N> timed_along(const time_parametrisation_input<N>& input,
                                              bool is_natural_cubic) {
  const auto& polygon = input.polygon;
  if (polygon.edges() == 0) {
    const auto zero = joint_vector<double, N>::Zero(input.velocity.size());
    return joint_trajectory<N>({{{0, 0, 0}, {polygon.points[0], zero, zero, zero, 0}}},
                               std::vector<double>(input.waypoints, 0.0));
  }
  const auto slopes = is_natural_cubic ? natural_cubic_slopes(polygon) : pchip_slopes(polygon);
  return timed(input, hermite_curve(polygon, slopes_within_ranges(input, slopes)));
}

} // namespace detail

/// Interpolating curve of the joints through waypoints.
enum class waypoint_interpolation {
  /// Monotone piecewise cubic interpolation (PCHIP) with the slopes of Fritsch and Butland: every
  /// joint stays between its coordinates at neighbouring waypoints, and rises and falls with them,
  /// except near ends with given velocities. First derivatives are continuous.
  pchip,
  /// Cubic spline with natural end conditions, or clamped at ends with given velocities. Second
  /// derivatives are continuous. Motions are faster, because joints reverse beyond waypoints
  /// instead
  /// of at them.
  natural_cubic
};

/// Options of `time_optimal_trajectory`.
struct time_parametrisation_options {
  /// Minimum number of intervals of the path, each with a constant s̈; there are at least sixteen
  /// between two waypoints. With jerk limits half as many, regardless of waypoints.
  int min_intervals = 360;
  /// Velocity of each joint at the start, in the direction of the path there; empty: at rest.
  std::vector<double> initial_velocities = {};
  /// Velocity of each joint at the end, in the direction of the path there; empty: at rest.
  std::vector<double> final_velocities = {};
  /// Interpolating curve. Default: `natural_cubic` for chains, whose joint limits it respects, and
  /// with jerk limits; otherwise `pchip`.
  std::optional<waypoint_interpolation> curve = {};
  /// Limits of |q⃛| of each joint, positive or infinite, for motions on a curve with continuous
  /// second derivatives; empty: unlimited. Accelerations are zero at an end at rest; at an end in
  /// motion they result from the optimisation.
  std::vector<double> jerk = {};
};

/// Time-optimal motion of joints along a curve through waypoints, with |q̇| and |q̈| of each joint
/// within limits, from rest to rest or between given velocities.
///
/// s̈ is constant on each interval of the path in the phase plane (s, ṡ), and the largest squared
/// path velocities ṡ² come from one pass backwards and one forwards, as in Pham and Pham, A new
/// approach to time-optimal path parameterization based on reachability analysis, IEEE T-RO 2018
/// (TOPP-RA).
/// Limits are satisfied everywhere, not only at samples, because they bound Bernstein coefficients.
/// With jerk limits the motion is locally optimal (docs/time_parametrisation.md), and accelerations
/// are continuous: zero at ends at rest, free at ends in motion.
///
/// \param waypoints  joint coordinates, equal neighbours allowed
/// \param velocity  limit of each joint, in coordinates per second, positive or infinite
/// \param acceleration  limit of each joint, per second², positive and finite
/// \return `joint_trajectory<N>`
/// \throws invalid_input for no waypoints, coordinates that are not finite, limits that are not
/// positive or of another number than the joints, and velocities at ends that are
/// infeasible under the limits: the message states which fraction of them is feasible, with jerk
/// limits also the joint that is nearest to its limits; with jerk limits for a curve whose second
/// derivative jumps
template <class V, VectorLike Velocity, VectorLike Acceleration>
[[nodiscard]] auto time_optimal_trajectory(const std::vector<V>& waypoints,
                                           const Velocity& velocity,
                                           const Acceleration& acceleration,
                                           const time_parametrisation_options& options = {}) {
  const auto input = detail::validated_input(waypoints, velocity, acceleration, options);
  const auto usual =
      options.jerk.empty() ? waypoint_interpolation::pchip : waypoint_interpolation::natural_cubic;
  return detail::timed_along(input, options.curve.value_or(usual) ==
                                        waypoint_interpolation::natural_cubic);
}

/// Time-optimal motion along the configurations of a plan within velocity and acceleration limits.
///
/// \return `joint_trajectory<N>`
template <int N, VectorLike Velocity, VectorLike Acceleration>
[[nodiscard]] auto time_optimal_trajectory(const motion_plan<N>& plan, const Velocity& velocity,
                                           const Acceleration& acceleration,
                                           const time_parametrisation_options& options = {}) {
  return time_optimal_trajectory(plan.joints, velocity, acceleration, options);
}

/// Time-optimal motion of a chain within its velocity and position limits and the given
/// acceleration limits, along a natural cubic spline. Where a joint would leave its position
/// limits, its slopes are those of `waypoint_interpolation::pchip`.
///
/// \param path  joint path: a `motion_plan` or a vector of joint coordinates
/// \param acceleration  limit of each joint, per second², positive and finite
/// \return `joint_trajectory<N>`
/// \throws invalid_input as with velocities; for another number of coordinates than joints; and if
/// a velocity at an end takes a joint beyond its position limits
template <SerialChain C, class Path, VectorLike Acceleration>
[[nodiscard]] auto time_optimal_trajectory(const C& chain, const Path& path,
                                           const Acceleration& acceleration,
                                           const time_parametrisation_options& options = {}) {
  const auto& waypoints = detail::waypoints_of(path);
  Eigen::VectorXd velocity(chain.size());
  for (int i = 0; i < chain.size(); ++i) {
    velocity[i] = chain.limits(i).velocity;
  }
  auto input = detail::validated_input(waypoints, velocity, acceleration, options);
  for (int i = 0; i < chain.size(); ++i) {
    input.lower[i] = chain.limits(i).lower;
    input.upper[i] = chain.limits(i).upper;
  }
  return detail::timed_along(input, options.curve.value_or(waypoint_interpolation::natural_cubic) ==
                                        waypoint_interpolation::natural_cubic);
}

} // namespace duet
