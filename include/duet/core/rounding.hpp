// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>

#include <cmath>
#include <limits>

/// \file
/// Comparisons that tolerate round-off and NaN.

namespace duet::detail {

/// max(a, b); NaN if either is NaN, which `std::max` may ignore.
template <Real R>
[[nodiscard]] R larger_or_nan(const R& a, const R& b) {
  return b <= a || a != a ? a : b;
}

/// u, or the end of [low, high] that it exceeds by at most 8 ulp of the end of larger magnitude.
template <Real R>
[[nodiscard]] DUET_COLD R clamp_rounding(const R& u, const R& low, const R& high) {
  using std::frexp;
  using std::ldexp;
  const R size = -low < high ? high : R(-low);
  if (!(size > 0)) {
    return u; // low = high = 0
  }
  int exponent = 0;
  static_cast<void>(frexp(size, &exponent));
  const R rounding = 8 * R(ldexp(std::numeric_limits<R>::epsilon(), exponent - 1));
  if (u < low && low - u <= rounding) {
    return low;
  }
  return u > high && u - high <= rounding ? high : u;
}

} // namespace duet::detail
