// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/dual/rules/lift.hpp>
#include <duet/dual/storage/partials.hpp>
#include <duet/dual/storage/structural_zero.hpp>

#include <array>
#include <concepts>
#include <cstddef>

/// \file
/// Lifts the rule of a function to the function over Taylor numbers.
///
/// For y = f(x) the chain rule y′ = f′(x) x′ gives, coefficient by coefficient,
/// k y_k = Σ_{j=1…k} j x_j s_{k−j}, where s is the series of the slope f′(x). The slope is needed
/// to order K−1 only, so the rule is applied to shorter and shorter series.

namespace duet {
DUET_ABI_BEGIN
template <class T, int K, class Tag>
class taylor;
DUET_ABI_END

namespace detail {

/// x with the powers above L dropped; a plain value for L = 0.
template <int L, class T, int K, class Tag>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto truncated(const taylor<T, K, Tag>& x) {
  if constexpr (L == 0) {
    return x.value();
  } else if constexpr (L == K) {
    return x;
  } else {
    taylor<T, L, Tag> result;
    unrolled<L + 1>([&](int k) DUET_INLINE_LAMBDA { result.set_coefficient(k, x.coefficient(k)); });
    return result;
  }
}

/// The k-th coefficient of a series, or of a plain value.
template <class T, class S>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr const T& coefficient_of(const S& s,
                                                                   [[maybe_unused]] int k) {
  if constexpr (std::same_as<T, S>) {
    return s;
  } else {
    return s.coefficient(k);
  }
}

/// x / k. For built-in reals 1/k is a constant, accurate to half a unit in the last place: a
/// division would be the slowest link in the chain of coefficients.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr T divided_by_order(const T& x, int k) {
  if constexpr (std::floating_point<T>) {
    return x * (T(1) / T(k));
  } else {
    return x / integer<T>(k);
  }
}

/// Σ_{j=1…K} j x_j s_{K−j}, zero coefficients of x not touching infinite slopes.
template <class T, int K, class Tag, class S>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr T chain_coefficient(const taylor<T, K, Tag>& x,
                                                               const S& slope) {
  T probe = coefficient_of<T>(slope, 0);
  unrolled<K - 1>([&](int i)
                      DUET_INLINE_LAMBDA { probe = probe + coefficient_of<T>(slope, i + 1); });
  return with_surviving_products(probe, [&](const auto& product) DUET_INLINE_LAMBDA {
    T sum(0);
    unrolled<K>([&](int i) DUET_INLINE_LAMBDA {
      const int j = i + 1;
      const T term = product(coefficient_of<T>(slope, K - j), x.coefficient(j));
      sum = j == 1 ? T(sum + term) : T(sum + term * integer<T>(j));
    });
    return sum;
  });
}

/// `shorter`, the series to order K−1, extended by the coefficient of ε^K.
template <class D, class S, class T>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr D extended(const S& shorter, const T& last, int order) {
  D result;
  unrolled<scalar_traits<D>::order - scalar_traits<T>::order>(
      [&](int k) DUET_INLINE_LAMBDA { result.set_coefficient(k, coefficient_of<T>(shorter, k)); });
  result.set_coefficient(order, last);
  return result;
}

template <class Rule, class T, int K, class Tag>
[[nodiscard]] DUET_ALWAYS_INLINE taylor<T, K, Tag> lift_in_place(const Rule& rule,
                                                                 const taylor<T, K, Tag>& x) {
  const auto shorter_x = truncated<K - 1>(x);
  if constexpr (K == 1) {
    const T y = rule.value(shorter_x);
    return extended<taylor<T, K, Tag>>(y, chain_coefficient(x, rule.slope(shorter_x, y)), K);
  } else {
    const auto y = lift(rule, shorter_x);
    const T last = divided_by_order(chain_coefficient(x, rule.slope(shorter_x, y)), K);
    return extended<taylor<T, K, Tag>>(y, last, K);
  }
}

/// Variant that the compiler may call instead of inlining it.
template <class Rule, class T, int K, class Tag>
[[nodiscard]] inline taylor<T, K, Tag> lift_by_call(const Rule& rule, const taylor<T, K, Tag>& x) {
  return lift_in_place(rule, x);
}

/// Maximum order for inlining over built-in numbers: there a call, with all coefficients through
/// memory, costs more than its computation.
inline constexpr int in_place_order = 3;

/// The further coefficients of s and c, s′ = c x′ and c′ = Sign s x′.
template <int Sign, class T, int K, class Tag>
inline void extend_pair(const taylor<T, K, Tag>& x, taylor<T, K, Tag>& s, taylor<T, K, Tag>& c) {
  with_surviving_products(T(s.value() + c.value()), [&](const auto& product) DUET_INLINE_LAMBDA {
    unrolled<K>([&](int i) DUET_INLINE_LAMBDA {
      const int k = i + 1;
      T ds(0);
      T dc(0);
      unrolled<K>([&](int m) DUET_INLINE_LAMBDA {
        const int j = m + 1;
        if (j <= k) {
          const T jx = x.coefficient(j) * integer<T>(j);
          ds = ds + product(c.coefficient(k - j), jx);
          dc = dc + product(s.coefficient(k - j), jx);
        }
      });
      s.set_coefficient(k, divided_by_order(ds, k));
      c.set_coefficient(k, divided_by_order(T(dc * integer<T>(Sign)), k));
    });
  });
}

/// Variant for several arguments.
template <class Rule, class T, int K, class Tag, class... Rest>
[[nodiscard]] inline taylor<T, K, Tag> lift_by_call(const Rule& rule, const taylor<T, K, Tag>& x,
                                                    const taylor<T, K, Tag>& y,
                                                    const Rest&... rest) {
  const auto z = [&] {
    if constexpr (K == 1) {
      return rule.value(x.value(), y.value(), rest.value()...);
    } else {
      return lift(rule, truncated<K - 1>(x), truncated<K - 1>(y), truncated<K - 1>(rest)...);
    }
  }();
  const auto slopes =
      rule.slopes(z, truncated<K - 1>(x), truncated<K - 1>(y), truncated<K - 1>(rest)...);
  T last = chain_coefficient(x, slopes[0]) + chain_coefficient(y, slopes[1]);
  if constexpr (sizeof...(rest) > 0) {
    static_assert(sizeof...(rest) == 1);
    last = last + (chain_coefficient(rest, slopes[2]) + ...);
  }
  return extended<taylor<T, K, Tag>>(z, divided_by_order(last, K), K);
}

} // namespace detail
} // namespace duet
