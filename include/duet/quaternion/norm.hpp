// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

/// \file
/// Norm, normalisation and inverse (N3), safe from overflow and underflow.

namespace duet {
namespace detail {

/// The real numbers that a quaternion's components are.
template <class T>
[[nodiscard]] constexpr quaternion<real_type_t<T>> innermost_of(const quaternion<T>& q) {
  return {innermost(q.w()), innermost(q.x()), innermost(q.y()), innermost(q.z())};
}

template <real R>
[[nodiscard]] R largest_component(const quaternion<R>& q) {
  using std::abs;
  using std::max;
  return max(max(R(abs(q.w())), R(abs(q.x()))), max(R(abs(q.y())), R(abs(q.z()))));
}

/// Squares beyond these limits, or their powers in derivatives of the first orders, overflow or
/// lose digits.
template <real R>
[[nodiscard]] bool is_moderate(const R& square) {
  if constexpr (std::numeric_limits<R>::max_exponent >= 1024) {
    return square > R(0x1p-100) && square < R(0x1p100);
  } else {
    return square > R(0x1p-20) && square < R(0x1p20);
  }
}

/// Exactly zero in all components: squares of small numbers vanish too, and NaN is not zero.
template <class T>
[[nodiscard]] bool is_zero(const quaternion<T>& q) {
  return innermost(q.w()) == 0 && innermost(q.x()) == 0 && innermost(q.y()) == 0 &&
         innermost(q.z()) == 0;
}

/// e such that 2^−e brings a number near 1.
template <real R>
[[nodiscard]] int binary_exponent(const R& x) {
  using std::frexp;
  int exponent = 0;
  static_cast<void>(frexp(x, &exponent));
  return exponent;
}

/// q · 2^−e: exact, and a constant factor under differentiation.
template <class T>
[[nodiscard]] quaternion<T> scaled_down(const quaternion<T>& q, int e) {
  using std::ldexp;
  return {ldexp(q.w(), -e), ldexp(q.x(), -e), ldexp(q.y(), -e), ldexp(q.z(), -e)};
}

template <class T>
void require_not_zero(const quaternion<T>& q, const char* function) {
  if (is_zero(q)) {
    throw invalid_input(std::string("duet: ") + function + " of the zero quaternion");
  }
}

} // namespace detail

/// N3: |q|. Zero for the zero quaternion, where it has no derivative.
template <class T>
[[nodiscard]] T norm(const quaternion<T>& q) {
  using std::ldexp;
  using std::sqrt;
  const T square = norm2(q);
  if (detail::is_moderate(innermost(square))) [[likely]] {
    return sqrt(square);
  }
  const auto largest = detail::largest_component(detail::innermost_of(q));
  if (!(largest > 0) || !(largest <= std::numeric_limits<real_type_t<T>>::max())) {
    return sqrt(square); // zero, infinite or not a number
  }
  const int e = detail::binary_exponent(largest);
  return ldexp(T(sqrt(norm2(detail::scaled_down(q, e)))), e);
}

/// q/|q|.
/// \throws invalid_input for the zero quaternion
template <class T>
[[nodiscard]] quaternion<T> normalized(const quaternion<T>& q) {
  using std::sqrt;
  const T square = norm2(q);
  if (detail::is_moderate(innermost(square))) [[likely]] {
    return q / T(sqrt(square));
  }
  detail::require_not_zero(q, "normalized");
  const auto largest = detail::largest_component(detail::innermost_of(q));
  const auto near_one = detail::scaled_down(q, detail::binary_exponent(largest));
  return near_one / norm(near_one);
}

/// N3: q⁻¹ = q*/|q|²; for a unit quaternion use `conj`.
/// \throws invalid_input for the zero quaternion
template <class T>
[[nodiscard]] quaternion<T> inverse(const quaternion<T>& q) {
  const T square = norm2(q);
  if (detail::is_moderate(innermost(square))) [[likely]] {
    return conj(q) / square;
  }
  detail::require_not_zero(q, "inverse");
  const auto largest = detail::largest_component(detail::innermost_of(q));
  const int e = detail::binary_exponent(largest);
  const auto near_one = detail::scaled_down(q, e);
  return detail::scaled_down(conj(near_one) / norm2(near_one), e);
}

} // namespace duet
