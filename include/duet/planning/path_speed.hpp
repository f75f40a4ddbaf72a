// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

/// \file
/// How fast a path may be followed: the largest x = ṡ² in the phase plane of s and ṡ.

namespace duet::detail {

/// a x + b y ≤ c, c > 0.
struct speed_bound {
  double a, b, c;
};

/// Bounds on x = ṡ² at both ends of an interval of s, between which x is linear and s̈ constant.
struct speed_interval {
  double cap; ///< of x, by velocities
  std::vector<speed_bound> bounds;
};

/// The largest x from 0 to `most_x` for which a y from 0 to `most_y` keeps all bounds, by Seidel's
/// algorithm: a bound that the best point so far breaks holds with equality, which leaves a line.
[[nodiscard]] inline double largest_speed(const std::vector<speed_bound>& bounds, double most_x,
                                          double most_y) {
  double x = most_x, y = 0;
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    const auto [a, b, c] = bounds[k];
    if (a * x + b * y <= c) {
      continue;
    }
    // The line (x, y) = (x_0 − b λ, y_0 + a λ), and which λ are left of it.
    const double square = a * a + b * b, x_0 = a * c / square, y_0 = b * c / square;
    double low = -std::numeric_limits<double>::infinity(), high = -low;
    const auto keep = [&](double slope, double bound) { // slope · λ ≤ bound
      if (slope > 0) {
        high = std::min(high, bound / slope);
      } else if (slope < 0) {
        low = std::max(low, bound / slope);
      }
    };
    keep(b, x_0);
    keep(-b, most_x - x_0);
    keep(-a, y_0);
    keep(a, most_y - y_0);
    for (std::size_t i = 0; i < k; ++i) {
      const auto [a_i, b_i, c_i] = bounds[i];
      const double slope = a * b_i - b * a_i;
      // What is parallel to rounding does not cut the line.
      if (slope * slope > 1e-24 * square * (a_i * a_i + b_i * b_i)) {
        keep(slope, c_i - a_i * x_0 - b_i * y_0);
      }
    }
    const double lambda = b < 0 ? high : low;
    x = std::clamp(x_0 - b * lambda, 0.0, most_x);
    y = std::clamp(y_0 + a * lambda, 0.0, most_y);
  }
  return x;
}

/// The largest y ≤ most_y that keeps all bounds together with a given x.
[[nodiscard]] inline double largest_next_speed(const std::vector<speed_bound>& bounds, double x,
                                               double most_y) {
  double y = most_y;
  for (const auto& [a, b, c] : bounds) {
    if (b > 0) {
      y = std::min(y, (c - a * x) / b);
    }
  }
  return std::max(0.0, y);
}

/// The fastest ṡ² at the ends of all intervals, from rest to rest: backwards, from where on one can
/// still slow down in time; forwards, as fast as that and the bounds allow.
[[nodiscard]] inline std::vector<double> path_speeds(const std::vector<speed_interval>& path) {
  const std::size_t n = path.size();
  std::vector<double> most(n + 1, 0.0), speeds(n + 1, 0.0);
  for (std::size_t i = n; i-- > 1;) {
    most[i] = largest_speed(path[i].bounds, std::min(path[i].cap, path[i - 1].cap), most[i + 1]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    speeds[i + 1] = largest_next_speed(path[i].bounds, speeds[i], most[i + 1]);
  }
  return speeds;
}

} // namespace duet::detail
