// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>

/// \file
/// Maxima that do not lose NaN.

namespace duet::detail {

/// max(a, b); NaN where either is NaN, which `std::max` may pass over.
template <Real R>
[[nodiscard]] R larger_or_nan(const R& a, const R& b) {
  return b <= a || a != a ? a : b;
}

} // namespace duet::detail
