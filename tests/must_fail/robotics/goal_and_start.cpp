// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: (the start is missing|the goal precedes the start|the goal is a rotation)
// within: 2
// forms: 3

#include <duet/kinematics/robots.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

#include <iostream>

int main() {
  const auto arm = duet::robots::panda();
  const Eigen::Matrix<double, 7, 1> start = Eigen::Matrix<double, 7, 1>::Zero();
  const duet::quaternion<double> q(1);
  const duet::dual_quaternion<double> goal = pose(q, duet::vector3<double>(0.5, 0, 0.5));
#if DUET_MUST_FAIL == 1
  std::cout << inverse_kinematics(arm, goal).joints << "\n";
#elif DUET_MUST_FAIL == 2
  const auto result = inverse_kinematics(arm, start, goal);
#elif DUET_MUST_FAIL == 3
  std::cout << inverse_kinematics(arm, q, start).joints << "\n";
#else
  std::cout << inverse_kinematics(arm, goal, start).joints << "\n";
#endif
}
