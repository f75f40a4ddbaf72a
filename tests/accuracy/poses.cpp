// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "accuracy/pose_functions.hpp"
#include "accuracy/probe.hpp"

// Dual quaternions: exponential, logarithm, powers, interpolation, screws, adjoints and Jacobians,
// with derivatives to the fourth order.

namespace duet_test::accuracy {

rows pose_rows(extent e) {
  rows result;
  for (const auto& f : pose_functions<line>()) {
    result.push_back(probe_lines(f, e == extent::test ? 4 : 32));
  }
  return result;
}

} // namespace duet_test::accuracy
