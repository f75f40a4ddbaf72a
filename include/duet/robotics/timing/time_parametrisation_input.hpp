// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/kinematics/joint_trajectory.hpp>
#include <duet/robotics/timing/joint_paths.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

/// \file
/// Validated arguments of `time_optimal_trajectory`. For those who extend duet.

namespace duet::detail {

/// Waypoints, limits and boundary velocities of a time parametrisation, validated.
template <int N>
struct time_parametrisation_input {
  using vector = joint_vector<double, N>;

  joint_polygon<vector> polygon;
  std::size_t waypoints;
  vector velocity, acceleration, jerk;
  double initial_speed = 0, final_speed = 0; ///< path velocities ṡ at the ends
  int parts;
  vector lower, upper; ///< joint ranges on the curve; infinite: unbounded
};

template <class L>
[[nodiscard]] auto validated_limits(const L& limits, const char* name, Eigen::Index n,
                                    bool may_be_infinite) {
  using argument = vector_argument<L>;
  require(argument::size(limits) == n, "duet: time_optimal_trajectory: ", argument::size(limits),
          " ", name, " limits (expected ", n, ", one per joint)");
  Eigen::VectorXd result(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double x = argument::get(limits, i);
    require(x > 0 && (may_be_infinite || x - x == 0), "duet: time_optimal_trajectory: the ", name,
            " limit of joint ", i, " is ", x, " (expected positive",
            may_be_infinite ? ")" : " and finite)");
    result[i] = x;
  }
  return result;
}

/// Path velocity ṡ at an end; the slope of the path there becomes the direction of the
/// given joint velocities.
template <class V>
[[nodiscard]] double speed_of(const std::vector<double>& velocities, const char* which, V& slope) {
  if (velocities.empty()) {
    return 0;
  }
  require(Eigen::Index(velocities.size()) == slope.size(),
          "duet: time_optimal_trajectory: ", velocities.size(), " ", which,
          " velocities (expected ", slope.size(), ", one per joint)");
  const V velocity = Eigen::Map<const Eigen::VectorXd>(velocities.data(), slope.size());
  const double speed = velocity.norm();
  require(speed - speed == 0, "duet: time_optimal_trajectory: the ", which,
          " velocities are not finite");
  if (speed > 0) {
    slope = velocity / speed;
  }
  return speed;
}

template <class V, class Velocity, class Acceleration, class Options>
[[nodiscard]] auto validated_input(const std::vector<V>& waypoints, const Velocity& velocity,
                                   const Acceleration& acceleration, const Options& options) {
  constexpr int joints = V::RowsAtCompileTime > 0 ? V::RowsAtCompileTime : -V::MaxRowsAtCompileTime;
  using problem = time_parametrisation_input<joints>;
  using vector = typename problem::vector;
  require(!waypoints.empty(),
          "duet: time_optimal_trajectory: there are no waypoints (expected at least 1)");
  const Eigen::Index n = waypoints.front().size();
  const vector v = validated_limits(velocity, "velocity", n, true);
  const vector a = validated_limits(acceleration, "acceleration", n, false);
  const vector j = options.jerk.empty()
                       ? vector::Constant(n, std::numeric_limits<double>::infinity())
                       : vector(validated_limits(options.jerk, "jerk", n, true));
  const vector none = vector::Constant(n, std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < waypoints.size(); ++k) {
    require(waypoints[k].size() == n && waypoints[k].allFinite(),
            "duet: time_optimal_trajectory: waypoint ", k,
            " is not finite or has another size than waypoint 0");
  }
  require(options.min_intervals >= 1, "duet: time_optimal_trajectory: min_intervals is ",
          options.min_intervals, " (expected at least 1)");
  problem result{joint_polygon<vector>(waypoints),
                 waypoints.size(),
                 v,
                 a,
                 j,
                 0,
                 0,
                 options.min_intervals,
                 -none,
                 none};
  result.initial_speed =
      speed_of(options.initial_velocities, "initial", result.polygon.first_slope);
  result.final_speed = speed_of(options.final_velocities, "final", result.polygon.last_slope);
  require(
      result.polygon.edges() > 0 || (result.initial_speed == 0 && result.final_speed == 0),
      "duet: time_optimal_trajectory: all ", waypoints.size(),
      " waypoints coincide (expected zero initial and final velocities on a path of zero length)");
  return result;
}

/// Replaces slopes at the ends of edges on which a joint would leave its range by those of the
/// monotone curve (PCHIP).
///
/// \throws invalid_input if a joint still leaves its range because of its velocity at an end
template <int N>
[[nodiscard]] auto slopes_within_ranges(const time_parametrisation_input<N>& problem,
                                        std::vector<joint_vector<double, N>> slopes) {
  const auto& polygon = problem.polygon;
  const auto safe = pchip_slopes(polygon);
  for (bool is_new = true; is_new;) {
    is_new = false;
    const auto before = slopes;
    const auto curve = hermite_curve(polygon, before);
    for (std::size_t k = 0; k < curve.size(); ++k) {
      for (Eigen::Index i = 0; i < problem.lower.size(); ++i) {
        const double from = polygon.points[k][i], to = polygon.points[k + 1][i];
        const double violation =
            range_violation(curve[k], i, std::min({problem.lower[i], from, to}),
                            std::max({problem.upper[i], from, to}));
        if (violation <= 1e-12 * (1 + std::abs(from))) {
          continue;
        }
        if (before[k][i] == safe[k][i] && before[k + 1][i] == safe[k + 1][i]) {
          const auto next = std::upper_bound(polygon.waypoint_s.begin(), polygon.waypoint_s.end(),
                                             polygon.s[k] + polygon.length(k) / 2) -
                            polygon.waypoint_s.begin();
          raise(invalid_input(message("duet: time_optimal_trajectory: joint ", i,
                                      " leaves its limits by ", violation, " between waypoints ",
                                      next - 1, " and ", next,
                                      " because of its velocity at an end")));
        }
        slopes[k][i] = safe[k][i];
        slopes[k + 1][i] = safe[k + 1][i];
        is_new = true;
      }
    }
  }
  return slopes;
}

} // namespace duet::detail
