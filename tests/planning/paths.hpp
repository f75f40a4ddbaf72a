// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "mechanism/arms.hpp"

#include <duet/planning/motion_plan.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

/// \file
/// What tests ask of every plan.

namespace duet_test {

/// The Panda with its gripper down.
inline coordinates<7> gripper_down() {
  const double quarter = 0.78539816339744831;
  coordinates<7> theta;
  theta << 0, -quarter, 0, -3 * quarter, 0, 2 * quarter, quarter;
  return theta;
}

/// The largest distance, in metres and radians, of the straight joint paths between waypoints from
/// a path at the same parameter; infinite outside the limits.
template <class Chain, class Plan, class Path>
double largest_deviation(const Chain& chain, const Plan& plan, const Path& path) {
  double result = 0;
  for (std::size_t k = 1; k < plan.joints.size(); ++k) {
    for (int part = 1; part <= 10; ++part) {
      const double x = part / 10.0;
      const auto theta = ((1 - x) * plan.joints[k - 1] + x * plan.joints[k]).eval();
      for (int i = 0; i < chain.size(); ++i) {
        const auto& limits = chain.limits(i);
        if (!(theta[i] >= limits.lower - 1e-15 && theta[i] <= limits.upper + 1e-15)) {
          return std::numeric_limits<double>::infinity();
        }
      }
      const auto d = duet::deviation_between(chain.pose(theta),
                                             path((1 - x) * plan.tau[k - 1] + x * plan.tau[k]));
      result = std::max({result, d.length, d.angle});
    }
  }
  return result;
}

} // namespace duet_test
