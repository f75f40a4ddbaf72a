// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "kinematics/arms.hpp"
#include "robotics/limits.hpp"
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
      if (!is_within_limits(chain, theta, 1e-15)) {
        return std::numeric_limits<double>::infinity();
      }
      const auto d = duet::pose_error_between(chain.pose(theta),
                                              path((1 - x) * plan.tau[k - 1] + x * plan.tau[k]));
      result = std::max({result, d.translation, d.rotation});
    }
  }
  return result;
}

/// The largest deviation of a plan from the screw to a goal.
template <class Chain, class Plan>
double deviation_from_screw(const Chain& chain, const Plan& plan,
                            const duet::dual_quaternion<double>& goal) {
  return largest_deviation(chain, plan,
                           [&](double tau) { return sclerp(plan.poses[0], goal, tau); });
}

/// Checks that a plan keeps to the screw, the limits and the margin, also between waypoints.
template <class Chain, class Plan>
void check_clear_screw(const Chain& arm, const Plan& plan,
                       const duet::dual_quaternion<double>& goal, const duet::scene& around) {
  for (std::size_t k = 1; k < plan.joints.size(); ++k) {
    for (int part = 1; part <= 2; ++part) {
      const double x = part / 2.0;
      const auto theta = ((1 - x) * plan.joints[k - 1] + x * plan.joints[k]).eval();
      CHECK(is_within_limits(arm, theta));
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
