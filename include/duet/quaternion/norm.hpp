// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/partials.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

/// \file
/// Norm, normalisation and inverse (N3), safe from overflow and underflow.

namespace duet {

/// Tolerance on the norm of a unit quaternion that is passed in: tables are printed with few
/// digits.
inline constexpr double unit_norm_tolerance = 1e-3;

namespace detail {

/// The innermost real numbers of a quaternion's components.
template <class T>
[[nodiscard]] constexpr quaternion<real_type_t<T>> innermost_of(const quaternion<T>& q) {
  return {innermost(q.w()), innermost(q.x()), innermost(q.y()), innermost(q.z())};
}

template <Real R>
[[nodiscard]] R largest_component(const quaternion<R>& q) {
  using std::abs;
  using std::max;
  return max(max(R(abs(q.w())), R(abs(q.x()))), max(R(abs(q.y())), R(abs(q.z()))));
}

/// Lower bound of moderate squares: squares below it or above its inverse, or their powers in
/// low-order derivatives,
/// overflow or lose precision.
template <Real R>
[[nodiscard]] R min_moderate() {
  return R(std::numeric_limits<R>::max_exponent >= 1024 ? 0x1p-100 : 0x1p-20);
}
template <Real R>
[[nodiscard]] auto is_moderate(const R& square) {
  return square > min_moderate<R>() && square < 1 / min_moderate<R>();
}

/// Exactly zero in all components: squares of small numbers vanish too, and NaN is not zero.
template <class T>
[[nodiscard]] auto is_zero(const quaternion<T>& q) {
  return innermost(q.w()) == 0 && innermost(q.x()) == 0 && innermost(q.y()) == 0 &&
         innermost(q.z()) == 0;
}

template <class T>
[[nodiscard]] constexpr bool is_all_finite(const quaternion<T>& q) {
  return is_all_finite(q.w()) && is_all_finite(q.x()) && is_all_finite(q.y()) &&
         is_all_finite(q.z());
}

/// e such that 2^−e brings a number near 1; 0 for zero and non-finite numbers.
template <Real R>
[[nodiscard]] int binary_exponent(const R& x) {
  using std::frexp;
  int exponent = 0;
  if (x <= std::numeric_limits<R>::max()) {
    static_cast<void>(frexp(x, &exponent));
  }
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
  if (surely_any(is_zero(q))) {
    raise(invalid_input(std::string("duet: ") + function + ": the quaternion is zero"));
  }
}

/// f(near_one, e) for q = near_one · 2^e.
template <class F, class T>
[[nodiscard]] DUET_COLD DUET_OUT_OF_LINE auto of_scaled(F f, const quaternion<T>& q) {
  const int e = binary_exponent(largest_component(innermost_of(q)));
  return f(scaled_down(q, e), e);
}

/// usual() for q in range; otherwise, lane by lane, extreme(near_one, e) with q = near_one · 2^e.
template <class Condition, class T, class F, class G>
[[nodiscard]] DUET_ALWAYS_INLINE auto by_range(const Condition& is_in_range, const quaternion<T>& q,
                                               const F& usual, const G& extreme) {
  if constexpr (is_recording<real_type_t<T>>) { // recorded for numbers in range
    return usual();
  } else {
    return select(is_in_range, usual,
                  [&] { return by_lane([&](const auto& p) { return of_scaled(extreme, p); }, q); });
  }
}

} // namespace detail

/// N3: the norm |q|. Zero for the zero quaternion, where it has no derivative.
template <class T>
[[nodiscard]] T norm(const quaternion<T>& q) {
  using std::ldexp;
  using std::sqrt;
  const T square = squared_norm(q);
  return detail::by_range(
      detail::is_moderate(innermost(square)), q,
      [&]() DUET_INLINE_LAMBDA { return T(sqrt(square)); },
      []<class P>(const quaternion<P>& near_one, int e) {
        return P(ldexp(P(sqrt(squared_norm(near_one))), e));
      });
}

/// Quaternion of unit norm q/|q|.
///
/// \throws invalid_input for the zero quaternion
template <class T>
[[nodiscard]] quaternion<T> normalized(const quaternion<T>& q) {
  using std::sqrt;
  const T square = squared_norm(q);
  return detail::by_range(
      detail::is_moderate(innermost(square)), q,
      [&]() DUET_INLINE_LAMBDA { return q / T(sqrt(square)); },
      []<class P>(const quaternion<P>& near_one, int) {
        detail::require_not_zero(near_one, "normalized");
        return near_one / P(sqrt(squared_norm(near_one)));
      });
}

/// N3: the inverse q⁻¹ = q*/|q|²; for a unit quaternion use `conj`.
///
/// \throws invalid_input for the zero quaternion
template <class T>
[[nodiscard]] quaternion<T> inverse(const quaternion<T>& q) {
  const T square = squared_norm(q);
  return detail::by_range(
      detail::is_moderate(innermost(square)), q,
      [&]() DUET_INLINE_LAMBDA { return conj(q) / square; },
      [](const auto& near_one, int e) {
        detail::require_not_zero(near_one, "inverse");
        return detail::scaled_down(conj(near_one) / squared_norm(near_one), e);
      });
}

DUET_REFUSES_FOREIGN(norm, double)
DUET_REFUSES_FOREIGN(normalized, quaternion<double>)
DUET_REFUSES_FOREIGN(inverse, quaternion<double>)

} // namespace duet
