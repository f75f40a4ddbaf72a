// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/box_distance.hpp>
#include <duet/kinematics/segment_distance.hpp>
#include <duet/kinematics/shapes.hpp>

#include <concepts>

/// \file
/// Signed distance and closest points of a capsule and an obstacle or another capsule.

namespace duet {

/// Closest points of a body and an obstacle or another body, or the deepest ones if they overlap.
template <class T>
struct proximity {
  T distance = T(0); ///< signed distance; if they overlap, negative, the penetration depth
  /// Point of the body's surface.
  vector3<T> on_body = detail::zero_initialized<vector3<T>>();
  /// Point of the obstacle's surface.
  vector3<T> on_obstacle = detail::zero_initialized<vector3<T>>();
  /// Unit normal out of the obstacle: on_body = on_obstacle + distance · normal.
  vector3<T> normal = detail::zero_initialized<vector3<T>>();

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("distance", distance);
    f("on_body", on_body);
    f("on_obstacle", on_obstacle);
    f("normal", normal);
  }
};

namespace detail {

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
  return {dual_quaternion<S>(b.pose), b.half_extents.template cast<S>()};
}
template <class S, class T>
[[nodiscard]] half_space<S> with_scalar(const half_space<T>& h) {
  return {h.normal.template cast<S>(), S(h.offset)};
}

} // namespace detail

/// Signed distance and closest points: the minimum of dist(x) − r over the points x of a capsule's
/// axis, r its radius; exact, without iteration. dist is an obstacle's signed distance, in a box
/// minus that to the nearest face.
///
/// Derivatives with respect to any infinitesimals in body and obstacle are those of the distance
/// and of the points. If several points are equally near they are those of one of them, in the
/// middle of a side that is parallel to the axis. If axes cross or touch, they are those of a
/// separating motion perpendicular to both.
///
/// \param body  a capsule or a sphere
/// \param obstacle  a sphere, a capsule, a `box` or a `half_space`
template <template <class> class Body, class T, template <class> class Obstacle, class U>
  requires Promotable<T, U> && std::constructible_from<capsule<T>, Body<T>>
[[nodiscard]] proximity<promote_t<T, U>> closest_points(const Body<T>& body,
                                                        const Obstacle<U>& obstacle) {
  using S = promote_t<T, U>;
  const auto c = detail::with_scalar<S>(capsule<T>(body));
  const auto o = detail::with_scalar<S>(obstacle);
  const vector3<S> along = c.to - c.from;
  const vector3<S> x = c.from + detail::nearest_on_segment(o, c.from, along) * along;
  const auto [distance, normal] = detail::signed_distance(o, x, along);
  return {S(distance - c.radius), vector3<S>(x - c.radius * normal),
          vector3<S>(x - distance * normal), normal};
}

} // namespace duet
