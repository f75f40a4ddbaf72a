// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/owning_result.hpp>
#include <duet/core/scalar_traits.hpp>

#include <cmath>
#include <concepts>
#include <limits>
#include <type_traits>

/// \file
/// Branches on values: `select`, the only form used in the library, and comparisons that tolerate
/// NaN and round-off.

namespace duet {

/// The conditional `condition ? f() : g()`, with both results converted to their common type.
///
/// A scalar evaluates one callable; a batch of lanes evaluates both and blends, so `f` and `g` must
/// be safe to evaluate for either value of the condition.
template <std::same_as<bool> Condition, std::invocable F, std::invocable G>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto select(Condition condition, F&& f, G&& g) {
  using result = std::common_type_t<std::invoke_result_t<F>, std::invoke_result_t<G>>;
  detail::require_owning_result<result>();
  if (condition) {
    return static_cast<result>(f());
  }
  return static_cast<result>(g());
}

namespace detail {

/// a < b, without a floating-point exception if one is a quiet NaN. (For batches the target's.)
template <class A, class B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto quiet_less(const A& a, const B& b) {
  if constexpr (std::floating_point<A> && std::floating_point<B>) {
    return std::is_constant_evaluated() ? a < b : std::isless(a, b);
  } else {
    return a < b;
  }
}
/// a ≤ b likewise.
template <class A, class B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto quiet_less_equal(const A& a, const B& b) {
  if constexpr (std::floating_point<A> && std::floating_point<B>) {
    return std::is_constant_evaluated() ? a <= b : std::islessequal(a, b);
  } else {
    return a <= b;
  }
}

} // namespace detail

/// True if the condition holds in any lane, here the only one.
[[nodiscard]] constexpr bool any(std::same_as<bool> auto x) { return x; }
/// True if the condition holds in all lanes, here the only one.
[[nodiscard]] constexpr bool all(std::same_as<bool> auto x) { return x; }

namespace detail {

/// True if the condition is known to hold in any lane: for checks of arguments, which are left out
/// where numbers are recorded.
template <class Condition>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr bool surely_any(const Condition& x) {
  if constexpr (requires { x.is_known(); }) {
    return x.is_known() && bool(x);
  } else {
    return any(x);
  }
}

} // namespace detail
} // namespace duet

namespace duet::detail {

/// max(a, b); NaN if either is NaN, which `std::max` may ignore.
template <Real R>
[[nodiscard]] R larger_or_nan(const R& a, const R& b) {
  return b <= a || a != a ? a : b;
}

/// u, or the end of [low, high] that it exceeds by at most 8 ulp of the end of larger magnitude.
template <Real R>
[[nodiscard]] DUET_COLD R clamp_rounding(const R& u, const R& low, const R& high) {
  using std::frexp;
  using std::ldexp;
  const R size = -low < high ? high : R(-low);
  if (!(size > 0)) {
    return u; // low = high = 0
  }
  int exponent = 0;
  static_cast<void>(frexp(size, &exponent));
  const R rounding = 8 * R(ldexp(std::numeric_limits<R>::epsilon(), exponent - 1));
  if (u < low && low - u <= rounding) {
    return low;
  }
  return u > high && u - high <= rounding ? high : u;
}

} // namespace duet::detail
