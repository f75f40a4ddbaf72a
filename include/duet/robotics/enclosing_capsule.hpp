// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/kinematics/segment_distance.hpp>
#include <duet/kinematics/shapes.hpp>
#include <duet/robotics/constrained_step.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

/// \file
/// Small bounding capsules of points.

namespace duet {

/// Volume of a capsule, πr²l + 4πr³/3.
[[nodiscard]] inline double volume_of(const capsule<double>& c) {
  const double r = c.radius;
  return std::numbers::pi * r * r * ((c.to - c.from).norm() + 4 * r / 3);
}

namespace detail {

using points_in_space = std::vector<vector3<double>>;

/// Distance of a point from a segment, the parameter t of the nearest point, and the direction from
/// that point.
struct segment_proximity {
  double distance, t;
  vector3<double> normal;
};
[[nodiscard]] inline segment_proximity proximity_to_segment(const vector3<double>& x,
                                                            const vector3<double>& from,
                                                            const vector3<double>& to) {
  const double t = nearest_to_point(x, from, vector3<double>(to - from));
  const vector3<double> difference = x - (1 - t) * from - t * to;
  const double length = difference.norm();
  return {length, t, length > 0 ? vector3<double>(difference / length) : vector3<double>::Zero()};
}

/// Thinnest capsule around points with given ends of its axis.
[[nodiscard]] inline capsule<double>
around(const points_in_space& points, const vector3<double>& from, const vector3<double>& to) {
  double radius = 0;
  for (const auto& x : points) {
    radius = std::max(radius, proximity_to_segment(x, from, to).distance);
  }
  return {from, to, radius};
}

/// Capsule along a direction, centred on the points, with an axis of `part` times their extent.
[[nodiscard]] inline capsule<double> around(const points_in_space& points,
                                            const vector3<double>& direction, double part) {
  const vector3<double> d = direction.normalized();
  const vector3<double> e = across(d, vector3<double>(vector3<double>::Zero()));
  const std::array<vector3<double>, 3> axes = {d, e, cross_product(d, e)};
  vector3<double> centre = vector3<double>::Zero();
  double half = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [lowest, highest] = std::minmax_element(
        points.begin(), points.end(), [&](const vector3<double>& a, const vector3<double>& b) {
          return axes[k].dot(a) < axes[k].dot(b);
        });
    const double low = axes[k].dot(*lowest), high = axes[k].dot(*highest);
    centre += (low + high) / 2 * axes[k];
    half = k == 0 ? (high - low) / 2 : half;
  }
  const vector3<double> end = part * half * d;
  return around(points, centre - end, centre + end);
}

/// Capsule around points of smaller volume. Each step moves ends and radius to minimise the volume,
/// to first order, plus the squared step while, to first order, all points stay within. Steps that
/// reduce the volume are accepted; the weight of the squared step is adapted.
///
/// A template so that it can be compiled once.
template <class Points>
[[nodiscard]] capsule<double> shrunk(const Points& points, capsule<double> c, int rounds) {
  using step = Eigen::Matrix<double, 7, 1>; // changes of `from`, `to` and the radius
  double reach = .1;                        // factor of the first-order change of the volume
  double min_volume = volume_of(c);
  for (int round = 0; round < rounds && reach > 1e-10; ++round) {
    const vector3<double> along = c.to - c.from;
    const double length = along.norm(), r = c.radius;
    const vector3<double> u = length > 0 ? vector3<double>(along / length) : vector3<double>(along);
    step descent_step;
    descent_step << r * r * u, -r * r * u, -2 * r * length - 4 * r * r;
    descent_step *= reach;
    std::vector<inequality<step>> within;
    for (const auto& x : points) {
      const auto [distance, t, n] = proximity_to_segment(x, c.from, c.to);
      step gradient;
      gradient << (1 - t) * n, t * n, 1;
      within.push_back({gradient, distance - r - gradient.dot(descent_step)});
    }
    const auto correction = least_distance(within, 7);
    if (correction) {
      const step total = descent_step + *correction;
      const capsule<double> next = around(points, vector3<double>(c.from + total.head<3>()),
                                          vector3<double>(c.to + total.segment<3>(3)));
      const double size = volume_of(next);
      if (size < min_volume) {
        const bool is_done = min_volume - size < 1e-9 * min_volume;
        c = next;
        min_volume = size;
        reach *= 2;
        if (is_done) {
          break;
        }
        continue;
      }
    }
    reach /= 4;
  }
  return c;
}

#ifdef DUET_COMPILED
DUET_COMPILED_TEMPLATE capsule<double> shrunk(const points_in_space&, capsule<double>, int);
#endif

/// Directions all around, no two of them opposite.
[[nodiscard]] inline points_in_space directions_around() {
  points_in_space result;
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      for (int k = -1; k <= 1; ++k) {
        if (9 * i + 3 * j + k > 0) {
          result.emplace_back(i, j, k);
        }
      }
    }
  }
  return result;
}

/// Adds, in each octant about a capsule's centre, the point that is farthest outside its surface.
inline void add_outermost(const points_in_space& all, const capsule<double>& c,
                          points_in_space& chosen) {
  const vector3<double> centre = (c.from + c.to) / 2;
  std::array<const vector3<double>*, 8> farthest{};
  std::array<double, 8> max_distance;
  max_distance.fill(c.radius * (1 + 1e-9));
  for (const auto& x : all) {
    const double distance = proximity_to_segment(x, c.from, c.to).distance;
    const std::size_t octant = std::size_t(x[0] > centre[0]) + 2U * std::size_t(x[1] > centre[1]) +
                               4U * std::size_t(x[2] > centre[2]);
    if (distance > max_distance[octant]) {
      max_distance[octant] = distance;
      farthest[octant] = &x;
    }
  }
  for (const auto* x : farthest) {
    if (x != nullptr) {
      chosen.push_back(*x);
    }
  }
}

} // namespace detail

/// Small bounding capsule of points: all of them are inside, to round-off.
///
/// Its volume is a local minimum, sought from 13 directions; the global minimum is not guaranteed.
/// Only a few points are used: first the outermost in a few directions, then those outside the
/// capsule around these, until there are none.
///
/// \throws invalid_input for no points and for points that are not finite
[[nodiscard]] inline capsule<double> bounding_capsule(const std::vector<vector3<double>>& points) {
  detail::require(!points.empty(), "duet: bounding_capsule: the list of points is empty");
  vector3<double> low = points[0], high = points[0];
  for (const auto& x : points) {
    detail::require(detail::all_finite(x), "duet: bounding_capsule: point ", &x - points.data(),
                    " is not finite");
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  // Units in which the longest edge of the bounding box is 2.
  const vector3<double> centre = low / 2 + high / 2;
  const double unit = (high - low).maxCoeff() / 2;
  if (!(unit > 0)) {
    return sphere<double>{points[0], 0};
  }
  detail::points_in_space all;
  all.reserve(points.size());
  for (const auto& x : points) {
    all.emplace_back((x - centre) / unit);
  }
  const auto directions = detail::directions_around();
  detail::points_in_space chosen;
  for (const auto& d : directions) {
    const auto [lowest, highest] = std::minmax_element(
        all.begin(), all.end(), [&](const auto& a, const auto& b) { return d.dot(a) < d.dot(b); });
    chosen.push_back(*lowest);
    chosen.push_back(*highest);
  }
  std::vector<capsule<double>> candidates;
  for (const auto& d : directions) {
    for (const double part : {.2, .4, .6, .9}) {
      candidates.push_back(detail::shrunk(chosen, detail::around(chosen, d, part), 8));
    }
  }
  const auto is_smaller = [](const capsule<double>& a, const capsule<double>& b) {
    return volume_of(a) < volume_of(b);
  };
  std::sort(candidates.begin(), candidates.end(), is_smaller);
  candidates.erase(candidates.begin() + 8, candidates.end());
  for (capsule<double>& each : candidates) {
    each = detail::shrunk(chosen, each, 200);
  }
  capsule<double> best = *std::min_element(candidates.begin(), candidates.end(), is_smaller);
  for (int round = 0; round < 100; ++round) {
    const std::size_t before = chosen.size();
    detail::add_outermost(all, best, chosen);
    if (chosen.size() == before) {
      break;
    }
    best = detail::shrunk(chosen, detail::around(chosen, best.from, best.to), 200);
  }
  return detail::around(points, vector3<double>(centre + unit * best.from),
                        vector3<double>(centre + unit * best.to));
}

} // namespace duet
