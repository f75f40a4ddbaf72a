// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "support/test.hpp"

#include <duet/duet.hpp>

/// \file
/// Motion to be interpolated, over any scalar.

namespace duet_test {

/// Smooth motion whose rotations do not commute, u in [0, 2].
template <class S>
[[nodiscard]] duet::quaternion<S> smooth_motion(const S& u) {
  using std::cos;
  using std::exp;
  using std::sin;
  return duet::from_euler<duet::zyx>(S(1.3 * sin(1.1 * u + 0.2)), S(0.9 * cos(1.7 * u)),
                                     S(0.8 * u * exp(-0.3 * u)));
}

} // namespace duet_test
