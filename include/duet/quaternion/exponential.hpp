// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/stumpff.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>

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

/// π, which no neighbouring quaternion's logarithm tends to: the slope is undefined.
struct undetermined_axis {
  template <class T>
  T value(const T&) const {
    return T(constant::pi<real_type_t<T>>());
  }
  template <class T>
  T slope(const T&, const T&) const {
    return T(std::numeric_limits<real_type_t<T>>::quiet_NaN());
  }
};

template <class T>
[[nodiscard]] T pi_of_undetermined_axis(const T& x) {
  if constexpr (infinitesimal<T>) {
    return lift(undetermined_axis{}, x);
  } else {
    return undetermined_axis{}.value(x);
  }
}

/// The logarithm where |q|² is out of range, or where a full turn's vector part is so small that
/// its square loses digits: L is homogeneous of degree −1, so both arguments are scaled.
template <class T>
[[nodiscard]] quaternion<T> log_scaled(const quaternion<T>& q) {
  using std::ldexp;
  using std::log;
  using real = real_type_t<T>;
  const auto values = innermost_of(q);
  const real largest = largest_component(values);
  if (largest == 0) {
    throw_zero_quaternion("log");
  }
  const int e = binary_exponent(largest);
  const quaternion<T> near_one = scaled_down(q, e);
  const T magnitude = log(norm2(near_one)) / 2 + e * constant::ln2<real>();
  const real largest_of_vector =
      largest_component(quaternion<real>(real(0), values.x(), values.y(), values.z()));
  if (largest_of_vector == 0 && values.w() < 0) {
    const T zero = q.x() * 0 + q.y() * 0;
    return {magnitude, pi_of_undetermined_axis(T(q.x() + q.y() + q.z())), zero, zero};
  }
  const bool near_full_turn = values.w() < 0 && largest_of_vector < ldexp(real(1), e - 100);
  const quaternion<T> r =
      near_full_turn ? scaled_down(q, binary_exponent(largest_of_vector)) : near_one;
  const vector3<T> v = r.vec();
  const T ratio = arc_ratio(T(v.squaredNorm()), r.w());
  return {magnitude, v[0] * ratio, v[1] * ratio, v[2] * ratio};
}

} // namespace detail

/// log q = log|q| + û φ, φ = atan2(|q⃗|, q₀) ∈ [0, π] (N4): the inverse of exp, in half angles.
///
/// Never flips the sign of q, so log(−q) is the logarithm the long way round. Singular at q = −|q|,
/// a full turn, where the axis is undetermined: the value there is (log|q|, π, 0, 0), and
/// derivatives are NaN. \throws invalid_input for the zero quaternion
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE quaternion<T> log(const quaternion<T>& q) {
  using std::log;
  const T s = q.x() * q.x() + q.y() * q.y() + q.z() * q.z();
  const T square = s + q.w() * q.w();
  const auto& value = innermost(square);
  if (!detail::is_moderate(value) ||
      (innermost(q.w()) < 0 && innermost(s) < value * real_type_t<T>(0x1p-100))) [[unlikely]] {
    return detail::log_scaled(q);
  }
  const T ratio = arc_ratio(s, q.w());
  return {log(square) / 2, q.x() * ratio, q.y() * ratio, q.z() * ratio};
}

/// q^ρ = exp(ρ log q) = |q|^ρ (cos ρφ + û sin ρφ) (N5), ρ any scalar.
/// \throws invalid_input for the zero quaternion
template <class T, scalar_for<T> S>
[[nodiscard]] quaternion<promote_t<T, S>> pow(const quaternion<T>& q, const S& exponent) {
  return exp(log(q) * exponent);
}

/// SLERP from a to b, both of unit norm: a (a* b)^τ (N9), along the shorter arc: b's sign is
/// aligned with a's first. Where a and b are a half turn apart the arcs are equal and b is taken as
/// it is.
template <class A, class B, class S>
  requires promotable<A, B> && scalar_for<S, promote_t<A, B>>
[[nodiscard]] auto slerp(const quaternion<A>& a, const quaternion<B>& b, const S& tau) {
  const auto relative = conj(a) * b;
  const auto v = log(innermost(relative.w()) < 0 ? -relative : relative).vec();
  using T = promote_t<promote_t<A, B>, S>;
  return a * duet::exp(vector3<T>(v[0] * tau, v[1] * tau, v[2] * tau));
}

} // namespace duet
