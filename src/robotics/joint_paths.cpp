// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "timing/joint_paths.hpp"

#include <duet/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace duet::detail {
DUET_ABI_BEGIN

namespace {

/// Maximum distance of joint i from [lower, upper] inside an edge; 0 if the joint stays within.
double range_violation(const joint_cubic& q, Eigen::Index i, double lower, double upper) {
  double result = 0;
  const auto check_at = [&](double s) {
    if (s > 0 && s < q.length) {
      const double x = q.c0[i] + s * (q.c1[i] + s * (q.c2[i] + s * q.c3[i]));
      result = std::max({result, lower - x, x - upper});
    }
  };
  // Zeros of the slope c1 + 2 c2 s + 3 c3 s².
  const double root = q.c2[i] * q.c2[i] - 3 * q.c1[i] * q.c3[i];
  if (root >= 0) {
    const double u = -(q.c2[i] + std::copysign(std::sqrt(root), q.c2[i]));
    check_at(u / (3 * q.c3[i]));
    check_at(q.c1[i] / u);
  }
  return result;
}

Eigen::VectorXd validated_limits(const Eigen::VectorXd& limits, const char* name, Eigen::Index n,
                                 bool may_be_infinite) {
  require(limits.size() == n, "duet: time_optimal_trajectory: ", limits.size(), " ", name,
          " limits (expected ", n, ", one per joint)");
  Eigen::VectorXd result(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double x = limits[i];
    require(x > 0 && (may_be_infinite || x - x == 0), "duet: time_optimal_trajectory: the ", name,
            " limit of joint ", i, " is ", x, " (expected positive",
            may_be_infinite ? ")" : " and finite)");
    result[i] = x;
  }
  return result;
}

/// Path velocity ṡ at an end; the slope of the path there becomes the direction of the
/// given joint velocities.
double speed_of(const std::vector<double>& velocities, const char* which, Eigen::VectorXd& slope) {
  if (velocities.empty()) {
    return 0;
  }
  require(Eigen::Index(velocities.size()) == slope.size(),
          "duet: time_optimal_trajectory: ", velocities.size(), " ", which,
          " velocities (expected ", slope.size(), ", one per joint)");
  const Eigen::VectorXd velocity =
      Eigen::Map<const Eigen::VectorXd>(velocities.data(), slope.size());
  const double speed = velocity.norm();
  require(speed - speed == 0, "duet: time_optimal_trajectory: the ", which,
          " velocities are not finite");
  if (speed > 0) {
    slope = velocity / speed;
  }
  return speed;
}

} // namespace

joint_polygon::joint_polygon(const std::vector<Eigen::VectorXd>& waypoints)
    : points{waypoints.front()}, s{0.0},
      first_slope(Eigen::VectorXd::Zero(waypoints.front().size())), last_slope(first_slope) {
  for (const Eigen::VectorXd& each : waypoints) {
    const double distance = (each - points.back()).norm();
    if (distance > 1e-10 * (1 + each.norm())) {
      points.push_back(each);
      s.push_back(s.back() + distance);
    }
    waypoint_s.push_back(s.back());
  }
}
std::vector<Eigen::VectorXd> pchip_slopes(const joint_polygon& polygon) {
  std::vector<Eigen::VectorXd> slopes{polygon.first_slope.isZero(0) ? polygon.chord(0)
                                                                    : polygon.first_slope};
  for (std::size_t k = 1; k < polygon.edges(); ++k) {
    const Eigen::VectorXd before = polygon.chord(k - 1), after = polygon.chord(k);
    const double left = polygon.length(k - 1), right = polygon.length(k);
    const double w_before = 2 * right + left, w_after = right + 2 * left;
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(before.size());
    for (Eigen::Index i = 0; i < slope.size(); ++i) {
      if (before[i] * after[i] > 0) {
        slope[i] = (w_before + w_after) / (w_before / before[i] + w_after / after[i]);
      }
    }
    slopes.push_back(slope);
  }
  slopes.push_back(polygon.last_slope.isZero(0) ? polygon.chord(polygon.edges() - 1)
                                                : polygon.last_slope);
  return slopes;
}

std::vector<Eigen::VectorXd> natural_cubic_slopes(const joint_polygon& polygon) {
  const std::size_t n = polygon.edges();
  // Forward elimination: row k is slope_k + above_k slope_{k+1} = slopes[k].
  const bool starts_freely = polygon.first_slope.isZero(0),
             ends_freely = polygon.last_slope.isZero(0);
  std::vector<double> above{starts_freely ? .5 : 0};
  std::vector<Eigen::VectorXd> slopes{starts_freely ? Eigen::VectorXd(1.5 * polygon.chord(0))
                                                    : polygon.first_slope};
  for (std::size_t k = 1; k < n; ++k) {
    const double left = polygon.length(k - 1), right = polygon.length(k);
    const double pivot = 2 * (left + right) - right * above.back();
    const Eigen::VectorXd row = 3 * (right * polygon.chord(k - 1) + left * polygon.chord(k));
    slopes.push_back((row - right * slopes.back()) / pivot);
    above.push_back(left / pivot);
  }
  slopes.push_back(
      ends_freely ? Eigen::VectorXd((3 * polygon.chord(n - 1) - slopes.back()) / (2 - above.back()))
                  : polygon.last_slope);
  for (std::size_t k = n; k-- > 0;) {
    slopes[k] -= above[k] * slopes[k + 1];
  }
  return slopes;
}

std::vector<joint_cubic> hermite_curve(const joint_polygon& polygon,
                                       const std::vector<Eigen::VectorXd>& slopes) {
  std::vector<joint_cubic> result;
  for (std::size_t k = 0; k < polygon.edges(); ++k) {
    const double h = polygon.length(k);
    const Eigen::VectorXd chord = polygon.chord(k);
    result.push_back({polygon.points[k], slopes[k],
                      Eigen::VectorXd((3 * chord - 2 * slopes[k] - slopes[k + 1]) / h),
                      Eigen::VectorXd((slopes[k] + slopes[k + 1] - 2 * chord) / (h * h)), h});
  }
  return result;
}

time_parametrisation_input validated_input(const std::vector<Eigen::VectorXd>& waypoints,
                                           const Eigen::VectorXd& velocity,
                                           const Eigen::VectorXd& acceleration,
                                           const time_parametrisation_options& options) {
  require(!waypoints.empty(),
          "duet: time_optimal_trajectory: there are no waypoints (expected at least 1)");
  const Eigen::Index n = waypoints.front().size();
  const Eigen::VectorXd v = validated_limits(velocity, "velocity", n, true);
  const Eigen::VectorXd a = validated_limits(acceleration, "acceleration", n, false);
  const Eigen::VectorXd j =
      options.jerk.empty()
          ? Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity())
          : validated_limits(Eigen::Map<const Eigen::VectorXd>(options.jerk.data(),
                                                               Eigen::Index(options.jerk.size())),
                             "jerk", n, true);
  const Eigen::VectorXd none =
      Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < waypoints.size(); ++k) {
    require(waypoints[k].size() == n && waypoints[k].allFinite(),
            "duet: time_optimal_trajectory: waypoint ", k,
            " is not finite or has another size than waypoint 0");
  }
  require(options.min_intervals >= 1, "duet: time_optimal_trajectory: min_intervals is ",
          options.min_intervals, " (expected at least 1)");
  time_parametrisation_input result{joint_polygon(waypoints),
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

std::vector<Eigen::VectorXd> slopes_within_ranges(const time_parametrisation_input& problem,
                                                  std::vector<Eigen::VectorXd> slopes) {
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

DUET_ABI_END
} // namespace duet::detail
