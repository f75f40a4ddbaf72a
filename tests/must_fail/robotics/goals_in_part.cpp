// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: (for a position as|the goal is a rotation|the start is missing)
// within: 3
// forms: 3

#include <duet/kinematics/robots.hpp>
#include <duet/robotics/goals.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

#include <iostream>

int main() {
  const auto arm = duet::robots::panda();
  const Eigen::Matrix<double, 7, 1> start = Eigen::Matrix<double, 7, 1>::Zero();
  const duet::vector3<double> position(0.5, 0, 0.5);
#if DUET_MUST_FAIL == 1
  std::cout << inverse_kinematics(arm, position, start).joints << "\n";
#elif DUET_MUST_FAIL == 2
  const auto result = inverse_kinematics(arm, duet::quaternion<double>(1), start);
#elif DUET_MUST_FAIL == 3
  std::cout << inverse_kinematics(arm, duet::position_goal(position)).joints << "\n";
#else
  std::cout << inverse_kinematics(arm, duet::position_goal(position), start).joints << "\n";
#endif
}
