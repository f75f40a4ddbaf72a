// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/math.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <cmath>
#include <concepts>
#include <string>

/// \file
/// Dual numbers, vectors and quaternions of rigid motion, and their parts (N10–N16).
///
/// A dual quaternion is a quaternion over dual numbers. Product, norm, exponential, logarithm and
/// powers are those of quaternion/; there is no second implementation.

namespace duet {

/// A dual number a + εb of rigid motion (N10), T any scalar, derivative duals included.
template <class T>
using screw_dual = dual<T, 1, screw_tag>;
/// A dual vector a⃗ + εb⃗: a line, a screw, a twist (N12).
template <class T>
using dual_vector = vector3<screw_dual<T>>;
/// A dual quaternion, p + εq of quaternions p and q, or four dual numbers: both readings of N13 are
/// this one object.
template <class T>
using dual_quaternion = quaternion<screw_dual<T>>;

/// The dual vector a + εb.
template <class A, Promotable<A> B>
[[nodiscard]] dual_vector<detail::differentiable_t<promote_t<A, B>>>
make_dual_vector(const vector3<A>& a, const vector3<B>& b) {
  using T = detail::differentiable_t<promote_t<A, B>>;
  using D = screw_dual<T>;
  return {D(T(a[0]), T(b[0])), D(T(a[1]), T(b[1])), D(T(a[2]), T(b[2]))};
}
/// The dual quaternion p + εq.
template <class A, Promotable<A> B>
[[nodiscard]] constexpr dual_quaternion<promote_t<A, B>>
make_dual_quaternion(const quaternion<A>& p, const quaternion<B>& q) {
  using T = promote_t<A, B>;
  using D = screw_dual<T>;
  return {D(T(p.w()), T(q.w())), D(T(p.x()), T(q.x())), D(T(p.y()), T(q.y())),
          D(T(p.z()), T(q.z()))};
}

/// The real part p of p + εq.
template <class T>
[[nodiscard]] constexpr quaternion<T> real_part(const dual_quaternion<T>& a) {
  return {a.w().value(), a.x().value(), a.y().value(), a.z().value()};
}
/// The dual part q of p + εq.
template <class T>
[[nodiscard]] constexpr quaternion<T> dual_part(const dual_quaternion<T>& a) {
  return {a.w().epsilon(), a.x().epsilon(), a.y().epsilon(), a.z().epsilon()};
}
/// The real part a of a + εb.
template <class T>
[[nodiscard]] vector3<T> real_part(const dual_vector<T>& v) {
  return {v[0].value(), v[1].value(), v[2].value()};
}
/// The dual part b of a + εb.
template <class T>
[[nodiscard]] vector3<T> dual_part(const dual_vector<T>& v) {
  return {v[0].epsilon(), v[1].epsilon(), v[2].epsilon()};
}

/// The rotation α of a pose.
template <class T>
[[nodiscard]] constexpr quaternion<T> rotation(const dual_quaternion<T>& a) {
  return real_part(a);
}
/// N17: the translation t = 2 β α* of a pose.
template <class T>
[[nodiscard]] vector3<T> translation(const dual_quaternion<T>& a) {
  const quaternion<T> half = dual_part(a) * conj(real_part(a));
  return {2 * half.x(), 2 * half.y(), 2 * half.z()};
}

/// N10: the conjugate a − εb of a dual number. (`conj` of a scalar is the identity in generic
/// code.)
template <class T>
[[nodiscard]] constexpr screw_dual<T> dual_conj(const screw_dual<T>& d) {
  return {d.value(), -d.epsilon()};
}
/// N15: the second conjugate p − εq, which preserves products: (AB)° = A° B°.
template <class T>
[[nodiscard]] constexpr dual_quaternion<T> dual_conj(const dual_quaternion<T>& a) {
  return {dual_conj(a.w()), dual_conj(a.x()), dual_conj(a.y()), dual_conj(a.z())};
}
/// N15: the third conjugate p* − εq*, which transforms points: A (1 + εx) A^(3) = 1 + ε(Rx + t).
/// (The first conjugate is `conj`: p* + εq*, the inverse of a pose, which transforms lines.)
template <class T>
[[nodiscard]] constexpr dual_quaternion<T> point_conj(const dual_quaternion<T>& a) {
  return dual_conj(conj(a));
}

/// N16: true if A is a pose (a unit dual quaternion): A A* = 1, that is |p| = 1 and p·q = 0, each
/// to within the tolerance. `normalized` restores both.
template <class T>
[[nodiscard]] auto is_unit(const dual_quaternion<T>& a, double tolerance = 1e-12) {
  using std::abs;
  const screw_dual<T> square = squared_norm(a);
  return abs(innermost(square.value()) - 1) <= tolerance &&
         abs(innermost(square.epsilon())) <= tolerance;
}

/// A pose as `(w, x, y, z) at (x, y, z)`, its rotation and its translation, numbers to six digits;
/// anything that is not a pose as its four dual numbers.
template <Real T>
[[nodiscard]] std::string to_text(const dual_quaternion<T>& a) {
  using std::abs;
  const screw_dual<T> square = squared_norm(a);
  const T dual_norm = norm(dual_part(a));
  if (!(abs(square.value() - 1) <= 1e-6 && abs(square.epsilon()) <= 1e-6 * (1 + dual_norm))) {
    return detail::message(a);
  }
  const vector3<T> t = translation(a);
  return detail::message(rotation(a), " at (", t[0], ", ", t[1], ", ", t[2], ")");
}

DUET_REFUSES_FOREIGN(rotation, quaternion<double>)
DUET_REFUSES_FOREIGN(translation, vector3<double>)

} // namespace duet
