// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "kinematics/arms.hpp"
#include "support/test.hpp"

#include <duet/dual_quaternion/screw.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/robotics/clearance.hpp>

/// \file
/// Checks of plans that all tests share.

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
      const auto d = duet::pose_error_between(chain.pose(theta),
                                              path((1 - x) * plan.tau[k - 1] + x * plan.tau[k]));
      result = std::max({result, d.translation, d.rotation});
    }
  }
  return result;
}

/// Checks that a plan keeps to the screw, the limits and the margin, also between waypoints.
template <class Chain, class Plan>
void check_clear_screw(const Chain& arm, const Plan& plan,
                       const duet::dual_quaternion<double>& goal, const duet::scene& around) {
  for (std::size_t k = 1; k < plan.joints.size(); ++k) {
    for (int part = 1; part <= 2; ++part) {
      const double x = part / 2.0;
      const auto theta = ((1 - x) * plan.joints[k - 1] + x * plan.joints[k]).eval();
      for (int i = 0; i < arm.size(); ++i) {
        CHECK(theta[i] >= arm.limits(i).lower);
        CHECK(theta[i] <= arm.limits(i).upper);
      }
      const double tau = (1 - x) * plan.tau[k - 1] + x * plan.tau[k];
      const auto d = duet::pose_error_between(arm.pose(theta), sclerp(plan.poses[0], goal, tau));
      CHECK(d.translation < 1e-5);
      CHECK(d.rotation < 1e-5);
      CHECK(duet::clearance(arm, theta, around).distance >
            around.margin - (part == 2 ? 1e-6 : 1.1e-5));
    }
  }
  CHECK(plan.smallest_clearance >= around.margin - 1e-6);
}

} // namespace duet_test
