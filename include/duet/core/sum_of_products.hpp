// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>

#include <cmath>
#include <concepts>
#include <limits>

/// \file
/// Sums of two products that keep their digits where the products cancel.

namespace duet::detail {

/// a b + c d to two units in the last place of itself, where nothing overflows or underflows.
template <Real R>
[[nodiscard]] R sum_of_products(const R& a, const R& b, const R& c, const R& d) {
  if constexpr (std::floating_point<R>) { // Kahan's
    const R cd = c * d;
    const R error = std::fma(c, d, -cd);
    return std::fma(a, b, cd) + error;
  } else { // Dekker's: Boost.Multiprecision's fma rounds twice
    const auto upper_half = [](const R& x) {
      const R raised = ldexp(x, (std::numeric_limits<R>::digits + 1) / 2) + x;
      return R(raised - R(raised - x));
    };
    const auto error_of = [&](const R& p, const R& q, const R& pq) {
      const R p1 = upper_half(p), q1 = upper_half(q);
      const R p2 = p - p1, q2 = q - q1;
      return R(R(R(R(p1 * q1 - pq) + p1 * q2) + p2 * q1) + p2 * q2);
    };
    const R ab = a * b, cd = c * d;
    return R(R(ab + cd) + error_of(a, b, ab)) + error_of(c, d, cd);
  }
}

} // namespace duet::detail
