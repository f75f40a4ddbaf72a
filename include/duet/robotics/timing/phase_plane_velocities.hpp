// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/kinematics/joint_trajectory.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

/// \file
/// Maximum squared path velocity x = ṡ² along a path in the phase plane (s, ṡ) under velocity and
/// acceleration limits. For those who extend duet.

namespace duet::detail {

/// Constraint |y + slope x| ≤ reach on the squared path velocities x = ṡ² at the start of a segment
/// and y at its end.
struct speed_bound {
  double slope, reach;
};

/// Interval of the y between `lower` and `upper` that satisfy all constraints for a given x, from
/// the value of one line at x to that of another.
struct feasible_path_velocities {
  struct line {
    double at_zero, slope, value;
  };
  line lower, upper;

  feasible_path_velocities(std::span<const speed_bound> bounds, double x, double from, double to)
      : lower{from, 0, from}, upper{to, 0, to} {
    for (const auto& [slope, reach] : bounds) {
      const double middle = -slope * x;
      if (middle + reach < upper.value) {
        upper = {reach, -slope, middle + reach};
      }
      if (middle - reach > lower.value) {
        lower = {-reach, -slope, middle - reach};
      }
    }
  }
};

/// Nearest value to x for which some y between `lower` and `upper` satisfies all constraints;
/// NaN if no such y exists. The length of the interval of such y is a concave function of x.
/// Newton's method approaches its nearer zero from outside without passing it, from one pair of
/// active lines to the next.
[[nodiscard]] inline double nearest_speed(std::span<const speed_bound> bounds, double x,
                                          double lower, double upper) {
  for (double direction = 0;;) {
    const feasible_path_velocities y(bounds, x, lower, upper);
    if (y.lower.value <= y.upper.value) {
      return x;
    }
    const double next = (y.upper.at_zero - y.lower.at_zero) / (y.lower.slope - y.upper.slope);
    const double step = next - x;
    if (!(step * direction > 0) && direction != 0) {
      // Converged to round-off, or between the zeros of a function that has none.
      return std::abs(step) <= 1e-9 * std::abs(x) ? x : std::numeric_limits<double>::quiet_NaN();
    }
    if (!(std::abs(step) < std::numeric_limits<double>::infinity())) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    direction = step > 0 ? 1 : -1;
    x = next;
  }
}

/// Constraints on ṡ² at the starts and ends of the segments of a path, between which it is linear
/// in s.
struct path_bounds {
  std::vector<double> before, after; ///< largest ṡ² that velocity limits admit
  std::vector<speed_bound> bounds;   ///< constraints, as many for each segment
  std::size_t bounds_each;

  explicit path_bounds(Eigen::Index joints) : bounds_each(std::size_t(3 * joints)) {}

  void reserve(std::size_t parts) {
    before.reserve(parts);
    after.reserve(parts);
    bounds.reserve(parts * bounds_each);
  }
  [[nodiscard]] std::size_t size() const { return before.size(); }
  [[nodiscard]] std::span<const speed_bound> of(std::size_t part) const {
    return std::span(bounds).subspan(part * bounds_each, bounds_each);
  }
  /// Adds the constraints by which velocities and accelerations stay within limits on an entire
  /// segment. With ṡ² linear in s the acceleration q' s̈ + q'' ṡ² is a quadratic polynomial and
  /// lies between its Bernstein coefficients, which are linear in both ṡ².
  template <class V>
  void add(const joint_cubic<V>& q, const V& velocity, const V& acceleration) {
    before.push_back(1e100);
    after.push_back(1e100);
    const std::array<V, 3> slopes{q.first(0), V(q.c1 + q.length * q.c2), q.first(q.length)};
    const V second = q.second(0), last = q.second(q.length);
    const double half = 1 / (2 * q.length); // s̈ = (y − x) / (2 length)
    std::size_t at = bounds.size();
    bounds.resize(at + bounds_each);
    for (Eigen::Index i = 0; i < second.size(); ++i) {
      const std::array<double, 3> p{slopes[0][i], slopes[1][i], slopes[2][i]};
      apply_velocity_limit(p, velocity[i]);
      bounds[at++] = bound(second[i] - p[0] * half, p[0] * half, acceleration[i]);
      bounds[at++] = bound(last[i] / 2 - p[1] * half, second[i] / 2 + p[1] * half, acceleration[i]);
      bounds[at++] = bound(-p[2] * half, last[i] + p[2] * half, acceleration[i]);
    }
  }

private:
  /// Constraint |a x + b y| ≤ c, solved for y.
  [[nodiscard]] speed_bound bound(double a, double b, double c) {
    if (std::abs(b) > 1e-12 * std::abs(a)) [[likely]] {
      const double inverse = 1 / b;
      return {a * inverse, c * std::abs(inverse)};
    }
    before.back() = std::min(before.back(), c / std::max(std::abs(a), 1e-100));
    return {0, std::numeric_limits<double>::infinity()};
  }
  /// Applies a velocity limit. If |q'| is below a line from l to r l, ṡ² may be below (limit /
  /// line)², which is a convex function, and is above its chord divided by the largest ratio of the
  /// two. That ratio is attained at (2 r + 1) / (3 r + 3) of the segment.
  void apply_velocity_limit(const std::array<double, 3>& p, double limit) {
    const double l_0 = std::abs(p[0]), l_1 = std::abs(p[1]), l_2 = std::abs(p[2]);
    double at_start = limit / std::max({l_0, l_1, l_2, 1e-50}), at_end = at_start; // ṡ
    if (at_start * at_start >= std::max(before.back(), after.back())) {
      return;
    }
    const double over = std::max(0.0, l_1 - (l_0 + l_2) / 2);
    const double x_0 = l_0 + over, x_1 = l_2 + over, r = x_1 / x_0;
    // Where the line changes much within a segment, its maximum gives a better limit.
    if (r > .5 && r < 2) {
      const double u = (2 * r + 1) / (3 * r + 3), line = 1 + (r - 1) * u;
      const double ratio = line * std::sqrt(1 + (1 / (r * r) - 1) * u);
      at_start = limit / (x_0 * ratio);
      at_end = limit / (x_1 * ratio);
    }
    before.back() = std::min(before.back(), at_start * at_start);
    after.back() = std::min(after.back(), at_end * at_end);
  }
};

/// Infeasible boundary velocity: the end of the path, and the largest ṡ² that is feasible there.
struct infeasible_boundary {
  bool at_start = false, at_end = false;
  double largest = 0;
};

/// Maximum squared path velocities ṡ² at the ends of all segments. The backward pass finds the
/// range from which the given end can be reached; the forward pass takes the largest values that
/// this range and the constraints admit.
///
/// \param infeasible  set if a boundary velocity is infeasible; then the result has no meaning
[[nodiscard]] inline std::vector<double> phase_plane_velocities(const path_bounds& path,
                                                                double first, double last,
                                                                infeasible_boundary& infeasible) {
  const std::size_t n = path.size();
  const auto cap = [&](std::size_t i) {
    return std::min(i < n ? path.before[i] : path.after[n - 1],
                    i > 0 ? path.after[i - 1] : path.before[0]);
  };
  std::vector<double> upper(n + 1), lower(n + 1), speeds(n + 1);
  const auto backwards = [&](double lowest, double highest) {
    upper[n] = highest;
    lower[n] = lowest;
    for (std::size_t i = n; i-- > 0;) {
      upper[i] = nearest_speed(path.of(i), cap(i), lower[i + 1], upper[i + 1]);
      if (upper[i] > cap(i)) {
        upper[i] = std::numeric_limits<double>::quiet_NaN();
      }
      lower[i] = lower[i + 1] > 0 ? nearest_speed(path.of(i), 0, lower[i + 1], upper[i + 1]) : 0;
    }
  };
  const auto forwards = [&] {
    speeds[0] = first;
    for (std::size_t i = 0; i < n; ++i) {
      speeds[i + 1] = std::max(
          0.0,
          feasible_path_velocities(path.of(i), speeds[i], lower[i + 1], upper[i + 1]).upper.value);
    }
    return speeds[n];
  };
  constexpr double tolerance = 1 + 1e-9;
  backwards(last, last);
  if (first <= upper[0] * tolerance && first * tolerance >= lower[0] &&
      last <= cap(n) * tolerance) {
    forwards();
    return speeds;
  }
  backwards(0, std::min(last, cap(n)));
  if (first > upper[0] * tolerance) {
    infeasible = {true, false, upper[0]};
  } else {
    backwards(0, cap(n));
    infeasible = {false, true, forwards()};
  }
  return speeds;
}

} // namespace duet::detail
