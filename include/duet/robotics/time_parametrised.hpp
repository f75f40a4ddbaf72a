// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/derivative/argument.hpp>
#include <duet/kinematics/chain_view.hpp>
#include <duet/kinematics/motion_plan.hpp>

#include <Eigen/Core>

#include <optional>
#include <type_traits>
#include <vector>

/// \file
/// Time-optimal parametrisation of joint paths under limits of velocity, acceleration and jerk.

namespace duet {
DUET_ABI_BEGIN

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

DUET_ABI_END
} // namespace duet

namespace duet::detail {
DUET_ABI_BEGIN

/// Vectors of joint coordinates, and plans, which contain them.
template <class Path>
concept JointPath = requires(const Path& path) {
  path.joints.begin();
}
|| requires(const Path& path) {
  requires VectorLike<std::remove_cvref_t<decltype(*path.begin())>>;
};

template <VectorLike X>
[[nodiscard]] Eigen::VectorXd to_dynamic_vector(const X& x) {
  using argument = vector_argument<X>;
  Eigen::VectorXd result(argument::size(x));
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    result[i] = double(argument::get(x, i));
  }
  return result;
}

template <class Path>
[[nodiscard]] std::vector<Eigen::VectorXd> waypoints_of(const Path& path) {
  if constexpr (requires { path.joints.begin(); }) {
    return waypoints_of(path.joints);
  } else {
    std::vector<Eigen::VectorXd> result;
    for (const auto& each : path) {
      result.push_back(to_dynamic_vector(each));
    }
    return result;
  }
}

[[nodiscard]] joint_trajectory timed_along_waypoints(const std::vector<Eigen::VectorXd>& waypoints,
                                                     const Eigen::VectorXd& velocity,
                                                     const Eigen::VectorXd& acceleration,
                                                     const time_parametrisation_options& options);
[[nodiscard]] joint_trajectory timed_within_limits(const chain_view& chain,
                                                   const std::vector<Eigen::VectorXd>& waypoints,
                                                   const Eigen::VectorXd& acceleration,
                                                   const time_parametrisation_options& options);

DUET_ABI_END
} // namespace duet::detail

namespace duet {
DUET_ABI_BEGIN

/// Time-optimal motion of joints along a curve through waypoints, with |q̇| and |q̈| of each joint
/// within limits, from rest to rest or between given velocities.
///
/// s̈ is constant on each interval of the path in the phase plane (s, ṡ), and the largest squared
/// path velocities ṡ² come from one pass backwards and one forwards, as in Pham and Pham, A new
/// approach to time-optimal path parameterization based on reachability analysis, IEEE T-RO 2018
/// (TOPP-RA).
/// Limits are satisfied everywhere, not only at samples, because they bound Bernstein coefficients.
/// With jerk limits the motion is locally optimal (docs/how-to/limit_jerk.md), and
/// accelerations are continuous: zero at ends at rest, free at ends in motion.
///
/// \param path  joint path: a `motion_plan` or a vector of joint coordinates; neighbours at a
/// distance of at most 1e-10 (1 + |q|) count as one
/// \param velocity  limit of each joint, in coordinates per second, positive or infinite
/// \param acceleration  limit of each joint, per second², positive and finite
/// \throws invalid_input for no waypoints, coordinates that are not finite, limits that are not
/// positive or of another number than the joints, and velocities at ends that are
/// infeasible under the limits: the message states which fraction of them is feasible, with jerk
/// limits also the joint that is nearest to its limits; with jerk limits for a curve whose second
/// derivative jumps
template <detail::JointPath Path, VectorLike Velocity, VectorLike Acceleration>
[[nodiscard]] joint_trajectory
time_optimal_trajectory(const Path& path, const Velocity& velocity,
                        const Acceleration& acceleration,
                        const time_parametrisation_options& options = {}) {
  return detail::timed_along_waypoints(detail::waypoints_of(path),
                                       detail::to_dynamic_vector(velocity),
                                       detail::to_dynamic_vector(acceleration), options);
}

/// Time-optimal motion of a chain within its velocity and position limits and the given
/// acceleration limits, along a natural cubic spline. Where a joint would leave its position
/// limits, its slopes are those of `waypoint_interpolation::pchip`.
///
/// \param path  joint path: a `motion_plan` or a vector of joint coordinates
/// \param acceleration  limit of each joint, per second², positive and finite
/// \throws invalid_input as with velocities; for another number of coordinates than joints; and if
/// a velocity at an end takes a joint beyond its position limits
template <detail::JointPath Path, VectorLike Acceleration>
[[nodiscard]] joint_trajectory
time_optimal_trajectory(const chain_view& chain, const Path& path, const Acceleration& acceleration,
                        const time_parametrisation_options& options = {}) {
  return detail::timed_within_limits(chain, detail::waypoints_of(path),
                                     detail::to_dynamic_vector(acceleration), options);
}

DUET_ABI_END
} // namespace duet
