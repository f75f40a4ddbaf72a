// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/stumpff.hpp>
#include <duet/quaternion/quaternion.hpp>

/// \file
/// What a rate of the rotation vector r does to the rotation exp(½r): the Jacobians of the
/// exponential and their inverses in closed form.
///
/// Over dual numbers the same functions are those of rigid motion, see dual_quaternion/.

namespace duet {

namespace detail {

/// a I + b r̂ + c r rᵀ
template <class T>
[[nodiscard]] matrix3<T> axial_matrix(const T& a, const T& b, const T& c, const vector3<T>& r) {
  const vector3<T> axial(b * r[0], b * r[1], b * r[2]);
  const vector3<T> cr(c * r[0], c * r[1], c * r[2]);
  const T xy = cr[0] * r[1];
  const T xz = cr[0] * r[2];
  const T yz = cr[1] * r[2];
  matrix3<T> m;
  m << a + cr[0] * r[0], xy - axial[2], xz + axial[1], //
      xy + axial[2], a + cr[1] * r[1], yz - axial[0],  //
      xz - axial[1], yz + axial[0], a + cr[2] * r[2];
  return m;
}

template <class T>
[[nodiscard]] matrix3<T> exponential_jacobian(const vector3<T>& r, int sign) {
  const T s = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
  return axial_matrix<T>(stumpff<1>(s), sign * stumpff<2>(s), stumpff<3>(s), r);
}

template <class T>
[[nodiscard]] matrix3<T> exponential_jacobian_inverse(const vector3<T>& r, int sign) {
  const T quarter = (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]) / 4;
  const T ratio = 1 / stumpff<1>(quarter);
  return axial_matrix<T>(stumpff<0>(quarter) * ratio, T(-sign) / 2,
                         (stumpff<2>(quarter) - stumpff<3>(quarter)) * ratio / 4, r);
}

} // namespace detail

/// J_l with ω^s = J_l(r) ṙ for the rotation exp(½r), r its rotation vector in radians:
/// J_l = c₁ I + c₂ r̂ + c₃ r rᵀ, cₙ the Stumpff functions of r·r.
template <class T>
[[nodiscard]] matrix3<T> left_jacobian(const vector3<T>& r) {
  return detail::exponential_jacobian(r, 1);
}
/// J_r with ω^b = J_r(r) ṙ: J_r(r) = J_l(−r) = J_l(r)ᵀ.
template <class T>
[[nodiscard]] matrix3<T> right_jacobian(const vector3<T>& r) {
  return detail::exponential_jacobian(r, -1);
}
/// J_l⁻¹ with ṙ = J_l⁻¹(r) ω^s: (φ/2)cot(φ/2) I − ½ r̂ + (1 − (φ/2)cot(φ/2)) r rᵀ/φ², φ = |r|.
/// Infinite at full turns φ = 2π, 4π …, where exp(½r) stands still in two directions of r.
template <class T>
[[nodiscard]] matrix3<T> left_jacobian_inverse(const vector3<T>& r) {
  return detail::exponential_jacobian_inverse(r, 1);
}
/// J_r⁻¹ with ṙ = J_r⁻¹(r) ω^b.
template <class T>
[[nodiscard]] matrix3<T> right_jacobian_inverse(const vector3<T>& r) {
  return detail::exponential_jacobian_inverse(r, -1);
}

} // namespace duet
