// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/own_numbers.hpp>

#include <cmath>
#include <concepts>
#include <type_traits>

/// \file
/// Branches on values: `select`, the only form used in the library.

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

} // namespace duet
