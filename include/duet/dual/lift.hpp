// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/dual.hpp>
#include <duet/dual/rules.hpp>
#include <duet/dual/sine_cosine.hpp>
#include <duet/dual/structural_zero.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <utility>

/// \file
/// From the rule of a function to the function over dual numbers: f(a + εb) = f(a) + ε f′(a) b.

namespace duet::detail {

template <class Rule, class T, int N, class Tag>
[[nodiscard]] DUET_ALWAYS_INLINE dual<T, N, Tag> lift(const Rule& rule, const dual<T, N, Tag>& x) {
  const T y = rule.value(x.value());
  return {y, chain(rule.slope(x.value(), y), x.partials())};
}

template <class Rule, class T, int N, class Tag, class... Rest>
[[nodiscard]] DUET_ALWAYS_INLINE dual<T, N, Tag>
lift(const Rule& rule, const dual<T, N, Tag>& x, const dual<T, N, Tag>& y, const Rest&... rest) {
  const T value = rule.value(x.value(), y.value(), rest.value()...);
  const auto slopes = rule.slopes(value, x.value(), y.value(), rest.value()...);
  auto result = chain(slopes[0], x.partials(), slopes[1], y.partials());
  if constexpr (sizeof...(rest) > 0) {
    static_assert(sizeof...(rest) == 1);
    result = dual<T, N, Tag>::partials_type::map([](const auto& p, const auto& q)
                                                     DUET_INLINE_LAMBDA { return p + q; },
                                                 result, chain(slopes[2], rest.partials()...));
  }
  return {value, result};
}

/// From sine and cosine of the value to those of x.
template <class T, int N, class Tag>
[[nodiscard]] DUET_ALWAYS_INLINE sine_cosine<dual<T, N, Tag>> lift(const sine_cosine<T>& y,
                                                                   const dual<T, N, Tag>& x) {
  if constexpr (std::floating_point<T>) {
    // Both are finite or neither. Asked of their sum, clang computes them at once.
    const bool is_finite = is_all_finite(T(y.sine + y.cosine));
    return {{y.sine, combined(chain_of_one<T>{y.cosine}, is_finite, x.partials())},
            {y.cosine, combined(chain_of_one<T>{-y.sine}, is_finite, x.partials())}};
  } else {
    return {{y.sine, chain(y.cosine, x.partials())}, {y.cosine, chain(T(-y.sine), x.partials())}};
  }
}

template <class T, int N, class Tag>
[[nodiscard]] DUET_ALWAYS_INLINE dual<T, N, Tag> lift(const rule::sin&, const dual<T, N, Tag>& x) {
  return lift(sine_and_cosine_of(x.value()), x).sine;
}
template <class T, int N, class Tag>
[[nodiscard]] DUET_ALWAYS_INLINE dual<T, N, Tag> lift(const rule::cos&, const dual<T, N, Tag>& x) {
  return lift(sine_and_cosine_of(x.value()), x).cosine;
}

} // namespace duet::detail
