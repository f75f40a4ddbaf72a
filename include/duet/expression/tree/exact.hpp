// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/types.hpp>

#include <cstdint>

/// \file
/// Numbers known at compile time: their bits, and whether their sums and products are exact.

namespace duet::expression::detail {

/// True if a + b is exact in double precision (two-sum, Knuth).
[[nodiscard]] constexpr bool is_sum_exact(double a, double b) {
  const double sum = a + b;
  const double b_rounded = sum - a;
  return (a - (sum - b_rounded)) + (b - b_rounded) == 0;
}

/// True if a b is exact in double precision (Veltkamp–Dekker product).
[[nodiscard]] constexpr bool is_product_exact(double a, double b) {
  const auto upper = [](double x) {
    const double scaled = x * 0x8000001p0;
    return scaled - (scaled - x);
  };
  const double a_high = upper(a), b_high = upper(b);
  const double a_low = a - a_high, b_low = b - b_high;
  return ((a_high * b_high - a * b) + a_high * b_low + a_low * b_high) + a_low * b_low == 0;
}

[[nodiscard]] constexpr std::uint64_t bits_of(double x) {
  return duet::detail::bit_cast<std::uint64_t>(x == 0 ? 0.0 : x);
}

} // namespace duet::expression::detail
