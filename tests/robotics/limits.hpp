// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

/// \file
/// Joint limits in tests and benchmarks, which have no doctest.

namespace duet_test {

/// True if there is a coordinate for each joint, and all are within their limits to `slack`.
template <class Chain, class X>
[[nodiscard]] bool is_within_limits(const Chain& chain, const X& theta, double slack = 0) {
  bool is_inside = theta.size() == chain.size();
  for (int i = 0; i < chain.size(); ++i) {
    is_inside = is_inside && theta[i] >= chain.limits(i).lower - slack &&
                theta[i] <= chain.limits(i).upper + slack;
  }
  return is_inside;
}

} // namespace duet_test
