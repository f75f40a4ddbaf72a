// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/kinematics/joint_trajectory.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

/// \file
/// Curves through waypoints in joint space, the configuration space of an arm. For
/// those who extend duet.

namespace duet::detail {

/// Polygon of distinct points, with the arc length s of each along the polygon.
template <class V>
struct joint_polygon {
  std::vector<V> points;
  std::vector<double> s;
  std::vector<double> waypoint_s; ///< arc length s of each given waypoint
  V first_slope, last_slope; ///< slopes of the curve at its ends; 0: default of the type of curve

  explicit joint_polygon(const std::vector<V>& waypoints)
      : points{waypoints.front()}, s{0.0}, first_slope(V::Zero(waypoints.front().size())),
        last_slope(first_slope) {
    for (const V& each : waypoints) {
      const double distance = (each - points.back()).norm();
      if (distance > 1e-10 * (1 + each.norm())) {
        points.push_back(each);
        s.push_back(s.back() + distance);
      }
      waypoint_s.push_back(s.back());
    }
  }
  [[nodiscard]] std::size_t edges() const { return points.size() - 1; }
  [[nodiscard]] double length(std::size_t k) const { return s[k + 1] - s[k]; }
  [[nodiscard]] V chord(std::size_t k) const { return (points[k + 1] - points[k]) / length(k); }
};

/// Slopes of the monotone piecewise cubic interpolant (PCHIP) of F. N. Fritsch and J. Butland (A
/// method for constructing local monotone piecewise cubic interpolants, 1984): a weighted harmonic
/// mean of the slopes of both edges, and 0 where their signs differ. Every component therefore
/// rises and falls with the points and stays between them.
template <class V>
[[nodiscard]] std::vector<V> pchip_slopes(const joint_polygon<V>& polygon) {
  std::vector<V> slopes{polygon.first_slope.isZero(0) ? polygon.chord(0) : polygon.first_slope};
  for (std::size_t k = 1; k < polygon.edges(); ++k) {
    const V before = polygon.chord(k - 1), after = polygon.chord(k);
    const double left = polygon.length(k - 1), right = polygon.length(k);
    const double w_before = 2 * right + left, w_after = right + 2 * left;
    V slope = V::Zero(before.size());
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

/// Slopes of the natural cubic spline through the points, which has continuous second derivatives;
/// these are 0 at ends whose slopes are not given (natural end conditions). Its equations are h₁ d₀
/// + 2 (h₀ + h₁) d₁ + h₀ d₂ = 3 (h₁ c₀ + h₀ c₁) with the lengths h and chords c of both edges.
template <class V>
[[nodiscard]] std::vector<V> natural_cubic_slopes(const joint_polygon<V>& polygon) {
  const std::size_t n = polygon.edges();
  // Forward elimination: row k is slope_k + above_k slope_{k+1} = slopes[k].
  const bool starts_freely = polygon.first_slope.isZero(0),
             ends_freely = polygon.last_slope.isZero(0);
  std::vector<double> above{starts_freely ? .5 : 0};
  std::vector<V> slopes{starts_freely ? V(1.5 * polygon.chord(0)) : polygon.first_slope};
  for (std::size_t k = 1; k < n; ++k) {
    const double left = polygon.length(k - 1), right = polygon.length(k);
    const double pivot = 2 * (left + right) - right * above.back();
    const V row = 3 * (right * polygon.chord(k - 1) + left * polygon.chord(k));
    slopes.push_back((row - right * slopes.back()) / pivot);
    above.push_back(left / pivot);
  }
  slopes.push_back(ends_freely ? V((3 * polygon.chord(n - 1) - slopes.back()) / (2 - above.back()))
                               : polygon.last_slope);
  for (std::size_t k = n; k-- > 0;) {
    slopes[k] -= above[k] * slopes[k + 1];
  }
  return slopes;
}

/// Piecewise cubic Hermite curve through the points of a polygon with given
/// slopes, one cubic per edge.
template <class V>
[[nodiscard]] std::vector<joint_cubic<V>> hermite_curve(const joint_polygon<V>& polygon,
                                                        const std::vector<V>& slopes) {
  std::vector<joint_cubic<V>> result;
  for (std::size_t k = 0; k < polygon.edges(); ++k) {
    const double h = polygon.length(k);
    const V chord = polygon.chord(k);
    result.push_back({polygon.points[k], slopes[k],
                      V((3 * chord - 2 * slopes[k] - slopes[k + 1]) / h),
                      V((slopes[k] + slopes[k + 1] - 2 * chord) / (h * h)), h});
  }
  return result;
}

/// Maximum distance of joint i from [lower, upper] inside an edge; 0 if the joint stays within.
template <class V>
[[nodiscard]] double range_violation(const joint_cubic<V>& q, Eigen::Index i, double lower,
                                     double upper) {
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

} // namespace duet::detail
