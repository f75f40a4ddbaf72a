// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/planning/branches/joint_loop.hpp>
#include <duet/planning/branches/orthonormalise.hpp>

#include <algorithm>
#include <cmath>

/// \file
/// Newton's method for loops of six joints, which the library duet::compiled holds.

namespace duet::detail {

#ifdef DUET_DEFINES_COMPILED
DUET_COMPILED_FUNCTION bool close_loop(const joint_loop& loop, six_coordinates& theta,
                                       double size_of_angles) {
  constexpr double rounding = 2e-15, good = 1e-13;
  double before = HUGE_VAL;
  for (int k = 0; k < 40; ++k) {
    const loop_gap gap(loop, theta);
    const double to_angle = gap.size / std::min(gap.size, size_of_angles);
    const double left = std::sqrt(gap.twist.head<3>().squaredNorm() +
                                  to_angle * to_angle * gap.twist.tail<3>().squaredNorm()) /
                        gap.size;
    if (left <= rounding || (left <= good && left >= before / 2)) {
      return true;
    }
    before = left;
    const six_coordinates step = least_solution(gap.jacobian, gap.twist);
    const double length = step.norm();
    if (!(length < 1e6)) {
      return false;
    }
    theta += std::min(1.0, .5 / length) * step;
  }
  return false;
}
#endif

} // namespace duet::detail
