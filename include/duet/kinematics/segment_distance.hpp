// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/math.hpp>
#include <duet/kinematics/shapes.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>

#include <cmath>
#include <limits>

/// \file
/// Nearest points of a segment and round shapes (points, spheres, capsules) or half-spaces. For
/// those who extend duet.

namespace duet::detail {

/// Signed distance of a point and its gradient.
template <class T>
struct point_distance {
  T distance;
  vector3<T> normal;
};

template <class T>
[[nodiscard]] vector3<T> cross_product(const vector3<T>& a, const vector3<T>& b) {
  return cross(components(a), components(b));
}

/// Unit vector perpendicular to both, or to one if the other has no length or the same direction:
/// constant.
template <class T>
[[nodiscard]] vector3<T> across(const vector3<T>& a, const vector3<T>& b) {
  using std::sqrt;
  using R = real_type_t<T>;
  const auto real = [](const vector3<T>& x) {
    return vector3<R>(innermost(x[0]), innermost(x[1]), innermost(x[2]));
  };
  const auto longer = [](const vector3<R>& x, const vector3<R>& y) {
    return x.squaredNorm() < y.squaredNorm() ? y : x;
  };
  const vector3<R> along = longer(real(a), real(b));
  vector3<R> result = cross_product(real(a), real(b));
  if (result.squaredNorm() == 0) {
    result = longer(cross_product(along, vector3<R>(vector3<R>::UnitX())),
                    cross_product(along, vector3<R>(vector3<R>::UnitY())));
  }
  const R square = result.squaredNorm();
  return square == 0 ? vector3<T>(vector3<T>::UnitZ())
                     : vector3<T>((result / sqrt(square)).template cast<T>());
}

template <class T>
[[nodiscard]] T within_segment(const T& t) {
  return innermost(t) < 0 ? T(0) : innermost(t) > 1 ? T(1) : t;
}

/// Parameter t of the point from + t · along, 0 ≤ t ≤ 1, that is nearest to x.
template <class T>
[[nodiscard]] T nearest_to_point(const vector3<T>& x, const vector3<T>& from,
                                 const vector3<T>& along) {
  const T square = along.squaredNorm();
  return innermost(square) == 0 ? T(0) : within_segment(T(along.dot(x - from) / square));
}

// Signed distance of the nearest point x of a segment, and the direction out of the obstacle. The
// direction of the segment is needed if x is on the obstacle's axis or centre, or their difference
// is round-off: the direction out is then perpendicular to both.

/// Signed distance from all points within `radius` of an axis, whose point `nearest` is nearest to
/// x.
template <class T>
[[nodiscard]] point_distance<T> distance_from_axis(const vector3<T>& nearest, const vector3<T>& x,
                                                   const T& radius, const vector3<T>& along,
                                                   const vector3<T>& axis) {
  using std::sqrt;
  using R = real_type_t<T>;
  const vector3<T> difference = x - nearest;
  const T square = difference.squaredNorm();
  const R rounding = 8 * std::numeric_limits<R>::epsilon();
  if (innermost(square) <= rounding * rounding * innermost(x.squaredNorm())) {
    const vector3<T> out = across(along, axis);
    return {T(out.dot(difference) - radius), out};
  }
  const T length = sqrt(square);
  return {T(length - radius), vector3<T>(difference / length)};
}

template <class T>
[[nodiscard]] point_distance<T> signed_distance(const sphere<T>& s, const vector3<T>& x,
                                                const vector3<T>& along) {
  return distance_from_axis(s.centre, x, s.radius, along, vector3<T>(vector3<T>::Zero()));
}

template <class T>
[[nodiscard]] point_distance<T> signed_distance(const capsule<T>& c, const vector3<T>& x,
                                                const vector3<T>& along) {
  const vector3<T> axis = c.to - c.from;
  const vector3<T> nearest = c.from + nearest_to_point(x, c.from, axis) * axis;
  return distance_from_axis(nearest, x, c.radius, along, axis);
}

template <class T>
[[nodiscard]] point_distance<T> signed_distance(const half_space<T>& h, const vector3<T>& x,
                                                const vector3<T>&) {
  return {T(h.normal.dot(x) - h.offset), h.normal};
}

// The point of a segment from + t · along, 0 ≤ t ≤ 1, with the smallest signed distance from an
// obstacle. Which case holds is decided by real values; t itself is computed over the scalar.

template <class T>
[[nodiscard]] T nearest_on_segment(const sphere<T>& s, const vector3<T>& from,
                                   const vector3<T>& along) {
  return nearest_to_point(s.centre, from, along);
}

/// Nearest point of a segment to a capsule. Lines are nearest to each other where (w − t u) × v is
/// along n = u × v, w between their beginnings: t = (w × v)·n / n². If that is beyond an end of one
/// of the segments, an end is nearest. Products of coordinates, u²v² − (u·v)², would lose t to
/// cancellation if lines are nearly parallel.
///
/// There t is ill-conditioned, and the distance changes little with t: within 1e-6 of parallel t
/// counts as constant, or round-off times its rate would dominate gradients.
template <class T>
[[nodiscard]] T nearest_on_segment(const capsule<T>& c, const vector3<T>& from,
                                   const vector3<T>& along) {
  const vector3<T> axis = c.to - c.from;
  const T first = nearest_to_point(c.from, from, along);
  const T last = nearest_to_point(c.to, from, along);
  const vector3<T> normal = cross_product(along, axis);
  const T square = normal.squaredNorm();
  if (innermost(square) == 0) {
    return (first + last) / T(2); // the midpoint of the overlap
  }
  const auto distance = [&](const T& t) {
    const vector3<T> x = from + t * along;
    return innermost((x - c.from - nearest_to_point(x, c.from, axis) * axis).squaredNorm());
  };
  T best = within_segment(T(cross_product(vector3<T>(c.from - from), axis).dot(normal) / square));
  if (innermost(square) < 1e-12 * innermost(along.squaredNorm()) * innermost(axis.squaredNorm())) {
    best = T(innermost(best));
  }
  auto min_distance = distance(best);
  for (const T& end : {first, last, T(0), T(1)}) {
    const auto end_distance = distance(end);
    if (end_distance < min_distance) {
      min_distance = end_distance;
      best = end;
    }
  }
  return best;
}

template <class T>
[[nodiscard]] T nearest_on_segment(const half_space<T>& h, const vector3<T>&,
                                   const vector3<T>& along) {
  const auto slope = innermost(h.normal.dot(along));
  return slope == 0 ? T(1) / T(2) : T(slope < 0 ? 1 : 0);
}

} // namespace duet::detail
