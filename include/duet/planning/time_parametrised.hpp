// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/planning/joint_trajectory.hpp>
#include <duet/planning/motion_plan.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

/// \file
/// When a joint path may be where, under limits of velocity and acceleration.

namespace duet {

namespace detail {

// How fast a path may be followed: the largest x = ṡ² in the phase plane of s and ṡ.

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

/// Points that are apart from each other, and where in s they are, the length of the polygon.
template <class V>
struct joint_polygon {
  std::vector<V> points;
  std::vector<double> s;
  std::vector<double> given_at; ///< where in s each point is that was given

  explicit joint_polygon(const std::vector<V>& given) : points{given.front()}, s{0.0} {
    for (const V& each : given) {
      const double way = (each - points.back()).norm();
      if (way > 1e-10 * (1 + each.norm())) {
        points.push_back(each);
        s.push_back(s.back() + way);
      }
      given_at.push_back(s.back());
    }
  }
};

/// The curve through the points of a polygon, a cubic on each edge, with the slopes of Fritsch and
/// Butland (A method for constructing local monotone piecewise cubic interpolants, 1984): a
/// weighted harmonic mean of those of both edges, and 0 where their signs differ. So every
/// component rises and falls where the points do, and stays between them.
template <class V>
[[nodiscard]] std::vector<joint_cubic<V>> monotone_curve(const joint_polygon<V>& polygon) {
  const auto& points = polygon.points;
  const auto& s = polygon.s;
  const std::size_t count = points.size();
  const auto chord_of = [&](std::size_t k) {
    return V((points[k + 1] - points[k]) / (s[k + 1] - s[k]));
  };
  std::vector<V> slopes{chord_of(0)};
  for (std::size_t k = 1; k + 1 < count; ++k) {
    const V before = chord_of(k - 1), after = chord_of(k);
    const double left = s[k] - s[k - 1], right = s[k + 1] - s[k];
    const double w_before = 2 * right + left, w_after = right + 2 * left;
    V slope = V::Zero(before.size());
    for (Eigen::Index i = 0; i < slope.size(); ++i) {
      if (before[i] * after[i] > 0) {
        slope[i] = (w_before + w_after) / (w_before / before[i] + w_after / after[i]);
      }
    }
    slopes.push_back(slope);
  }
  slopes.push_back(chord_of(count - 2));
  std::vector<joint_cubic<V>> result;
  for (std::size_t k = 0; k + 1 < count; ++k) {
    const double h = s[k + 1] - s[k];
    const V chord = chord_of(k);
    result.push_back({points[k], slopes[k], V((3 * chord - 2 * slopes[k] - slopes[k + 1]) / h),
                      V((slopes[k] + slopes[k + 1] - 2 * chord) / (h * h)), h});
  }
  return result;
}

/// Bounds on ṡ² at both ends of a part of a path that keep velocities and accelerations all along
/// it. With ṡ² linear in s the acceleration q' s̈ + q'' ṡ² is of second degree, and so between its
/// Bernstein coefficients, which are linear in both ṡ²; so is q'.
template <class V>
[[nodiscard]] speed_interval speed_bounds(const joint_cubic<V>& q, const V& velocity,
                                          const V& acceleration) {
  constexpr double unlimited = 1e100;
  speed_interval result{unlimited, {}};
  const V start = q.second(0), end = q.second(q.length);
  const std::array<V, 3> slopes{q.first(0), V(q.c1 + q.length * q.c2), q.first(q.length)};
  const std::array<V, 3> before{start, V(end / 2), V::Zero(start.size())};
  const std::array<V, 3> after{V::Zero(start.size()), V(start / 2), end};
  for (Eigen::Index joint = 0; joint < start.size(); ++joint) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double change = slopes[k][joint] / (2 * q.length); // s̈ = (y − x) / (2 length)
      const double a = before[k][joint] - change, b = after[k][joint] + change;
      result.bounds.push_back({a, b, acceleration[joint]});
      result.bounds.push_back({-a, -b, acceleration[joint]});
      const double ratio = velocity[joint] / std::max(std::abs(slopes[k][joint]), 1e-50);
      result.cap = std::min(result.cap, ratio * ratio);
    }
  }
  return result;
}

template <class L>
void require_rate_limits(const L& limits, const char* name, Eigen::Index n, bool may_be_infinite) {
  using argument = vector_argument<L>;
  require(argument::size(limits) == n, "duet: time_parametrised: ", argument::size(limits), " ",
          name, " limits for ", n, " joints");
  for (Eigen::Index i = 0; i < n; ++i) {
    const double x = argument::get(limits, i);
    require(x > 0 && (may_be_infinite || x - x == 0), "duet: time_parametrised: the ", name,
            " limit of joint ", i, " is ", x);
  }
}

} // namespace detail

/// Settings of `time_parametrised`.
struct time_options {
  /// At least so many parts of the path have an s̈ of their own, and eight between waypoints.
  int parts = 200;
};

/// The fastest motion of joints along waypoints, from rest to rest, that keeps |θ̇| and |θ̈| of each
/// within limits.
///
/// The path is the monotone cubic curve through the waypoints: no joint leaves the range between
/// neighbouring ones. In its phase plane (s, ṡ) the parts have constant s̈ each, and the largest ṡ²
/// come from one pass backwards and one forwards, as in Pham and Pham, A new approach to
/// time-optimal path parameterization based on reachability analysis, IEEE T-RO 2018. Limits are
/// kept everywhere, not only at samples: what bounds them are Bernstein coefficients.
///
/// \param waypoints  joint coordinates, equal neighbours allowed
/// \param velocity  of each joint, in coordinates per second, positive or infinite
/// \param acceleration  of each joint, per second², positive and finite
/// \return `joint_trajectory<N>`
/// \throws invalid_input for no waypoints, coordinates that are not finite, and for limits that
/// are not positive or of another number than the joints
template <class V, VectorLike Velocity, VectorLike Acceleration>
[[nodiscard]] auto time_parametrised(const std::vector<V>& waypoints, const Velocity& velocity,
                                     const Acceleration& acceleration,
                                     const time_options& options = {}) {
  constexpr int joints = V::RowsAtCompileTime > 0 ? V::RowsAtCompileTime : -V::MaxRowsAtCompileTime;
  using vector = typename joint_trajectory<joints>::vector;
  detail::require(!waypoints.empty(), "duet: time_parametrised: no waypoints");
  const Eigen::Index n = waypoints.front().size();
  detail::require_rate_limits(velocity, "velocity", n, true);
  detail::require_rate_limits(acceleration, "acceleration", n, false);
  for (std::size_t k = 0; k < waypoints.size(); ++k) {
    detail::require(waypoints[k].size() == n && waypoints[k].allFinite(),
                    "duet: time_parametrised: waypoint ", k, " is not finite or of another size");
  }
  detail::require(options.parts >= 1, "duet: time_parametrised: ", options.parts, " parts");
  vector v(n), a(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    v[i] = detail::vector_argument<Velocity>::get(velocity, i);
    a[i] = detail::vector_argument<Acceleration>::get(acceleration, i);
  }
  const detail::joint_polygon<vector> polygon(waypoints);
  if (polygon.points.size() == 1) {
    const vector zero = vector::Zero(n);
    return joint_trajectory<joints>({{0, 0, 0, {polygon.points[0], zero, zero, zero, 0}}},
                                    std::vector<double>(waypoints.size(), 0.0));
  }

  std::vector<detail::timed_piece<vector>> pieces;
  std::vector<detail::speed_interval> intervals;
  for (const auto& cubic : detail::monotone_curve(polygon)) {
    // Eight at least, or short edges at corners would have too few to slow down in.
    const double parts = std::max(8.0, std::ceil(cubic.length / polygon.s.back() * options.parts));
    for (double k = 0; k < parts; ++k) {
      const double length = cubic.length / parts;
      pieces.push_back({0, 0, 0, cubic.part(k * length, length)});
      intervals.push_back(detail::speed_bounds(pieces.back().path, v, a));
    }
  }
  const std::vector<double> squares = detail::path_speeds(intervals);
  std::vector<double> times;
  double time = 0, s = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    auto& piece = pieces[i];
    const double from = std::sqrt(squares[i]), to = std::sqrt(squares[i + 1]);
    const double length = piece.path.length;
    // Pieces end where edges do, to rounding.
    while (times.size() < waypoints.size() && polygon.given_at[times.size()] < s + length / 2) {
      times.push_back(time);
    }
    piece.time = time;
    piece.speed = from;
    piece.acceleration = (squares[i + 1] - squares[i]) / (2 * length);
    time += 2 * length / (from + to);
    s += length;
  }
  times.resize(waypoints.size(), time);
  return joint_trajectory<joints>(std::move(pieces), std::move(times));
}

/// The quickest motion along a plan's joint positions that keeps to limits of the joints'
/// velocities and accelerations.
/// \return `joint_trajectory<N>`
template <int N, VectorLike Velocity, VectorLike Acceleration>
[[nodiscard]] auto time_parametrised(const motion_plan<N>& plan, const Velocity& velocity,
                                     const Acceleration& acceleration,
                                     const time_options& options = {}) {
  return time_parametrised(plan.joints, velocity, acceleration, options);
}

} // namespace duet
