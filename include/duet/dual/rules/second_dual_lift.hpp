// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/dual/dual.hpp>

#include <array>
#include <cstddef>
#include <utility>

/// \file
/// From the rule of a function to the function over numbers with second derivatives, which are
/// those of the rule's slopes, by dual numbers.

namespace duet {
namespace detail {

/// Marks the ε by which slopes are differentiated.
struct curvature_tag {};

/// X is a `second_dual`.
template <class Rule, class X, class... Rest>
[[nodiscard]] DUET_ALWAYS_INLINE X lift_by_slopes(const Rule& rule, const X& x,
                                                  const Rest&... rest) {
  using T = typename X::value_type;
  constexpr std::size_t count = 1 + sizeof...(rest);
  using D = dual<T, int(count), curvature_tag>;
  if constexpr (count == 1) {
    const T y = rule.value(x.value());
    const T slope = rule.slope(x.value(), y);
    const D moving_slope = rule.slope(D::variable(x.value()), D(y, slope));
    return x.composed(y, slope, moving_slope.epsilon());
  } else {
    const T value = rule.value(x.value(), rest.value()...);
    const std::array<T, count> slopes = rule.slopes(value, x.value(), rest.value()...);
    const std::array<const X*, count> arguments = {&x, &rest...};
    D moving_value(value);
    std::array<D, count> moving;
    for (std::size_t a = 0; a < count; ++a) {
      moving_value.set_partial(int(a), slopes[a]);
      moving[a] = D::variable(arguments[a]->value(), int(a));
    }
    const auto moving_slopes = [&]<std::size_t... I>(std::index_sequence<I...>) {
      return rule.slopes(moving_value, moving[I]...);
    }
    (std::make_index_sequence<count>{});
    std::array<std::array<T, count>, count> curvatures;
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = 0; b < count; ++b) {
        curvatures[a][b] = moving_slopes[a].partial(int(b));
      }
    }
    return X::template composed<count>(value, arguments, slopes, curvatures);
  }
}

} // namespace detail
} // namespace duet
