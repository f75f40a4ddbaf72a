// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/constants.hpp>
#include <duet/dual/stumpff.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/undetermined.hpp>

#include <cmath>
#include <limits>

/// \file
/// Exponential, logarithm, powers (N4, N5) and spherical interpolation (N9), in half angles.
///
/// All work in s = v·v through functions that are regular at s = 0, so the identity, a pure
/// translation and every order of derivative need no special case.

namespace duet {

/// exp(v) of a pure quaternion: cos|v| + v sin|v|/|v| (N4). v = ½ × rotation vector.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE quaternion<T> exp(const vector3<T>& v) {
  const T s = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  const T ratio = stumpff<1>(s);
  return {stumpff<0>(s), v[0] * ratio, v[1] * ratio, v[2] * ratio};
}

/// exp(w + v) = e^w (cos|v| + v sin|v|/|v|) (N4).
template <class T>
[[nodiscard]] quaternion<T> exp(const quaternion<T>& q) {
  using std::exp;
  return duet::exp(q.vec()) * T(exp(q.w()));
}

namespace detail {

/// Below this ratio of squares of vector part and whole, a full turn is near: |v|⁻³ and higher
/// powers in the derivatives by s would overflow before those by v do.
template <real R>
inline constexpr auto near_full_turn = R(std::numeric_limits<R>::max_exponent >= 1024 ? 0x1p-100
                                                                                       : 0x1p-20);

/// û φ where |q| is out of range or a full turn is near.
template <class T>
[[nodiscard]] vector3<T> log_vector_of_extreme(const quaternion<T>& q, const char* function) {
  using real = real_type_t<T>;
  require_not_zero(q, function);
  const quaternion<T> near_one =
      scaled_down(q, binary_exponent(largest_component(innermost_of(q))));
  const quaternion<T> v(T(0), near_one.x(), near_one.y(), near_one.z());
  const T s = norm2(v);
  if (innermost(q.w()) > 0 || innermost(s) > near_full_turn<real>) {
    return vector3<T>(v.vec() * arc_ratio(s, near_one.w()));
  }
  const real pi = constant::pi<real>();
  if (is_zero(v)) {
    return {undetermined(pi, q.x(), q.y(), q.z()), undetermined(real(0), q.x(), q.y(), q.z()),
            undetermined(real(0), q.x(), q.y(), q.z())};
  }
  // atan2(|v|, w) = π − atan2(|v|, −w)
  const T short_way = arc_ratio(s, T(-near_one.w()));
  const quaternion<T> axis = normalized(v);
  return {axis.x() * pi - v.x() * short_way, axis.y() * pi - v.y() * short_way,
          axis.z() * pi - v.z() * short_way};
}

/// û φ, the vector part of log q; `s` = |q⃗|², `square` = |q|².
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE vector3<T> log_vector(const quaternion<T>& q, const T& s,
                                                       const T& square, const char* function) {
  using real = real_type_t<T>;
  const real& value = innermost(square);
  if (!is_moderate(value) ||
      (innermost(q.w()) < 0 && innermost(s) < value * near_full_turn<real>)) [[unlikely]] {
    return log_vector_of_extreme(q, function);
  }
  const T ratio = arc_ratio(s, q.w());
  return {q.x() * ratio, q.y() * ratio, q.z() * ratio};
}
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE vector3<T> log_vector(const quaternion<T>& q,
                                                       const char* function) {
  const T s = q.x() * q.x() + q.y() * q.y() + q.z() * q.z();
  return log_vector(q, s, T(s + q.w() * q.w()), function);
}

/// log|q|; `square` = |q|².
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE T log_norm(const quaternion<T>& q, const T& square) {
  using std::log;
  if (is_moderate(innermost(square))) [[likely]] {
    return log(square) / 2;
  }
  const int e = binary_exponent(largest_component(innermost_of(q)));
  return log(norm2(scaled_down(q, e))) / 2 + e * constant::ln2<real_type_t<T>>();
}

} // namespace detail

/// log q = log|q| + û φ, φ = atan2(|q⃗|, q₀) ∈ [0, π] (N4): the inverse of exp, in half angles.
///
/// Never flips the sign of q, so log(−q) is the logarithm the long way round. Singular at q = −|q|,
/// a full turn, where the axis is undetermined: the value there is (log|q|, π, 0, 0), and
/// derivatives by the vector part are NaN. \throws invalid_input for the zero quaternion
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE quaternion<T> log(const quaternion<T>& q) {
  const T s = q.x() * q.x() + q.y() * q.y() + q.z() * q.z();
  const T square = s + q.w() * q.w();
  const vector3<T> v = detail::log_vector(q, s, square, "log");
  return {detail::log_norm(q, square), v[0], v[1], v[2]};
}

/// q^ρ = |q|^ρ (cos ρφ + û sin ρφ) (N5), ρ any scalar. Where q = −|q| the axis is undetermined, see
/// `log`.
/// \throws invalid_input for the zero quaternion
template <class T, scalar_for<T> S>
[[nodiscard]] quaternion<promote_t<T, S>> pow(const quaternion<T>& q, const S& exponent) {
  using std::pow;
  using R = promote_t<T, S>;
  const vector3<T> v = detail::log_vector(q, "pow");
  return duet::exp(vector3<R>(v[0] * exponent, v[1] * exponent, v[2] * exponent)) *
         R(pow(norm(q), exponent));
}

/// SLERP from a to b, both of unit norm: a (a* b)^τ (N9), along the shorter arc: b's sign is
/// aligned with a's first. Where a and b are a half turn apart the arcs are equal and b is taken as
/// it is. \throws invalid_input where a or b is zero
template <class A, class B, class S>
  requires promotable<A, B> && scalar_for<S, promote_t<A, B>>
[[nodiscard]] auto slerp(const quaternion<A>& a, const quaternion<B>& b, const S& tau) {
  using T = promote_t<A, B>;
  const T cosine = dot(a, b);
  const bool other_side = innermost(cosine) < 0;
  // a* a has no vector part. Subtracting it first keeps all digits of a small rotation.
  const quaternion<T> difference = conj(a) * ((other_side ? -b : b) - a);
  const quaternion<T> relative(other_side ? -cosine : cosine, difference.x(), difference.y(),
                               difference.z());
  const vector3<T> v = detail::log_vector(relative, "slerp");
  using R = promote_t<T, S>;
  return a * duet::exp(vector3<R>(v[0] * tau, v[1] * tau, v[2] * tau));
}

} // namespace duet
