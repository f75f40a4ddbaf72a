// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <bit>
#include <cstdint>

/// \file
/// Numbers compared to the last bit.

namespace duet_test {

/// The same bits, or both NaN.
[[nodiscard]] inline bool identical(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (a != a && b != b);
}

} // namespace duet_test
