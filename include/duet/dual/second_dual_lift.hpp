// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/rules.hpp>
#include <duet/dual/second_dual.hpp>
#include <duet/dual/sine_cosine.hpp>

#include <array>
#include <cstddef>
#include <utility>

/// \file
/// From the rule of a function to the function over numbers with second derivatives. The second
/// derivative is that of the rule's slope, by dual numbers.

namespace duet::detail {

/// Marks the ε by which slopes are differentiated.
struct curvature_tag {};

template <class Rule, class T, int N, class Tag>
[[nodiscard]] DUET_ALWAYS_INLINE second_dual<T, N, Tag> lift(const Rule& rule,
                                                             const second_dual<T, N, Tag>& x) {
  using D = dual<T, 1, curvature_tag>;
  const T y = rule.value(x.value());
  const T slope = rule.slope(x.value(), y);
  const D moving_slope = rule.slope(D::variable(x.value()), D(y, slope));
  return x.composed(y, slope, moving_slope.epsilon());
}

/// From sine and cosine of the value to those of x.
template <class T, int N, class Tag>
[[nodiscard]] DUET_ALWAYS_INLINE sine_cosine<second_dual<T, N, Tag>>
lift(const sine_cosine<T>& y, const second_dual<T, N, Tag>& x) {
  const T minus_sine(-y.sine);
  return {x.composed(y.sine, y.cosine, minus_sine), x.composed(y.cosine, minus_sine, T(-y.cosine))};
}

template <class T, int N, class Tag>
[[nodiscard]] DUET_ALWAYS_INLINE second_dual<T, N, Tag> lift(const rule::sin&,
                                                             const second_dual<T, N, Tag>& x) {
  return lift(sine_and_cosine_of(x.value()), x).sine;
}
template <class T, int N, class Tag>
[[nodiscard]] DUET_ALWAYS_INLINE second_dual<T, N, Tag> lift(const rule::cos&,
                                                             const second_dual<T, N, Tag>& x) {
  return lift(sine_and_cosine_of(x.value()), x).cosine;
}

template <class Rule, class T, int N, class Tag, class... Rest>
[[nodiscard]] second_dual<T, N, Tag> lift(const Rule& rule, const second_dual<T, N, Tag>& x,
                                          const second_dual<T, N, Tag>& y, const Rest&... rest) {
  constexpr std::size_t count = 2 + sizeof...(rest);
  using D = dual<T, int(count), curvature_tag>;
  const T value = rule.value(x.value(), y.value(), rest.value()...);
  const std::array<T, count> slopes = rule.slopes(value, x.value(), y.value(), rest.value()...);
  const std::array<const second_dual<T, N, Tag>*, count> arguments = {&x, &y, &rest...};
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
  return second_dual<T, N, Tag>::template composed<count>(value, arguments, slopes, curvatures);
}

} // namespace duet::detail
