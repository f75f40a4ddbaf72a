// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

/// \file
/// Rigid displacements as rotation and origin, of numbers and known constants: the representation
/// used by the forward kinematics of chains.

namespace duet::detail {

/// A quaternion whose components are numbers or known constants.
template <class W, class X, class Y, class Z>
struct partially_constant_quaternion {
  W w_;
  X x_;
  Y y_;
  Z z_;

  [[nodiscard]] constexpr const W& w() const { return w_; }
  [[nodiscard]] constexpr const X& x() const { return x_; }
  [[nodiscard]] constexpr const Y& y() const { return y_; }
  [[nodiscard]] constexpr const Z& z() const { return z_; }

  template <class S>
  DUET_ALWAYS_INLINE constexpr operator quaternion<S>() const {
    return {number<S>(w_), number<S>(x_), number<S>(y_), number<S>(z_)};
  }
};
template <class W, class X, class Y, class Z>
partially_constant_quaternion(W, X, Y, Z) -> partially_constant_quaternion<W, X, Y, Z>;

/// Quaternion returned by a stateless callable, with types for 0 and ±1.
template <class Get>
[[nodiscard]] constexpr auto known_quaternion(Get) {
  return partially_constant_quaternion{
      known([] { return Get{}().w(); }), known([] { return Get{}().x(); }),
      known([] { return Get{}().y(); }), known([] { return Get{}().z(); })};
}
template <class Get>
[[nodiscard]] constexpr auto known_vector(Get) {
  return three_vector{known([] { return Get{}().x; }), known([] { return Get{}().y; }),
                      known([] { return Get{}().z; })};
}

template <Number S, class W, class X, class Y, class Z>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto
operator*(const S& s, const partially_constant_quaternion<W, X, Y, Z>& q) {
  return partially_constant_quaternion{s * q.w(), s * q.x(), s * q.y(), s * q.z()};
}
template <class A, class B, class C, class D, class W, class X, class Y, class Z>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto
operator+(const partially_constant_quaternion<A, B, C, D>& p,
          const partially_constant_quaternion<W, X, Y, Z>& q) {
  return partially_constant_quaternion{p.w() + q.w(), p.x() + q.x(), p.y() + q.y(), p.z() + q.z()};
}
/// N1
template <class A, class B, class C, class D, class W, class X, class Y, class Z>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto
operator*(const partially_constant_quaternion<A, B, C, D>& p,
          const partially_constant_quaternion<W, X, Y, Z>& q) {
  return partially_constant_quaternion{
      p.w() * q.w() - p.x() * q.x() - p.y() * q.y() - p.z() * q.z(),
      p.w() * q.x() + p.x() * q.w() + p.y() * q.z() - p.z() * q.y(),
      p.w() * q.y() - p.x() * q.z() + p.y() * q.w() + p.z() * q.x(),
      p.w() * q.z() + p.x() * q.y() - p.y() * q.x() + p.z() * q.w()};
}

/// Displacement x ↦ R x + t: axes and origin of one frame in another.
template <class Q, class V>
struct displacement {
  Q rotation;
  V translation;

  /// R x + t
  template <class X, class Y, class Z>
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr auto point(const three_vector<X, Y, Z>& x) const {
    return translation + rotated(rotation, x);
  }

  template <class S>
  DUET_ALWAYS_INLINE constexpr operator displacement<quaternion<S>, three_vector<S>>() const {
    return {rotation, translation};
  }
};
template <class Q, class V>
displacement(Q, V) -> displacement<Q, V>;

/// Composition: b first, then a, in fixed axes.
template <class Q, class V, class P, class U>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator*(const displacement<Q, V>& a,
                                                          const displacement<P, U>& b) {
  return displacement{a.rotation * b.rotation, a.point(b.translation)};
}

} // namespace duet::detail
