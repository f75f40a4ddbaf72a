// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>

#include <concepts>
#include <limits>
#include <type_traits>

/// \file
/// The chain rule, with zeros that survive infinite slopes.
///
/// An exactly zero partial means "does not depend on". Multiplied by the infinite or undefined
/// slope of √, log, pow or a division at a singular point it must stay zero, or constants would
/// poison gradients with NaN.

namespace duet::detail {

/// Is `x`, with every infinitesimal part, an exact zero?
template <class T>
[[nodiscard]] constexpr bool is_structural_zero(const T& x) {
  if constexpr (Infinitesimal<T>) {
    return x.all_of([](const auto& part) { return is_structural_zero(part); });
  } else {
    return x == T(0);
  }
}

/// Are `x` and all its infinitesimal parts finite? (x − x is NaN for infinities and NaN.)
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr bool is_all_finite(const T& x) {
  if constexpr (Infinitesimal<T>) {
    return x.all_of([](const auto& part) { return is_all_finite(part); });
  } else {
    return x - x == T(0);
  }
}

/// slope · partial, zero where the partial is a structural zero; for nested scalars part by part,
/// or what does not depend on the inner variable would be poisoned by it.
template <class T>
[[nodiscard]] constexpr T guarded_product(const T& slope, const T& partial) {
  if (is_structural_zero(partial)) {
    return T(0);
  }
  if constexpr (!Infinitesimal<T>) {
    return slope * partial;
  } else if constexpr (requires { slope.partials(); }) {
    using part = typename T::value_type;
    return T(guarded_product(slope.value(), partial.value()),
             T::partials_type::map_elements(
                 [&](const part& s, const part& p) {
                   return part(guarded_product(slope.value(), p) +
                               guarded_product(s, partial.value()));
                 },
                 slope.partials(), partial.partials()));
  } else {
    T result;
    constexpr int highest = scalar_traits<T>::order - scalar_traits<typename T::value_type>::order;
    for (int k = 0; k <= highest; ++k) {
      auto sum = guarded_product(slope.value(), partial.coefficient(k));
      for (int j = 1; j <= k; ++j) {
        sum = sum + guarded_product(slope.coefficient(j), partial.coefficient(k - j));
      }
      result.set_coefficient(k, sum);
    }
    return result;
  }
}

/// The same for a built-in number or a packet of them. Without a branch: what stays in one block is
/// merged and scheduled better.
template <class P, class T>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr P masked_product(const T& slope, const P& partial) {
  if constexpr (std::same_as<P, T>) {
    return partial == T(0) ? T(0) : T(slope * partial);
  } else {
    return partial != T(0) ? partial * slope : P{};
  }
}

/// Longer rows are masked only where the slope turns out not to be finite. clang does better
/// without that branch.
#ifdef __clang__
inline constexpr int mask_limit = std::numeric_limits<int>::max();
#else
inline constexpr int mask_limit = 4;
#endif

template <class Partials, class T>
[[nodiscard]] consteval bool is_always_masked() {
  if constexpr (requires { Partials::packet_count; }) {
    return Partials::packet_count <= mask_limit;
  } else {
    return std::floating_point<T>;
  }
}

/// slope · row, element by element. Out of line and by value: were the row passed by reference, it
/// would live in memory also where the slope is finite.
template <class Partials, class T>
[[nodiscard, gnu::noinline, gnu::cold]] constexpr Partials guarded_chain(T slope, Partials row) {
  return Partials::map_elements([&](const T& p) { return guarded_product(slope, p); }, row);
}

/// slope_a · a + slope_b · b, in the same way.
template <class Partials, class T>
[[nodiscard, gnu::noinline, gnu::cold]] constexpr Partials guarded_chain(T slope_a, Partials a,
                                                                         T slope_b, Partials b) {
  return Partials::map_elements(
      [&](const T& p, const T& q) {
        return T(guarded_product(slope_a, p) + guarded_product(slope_b, q));
      },
      a, b);
}

/// slope · row
template <class Partials, class T>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr Partials chain(const T& slope, const Partials& row) {
  if constexpr (is_always_masked<Partials, T>()) {
    return Partials::map([&](const auto& p) DUET_INLINE_LAMBDA { return masked_product(slope, p); },
                         row);
  } else {
    if (is_all_finite(slope)) [[likely]] {
      return Partials::map([&](const auto& p) DUET_INLINE_LAMBDA { return p * slope; }, row);
    }
    return guarded_chain(slope, row);
  }
}

/// slope_a · a + slope_b · b
template <class Partials, class T>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr Partials chain(const T& slope_a, const Partials& a,
                                                          const T& slope_b, const Partials& b) {
  if constexpr (is_always_masked<Partials, T>()) {
    return Partials::map(
        [&](const auto& p, const auto& q) DUET_INLINE_LAMBDA {
          return std::remove_cvref_t<decltype(p)>(masked_product(slope_a, p) +
                                                  masked_product(slope_b, q));
        },
        a, b);
  } else {
    if (is_all_finite(slope_a) && is_all_finite(slope_b)) [[likely]] {
      return Partials::map([&](const auto& p, const auto& q)
                               DUET_INLINE_LAMBDA { return p * slope_a + q * slope_b; },
                           a, b);
    }
    return guarded_chain(slope_a, a, slope_b, b);
  }
}

} // namespace duet::detail
