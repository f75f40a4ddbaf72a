// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/planning/nearest_on_segment.hpp>
#include <duet/planning/shapes.hpp>

#include <Eigen/Core>

#include <cmath>
#include <concepts>

/// \file
/// How far a capsule is from an obstacle, and where.

namespace duet {

/// Where a body is nearest to an obstacle, or deepest in it.
template <class T>
struct proximity {
  T distance;             ///< negative where they overlap: by how much
  vector3<T> on_body;     ///< the point of the body's surface
  vector3<T> on_obstacle; ///< the point of the obstacle's surface
  vector3<T> normal;      ///< unit, out of the obstacle: on_body = on_obstacle + distance · normal
};

namespace detail {

/// The signed distance of a point and its gradient.
template <class T>
struct point_distance {
  T distance;
  vector3<T> normal;
};

template <class T>
[[nodiscard]] point_distance<T> signed_distance(const sphere<T>& s, const vector3<T>& x) {
  using std::sqrt;
  const vector3<T> apart = x - s.centre;
  const T square = apart.squaredNorm();
  if (innermost(square) == 0) {
    const vector3<T> up = vector3<T>::UnitZ(); // any direction leads out
    return {T(up.dot(apart) - s.radius), up};
  }
  const T length = sqrt(square);
  return {T(length - s.radius), vector3<T>(apart / length)};
}

template <class T>
[[nodiscard]] point_distance<T> signed_distance(const half_space<T>& h, const vector3<T>& x) {
  return {T(h.normal.dot(x) - h.offset), h.normal};
}

template <class T>
[[nodiscard]] point_distance<T> signed_distance(const box<T>& b, const vector3<T>& x) {
  using std::sqrt;
  const vector3<T> local = transform_point(conj(b.placed), x);
  vector3<T> excess, outside;
  vector3<T> normal = vector3<T>::Zero();
  Eigen::Index face = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const T sign(innermost(local[i]) < 0 ? -1 : 1);
    excess[i] = sign * local[i] - b.half_sizes[i];
    outside[i] = innermost(excess[i]) > 0 ? T(sign * excess[i]) : T(0);
    if (innermost(excess[i]) > innermost(excess[face])) {
      face = i;
    }
  }
  const T square = outside.squaredNorm();
  if (innermost(square) > 0) {
    const T length = sqrt(square);
    return {length, transform_direction(b.placed, vector3<T>(outside / length))};
  }
  normal[face] = T(innermost(local[face]) < 0 ? -1 : 1);
  return {excess[face], transform_direction(b.placed, normal)};
}

template <class S, class T>
[[nodiscard]] sphere<S> with_scalar(const sphere<T>& s) {
  return {s.centre.template cast<S>(), S(s.radius)};
}
template <class S, class T>
[[nodiscard]] capsule<S> with_scalar(const capsule<T>& c) {
  return {c.from.template cast<S>(), c.to.template cast<S>(), S(c.radius)};
}
template <class S, class T>
[[nodiscard]] box<S> with_scalar(const box<T>& b) {
  return {dual_quaternion<S>(b.placed), b.half_sizes.template cast<S>()};
}
template <class S, class T>
[[nodiscard]] half_space<S> with_scalar(const half_space<T>& h) {
  return {h.normal.template cast<S>(), S(h.offset)};
}

} // namespace detail

/// The least of dist(x) − r over the points x of a capsule's axis, r its radius: exact, without
/// iteration. dist is an obstacle's signed distance, in a box minus that to the nearest face.
///
/// Derivatives by any infinitesimals in body and obstacle are those of the distance and of the
/// points. Where several points are as near they are those of one of them, in the middle of a side
/// that is parallel to the axis.
/// \param body  a capsule or a sphere
/// \param obstacle  a sphere, a `box` or a `half_space`
template <template <class> class Body, class T, template <class> class Obstacle, class U>
  requires Promotable<T, U> && std::constructible_from<capsule<T>, Body<T>>
[[nodiscard]] proximity<promote_t<T, U>> closest_points(const Body<T>& body,
                                                        const Obstacle<U>& obstacle) {
  using S = promote_t<T, U>;
  const auto c = detail::with_scalar<S>(capsule<T>(body));
  const auto o = detail::with_scalar<S>(obstacle);
  const vector3<S> along = c.to - c.from;
  const vector3<S> x = c.from + detail::nearest_on_segment(o, c.from, along) * along;
  const auto [distance, normal] = detail::signed_distance(o, x);
  return {S(distance - c.radius), vector3<S>(x - c.radius * normal),
          vector3<S>(x - distance * normal), normal};
}

} // namespace duet
