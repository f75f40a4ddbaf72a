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

/// May the compiler multiply and add in one step? Then the same sum of products rounds in one place
/// of a program otherwise than in another, and bits tell nothing.
#if defined(__FMA__) || defined(__FP_FAST_FMA) || defined(__aarch64__) || defined(__riscv) ||      \
    defined(__s390x__)
inline constexpr bool may_fuse = true;
#else
inline constexpr bool may_fuse = false;
#endif

/// A bound for results that are the same to the last bit where nothing is fused: 0 there.
[[nodiscard]] constexpr double if_fused(double bound) { return may_fuse ? bound : 0; }

} // namespace duet_test
