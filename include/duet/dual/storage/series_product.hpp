// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/dual/storage/structural_zero.hpp>

#include <concepts>

/// \file
/// Sums of products of coefficients, where zeros survive infinite factors.

namespace duet::detail {

/// sum(product) with a product in which zeros on the right survive. Where the probe, a sum of all
/// factors on the left, is finite, plain products do; the processor guesses that and the products
/// need not wait for masks. clang makes less of the branch than of masks.
template <class T, class Sum>
DUET_ALWAYS_INLINE constexpr auto with_surviving_products([[maybe_unused]] const T& probe,
                                                          const Sum& sum) {
#ifndef __clang__
  if constexpr (std::floating_point<T>) {
    if (is_all_finite(probe)) [[likely]] {
      return sum([](const T& a, const T& b) DUET_INLINE_LAMBDA { return T(a * b); });
    }
  }
#endif
  return sum([](const T& a, const T& b) DUET_INLINE_LAMBDA { return surviving_product(a, b); });
}

} // namespace duet::detail
