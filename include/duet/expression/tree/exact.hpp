// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/types.hpp>

#include <cstdint>

/// \file
/// Numbers known at compile time: their bits, and whether their sums, products and quotients are
/// exact.

namespace duet::expression::detail {

/// True if a + b is exact in double precision (two-sum, Knuth).
[[nodiscard]] constexpr bool is_sum_exact(double a, double b) {
  const double sum = a + b;
  const double b_rounded = sum - a;
  return (a - (sum - b_rounded)) + (b - b_rounded) == 0;
}

/// True if a b is exact in double precision (Veltkamp–Dekker product). False for products below
/// 2⁻⁹⁶⁰, whose error may underflow.
[[nodiscard]] constexpr bool is_product_exact(double a, double b) {
  if (a * b < 0x1p-960 && a * b > -0x1p-960) {
    return a == 0 || b == 0;
  }
  const auto upper = [](double x) {
    const double scaled = x * 0x8000001p0;
    return scaled - (scaled - x);
  };
  const double a_high = upper(a), b_high = upper(b);
  const double a_low = a - a_high, b_low = b - b_high;
  return ((a_high * b_high - a * b) + a_high * b_low + a_low * b_high) + a_low * b_low == 0;
}

/// True if a/b is exact in double precision.
[[nodiscard]] constexpr bool is_quotient_exact(double a, double b) {
  const double ratio = b == 0 ? 0 : a / b;
  return b != 0 && ratio * b == a && is_product_exact(ratio, b);
}

[[nodiscard]] constexpr std::uint64_t bits_of(double x) {
  return duet::detail::bit_cast<std::uint64_t>(x == 0 ? 0.0 : x);
}

} // namespace duet::expression::detail
