// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/kinematics/joint_trajectory.hpp>
#include <duet/robotics/timing/minimum_time_path_velocity.hpp>
#include <duet/robotics/timing/path_velocity_constraints.hpp>
#include <duet/robotics/timing/reference_parametrisation.hpp>
#include <duet/robotics/timing/time_parametrisation_input.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

/// \file
/// Trajectories within velocity, acceleration and jerk limits, from a squared path velocity. For
/// those who extend duet.

namespace duet::detail {

/// Timed segments of a path in order, and their total duration.
template <class V>
struct timed_path {
  std::vector<timed_piece<V>> pieces;
  double duration = 0;
};

/// Path arguments s of a motion at n + 1 equidistant times; the last one is the length of the path.
template <class V>
[[nodiscard]] std::vector<double> arc_lengths_of(const timed_path<V>& path, std::size_t n,
                                                 double length) {
  std::vector<double> result;
  std::size_t at = 0;
  double s = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = path.duration * double(i) / double(n);
    for (; at + 1 < path.pieces.size() && path.pieces[at + 1].scaling.time <= t; ++at) {
      s += path.pieces[at].path.length;
    }
    const auto& [scaling, edge] = path.pieces[at];
    result.push_back(std::min(s + scaling.at(t, edge.length).s, length));
  }
  result.push_back(length);
  return result;
}

/// Time ∫ dτ / τ̇ over an interval of τ on which the squared path velocity τ̇² is a
/// quadratic polynomial.
[[nodiscard]] inline double time_over(double length, double first_rate, double last_rate,
                                      double curvature) {
  const double half = length / (first_rate + last_rate);
  const double omega = std::sqrt(std::abs(curvature)), angle = omega * half;
  const double ratio = angle < 1e-9    ? 1
                       : curvature > 0 ? std::atanh(angle) / angle
                                       : std::atan(angle) / angle;
  return 2 * half * ratio;
}

/// Checks that second derivatives of a curve are continuous, as finite jerks require.
///
/// \throws invalid_input where second derivatives jump
template <int N>
void require_smooth(const time_parametrisation_input<N>& problem,
                    const std::vector<joint_cubic<joint_vector<double, N>>>& curve) {
  for (std::size_t k = 1; k < curve.size(); ++k) {
    const auto &before = curve[k - 1], &after = curve[k];
    const auto jump = (after.second(0) - before.second(before.length)).eval();
    Eigen::Index joint = 0;
    const double largest = jump.cwiseAbs().maxCoeff(&joint);
    if (largest * std::min(before.length, after.length) > 1e-9) {
      const auto& at = problem.polygon.waypoint_s;
      const auto waypoint =
          std::lower_bound(at.begin(), at.end(), problem.polygon.s[k]) - at.begin();
      raise(invalid_input(
          message("duet: time_optimal_trajectory: the second derivative of joint ", joint,
                  " jumps at waypoint ", waypoint,
                  " (with jerk limits expected continuous, as of "
                  "waypoint_interpolation::natural_cubic if no joint leaves its range)")));
    }
  }
}

/// Velocities of all joints at the first and the last end of a curve.
template <int N>
[[nodiscard]] std::array<joint_vector<double, N>, 2>
end_velocities(const time_parametrisation_input<N>& problem,
               const std::vector<joint_cubic<joint_vector<double, N>>>& curve) {
  const auto& last = curve.back();
  return {problem.initial_speed * curve.front().first(0),
          problem.final_speed * last.first(last.length)};
}

/// Checks the joint velocities at both ends against their limits.
///
/// \throws invalid_input for a velocity at an end that exceeds its limit by more than round-off
template <int N>
void require_feasible_ends(const time_parametrisation_input<N>& problem,
                           const std::vector<joint_cubic<joint_vector<double, N>>>& curve) {
  const auto velocities = end_velocities(problem, curve);
  for (const bool is_last : {false, true}) {
    for (Eigen::Index i = 0; i < problem.velocity.size(); ++i) {
      require(std::abs(velocities[is_last][i]) <= problem.velocity[i] * (1 + 1e-12),
              "duet: time_optimal_trajectory: the ", is_last ? "final" : "initial",
              " velocity of joint ", i, " is ", velocities[is_last][i], " (expected at most ",
              problem.velocity[i], " in absolute value)");
    }
  }
}

/// Trajectory along a curve with a squared path velocity τ̇²(τ) over n intervals of τ, given by its
/// B-spline coefficients.
template <class V>
[[nodiscard]] timed_path<V>
trajectory_from_path_velocity(const std::vector<joint_cubic<V>>& curve,
                              const std::vector<reference_piece>& path, std::size_t n,
                              const std::vector<double>& squared_velocity) {
  timed_path<V> result;
  result.pieces.reserve(path.size());
  for (const auto& [edge, interval, from, l, start, a, b, c] : path) {
    const auto rows = path_velocity_powers(interval, n);
    const double* of = &squared_velocity[interval];
    const double curvature = times(rows[2], of), rise = times(rows[1], of) + 2 * from * curvature;
    const double before = times(rows[0], of) + from * (times(rows[1], of) + from * curvature);
    const double rate = std::sqrt(before),
                 end_rate = std::sqrt(before + l * (rise + l * curvature));
    result.pieces.push_back({{result.duration, rate, rise / 2, curvature, a, b, c},
                             curve[edge].part(start, l * (a + l * (b + l * c)))});
    result.duration += time_over(l, rate, end_rate, curvature);
  }
  return result;
}

/// Result of a search for a squared path velocity within velocity, acceleration and jerk limits.
template <class V>
struct jerk_search_result {
  timed_path<V> motion;
  std::array<double, 2> reached{}; ///< fraction of the velocity at each end; 1: attained
  std::size_t nearest_joint = 0;   ///< joint whose limits are the nearest

  /// End at which the smaller fraction of the velocities is attained.
  [[nodiscard]] std::size_t end() const { return reached[1] < reached[0]; }
  [[nodiscard]] bool is_feasible() const { return reached[end()] == 1; }
};

/// Near-minimum-time trajectory within velocity, acceleration and jerk limits. Its squared path
/// velocity is a B-spline of a parameter τ that is proportional to the time of another motion, in a
/// given number of intervals.
///
/// \param motion    motion that defines τ
/// \param accuracy  as of `minimum_time_path_velocity`
template <int N>
[[nodiscard]] auto timed_by_jerks(const time_parametrisation_input<N>& problem,
                                  const std::vector<joint_cubic<joint_vector<double, N>>>& curve,
                                  const timed_path<joint_vector<double, N>>& motion,
                                  std::size_t intervals, double accuracy) {
  const auto& knots = problem.polygon.s;
  const std::array<double, 2> speeds{problem.initial_speed, problem.final_speed};
  const reference_parametrisation reference(arc_lengths_of(motion, intervals, knots.back()),
                                            {speeds[0] == 0, speeds[1] == 0});
  const auto path = reference.pieces(knots);
  const path_velocity_constraints bounds(curve, path, intervals, problem.velocity,
                                         problem.acceleration, problem.jerk);
  std::array<double, 2> ends{};
  for (std::size_t e = 0; e < 2; ++e) {
    const double rate = speeds[e] / (e == 0 ? reference.first_slope() : reference.last_slope());
    ends[e] = speeds[e] > 0 ? rate * rate : 0;
  }
  const path_velocity_result velocities = minimum_time_path_velocity(bounds, ends, accuracy);
  jerk_search_result<joint_vector<double, N>> result;
  result.reached = {std::sqrt(velocities.reached[0]), std::sqrt(velocities.reached[1])};
  result.nearest_joint = velocities.nearest_joint;
  result.motion = trajectory_from_path_velocity(curve, path, intervals, velocities.coefficients);
  return result;
}

} // namespace duet::detail
