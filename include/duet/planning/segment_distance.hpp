// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/math.hpp>
#include <duet/planning/shapes.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>

#include <cmath>

/// \file
/// Where a segment is nearest to what is round: points, spheres, capsules, and to half-spaces. For
/// those who extend duet.

namespace duet::detail {

/// The signed distance of a point and its gradient.
template <class T>
struct point_distance {
  T distance;
  vector3<T> normal;
};

template <class T>
[[nodiscard]] vector3<T> cross_product(const vector3<T>& a, const vector3<T>& b) {
  return cross(components(a), components(b));
}

/// A unit vector across both, or across one where the other has no length or the same direction.
template <class T>
[[nodiscard]] vector3<T> across(const vector3<T>& a, const vector3<T>& b) {
  using std::sqrt;
  const auto longer = [](const vector3<T>& x, const vector3<T>& y) {
    return innermost(x.squaredNorm()) < innermost(y.squaredNorm()) ? y : x;
  };
  vector3<T> result = cross_product(a, b);
  if (innermost(result.squaredNorm()) == 0) {
    const vector3<T> along = longer(a, b);
    result = cross_product(along, vector3<T>(vector3<T>::UnitX()));
    result = longer(result, cross_product(along, vector3<T>(vector3<T>::UnitY())));
    if (innermost(result.squaredNorm()) == 0) {
      return vector3<T>::UnitZ();
    }
  }
  return result / sqrt(T(result.squaredNorm()));
}

template <class T>
[[nodiscard]] T within_segment(const T& t) {
  return innermost(t) < 0 ? T(0) : innermost(t) > 1 ? T(1) : t;
}

/// Which point from + t · along, 0 ≤ t ≤ 1, is nearest to x.
template <class T>
[[nodiscard]] T nearest_to_point(const vector3<T>& x, const vector3<T>& from,
                                 const vector3<T>& along) {
  const T square = along.squaredNorm();
  return innermost(square) == 0 ? T(0) : within_segment(T(along.dot(x - from) / square));
}

// The signed distance of a point x of a segment, that which is nearest, and the direction out of
// the obstacle. The segment's own direction is needed where x is on the obstacle's axis or centre:
// what leads out is across both.

/// From what is all points within `radius` of an axis, at whose nearest point x is `apart`.
template <class T>
[[nodiscard]] point_distance<T> distance_from_axis(const vector3<T>& apart, const T& radius,
                                                   const vector3<T>& along,
                                                   const vector3<T>& axis) {
  using std::sqrt;
  const T square = apart.squaredNorm();
  if (innermost(square) == 0) {
    const vector3<T> out = across(along, axis);
    return {T(out.dot(apart) - radius), out};
  }
  const T length = sqrt(square);
  return {T(length - radius), vector3<T>(apart / length)};
}

template <class T>
[[nodiscard]] point_distance<T> signed_distance(const sphere<T>& s, const vector3<T>& x,
                                                const vector3<T>& along) {
  return distance_from_axis(vector3<T>(x - s.centre), s.radius, along,
                            vector3<T>(vector3<T>::Zero()));
}

template <class T>
[[nodiscard]] point_distance<T> signed_distance(const capsule<T>& c, const vector3<T>& x,
                                                const vector3<T>& along) {
  const vector3<T> axis = c.to - c.from;
  const vector3<T> nearest = c.from + nearest_to_point(x, c.from, axis) * axis;
  return distance_from_axis(vector3<T>(x - nearest), c.radius, along, axis);
}

template <class T>
[[nodiscard]] point_distance<T> signed_distance(const half_space<T>& h, const vector3<T>& x,
                                                const vector3<T>&) {
  return {T(h.normal.dot(x) - h.offset), h.normal};
}

// The point of a segment from + t · along, 0 ≤ t ≤ 1, with the least signed distance from an
// obstacle. Which case holds is decided by real values; t itself is computed over the scalar.

template <class T>
[[nodiscard]] T nearest_on_segment(const sphere<T>& s, const vector3<T>& from,
                                   const vector3<T>& along) {
  return nearest_to_point(s.centre, from, along);
}

/// Lines are nearest to each other where (w − t u) × v is along n = u × v, w between their
/// beginnings: t = (w × v)·n / n². Where that is beyond an end of one of the segments, an end is
/// nearest. Products of coordinates, u²v² − (u·v)², would lose t where lines are nearly parallel.
template <class T>
[[nodiscard]] T nearest_on_segment(const capsule<T>& c, const vector3<T>& from,
                                   const vector3<T>& along) {
  const vector3<T> axis = c.to - c.from;
  const T first = nearest_to_point(c.from, from, along);
  const T last = nearest_to_point(c.to, from, along);
  const vector3<T> normal = cross_product(along, axis);
  const T square = normal.squaredNorm();
  if (innermost(square) == 0) {
    return (first + last) / T(2); // the middle of where they are beside each other
  }
  const auto distance = [&](const T& t) {
    const vector3<T> x = from + t * along;
    return innermost((x - c.from - nearest_to_point(x, c.from, axis) * axis).squaredNorm());
  };
  T best = within_segment(T(cross_product(vector3<T>(c.from - from), axis).dot(normal) / square));
  auto least = distance(best);
  for (const T& end : {first, last, T(0), T(1)}) {
    const auto here = distance(end);
    if (here < least) {
      least = here;
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
