// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/tree/exact.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>

/// \file
/// Numbers known at compile time: `c<2>`, `0.5_c`. Unlike 2 or 0.5, they are part of the type of a
/// formula: they are simplified, and equal ones are the same node.

namespace duet::expression {

namespace detail {

/// True if x^n by products is within 4 units in the last place.
[[nodiscard]] constexpr bool is_accurate_by_products(int n) { return -4 <= n && n <= 5; }

/// x^N by products. Reciprocals take two steps, as x^−N may be out of range where x^N is not.
template <int N, class X>
[[nodiscard]] constexpr X power_by_products(const X& x) {
  if constexpr (N == 0) {
    return X(1);
  } else if constexpr (N == 1) {
    return x;
  } else if constexpr (N == -1) {
    return X(1 / x);
  } else if constexpr (N < 0) {
    return X(1 / power_by_products<-N / 2>(x) / power_by_products<(1 - N) / 2>(x));
  } else {
    const X root = power_by_products<N / 2>(x);
    if constexpr (N % 2 == 0) {
      return X(root * root);
    } else {
      return X(root * root * x);
    }
  }
}
/// x^n for an n of `is_accurate_by_products`.
template <int N = -4, class X>
[[nodiscard]] X power_by_products(const X& x, int n) {
  if constexpr (is_accurate_by_products(N + 1)) {
    return n == N ? power_by_products<N>(x) : power_by_products<N + 1>(x, n);
  } else {
    return power_by_products<N>(x);
  }
}

} // namespace detail

/// The integer N as a node.
template <int N>
inline constexpr number_node<detail::bits_of(N)> whole{};

/// The integer N as a formula.
template <int N>
inline constexpr formula<number_node<detail::bits_of(N)>, held<>> c{};

namespace detail {

/// Value of a decimal literal; -1 if it has too many digits or too large an exponent.
template <char... Letters>
[[nodiscard]] constexpr double number_spelt() {
  constexpr char text[] = {Letters..., '\0'};
  static_assert(!(text[0] == '0' && (text[1] == 'x' || text[1] == 'b')),
                "duet: a number with the suffix _c is decimal");
  double digits = 0;
  int exponent = 0;
  bool is_fraction = false;
  int i = 0;
  for (; text[i] != '\0' && text[i] != 'e' && text[i] != 'E'; ++i) {
    if (text[i] == '.') {
      is_fraction = true;
    } else if (text[i] != '\'') {
      digits = 10 * digits + (text[i] - '0');
      exponent -= is_fraction;
    }
  }
  if (text[i] != '\0') {
    const bool is_negative = text[++i] == '-';
    i += text[i] == '-' || text[i] == '+';
    int power = 0;
    for (; text[i] != '\0'; ++i) {
      power = 10 * power + (text[i] - '0');
    }
    exponent += is_negative ? -power : power;
  }
  double scale = 1;
  for (int k = 0; k < (exponent < 0 ? -exponent : exponent); ++k) {
    scale *= 10;
  }
  // Correctly rounded if both are exact, hence equal to the compiler's value of the literal.
  return digits <= 0x1p53 && scale <= 1e22 ? (exponent < 0 ? digits / scale : digits * scale) : -1;
}

} // namespace detail

inline namespace literals {

/// `0.5_c`: the decimal literal, of at most 15 digits and with a decimal exponent of at most 22.
template <char... Letters>
[[nodiscard]] constexpr auto operator""_c() {
  constexpr double value = detail::number_spelt<Letters...>();
  static_assert(value >= 0, "duet: a number with the suffix _c has at most 15 digits");
  return formula<number_node<detail::bits_of(value)>, held<>>{};
}

} // namespace literals

} // namespace duet::expression
