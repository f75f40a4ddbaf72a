// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: (a position as|the goal is a rotation|from which joints|choose_start finds)
// within: 3
// forms: 4

#include <duet/mechanism/robots.hpp>
#include <duet/planning/choose_start.hpp>
#include <duet/planning/goals.hpp>

#include <iostream>

int main() {
  const auto arm = duet::robots::panda();
  const Eigen::Matrix<double, 7, 1> start = Eigen::Matrix<double, 7, 1>::Zero();
  const duet::vector3<double> position(0.5, 0, 0.5);
  const auto path = [&](double u) {
    return duet::pose(duet::quaternion<double>(1), duet::vector3<double>(u * position));
  };
#if DUET_MUST_FAIL == 1
  std::cout << inverse_kinematics(arm, position, start).joints << "\n";
#elif DUET_MUST_FAIL == 2
  const auto found = inverse_kinematics(arm, duet::quaternion<double>(1), start);
#elif DUET_MUST_FAIL == 3
  std::cout << inverse_kinematics(arm, duet::position_goal(position)).joints << "\n";
#elif DUET_MUST_FAIL == 4
  std::cout << choose_start(arm, start, path, 0.5, 1).starts << "\n";
#else
  // Not evaluated: compilers take long for all that a start is chosen by.
  using found = decltype(inverse_kinematics(arm, duet::position_goal(position), start));
  using chosen = decltype(choose_start(arm, path, 0.5, 1));
  std::cout << sizeof(found) << sizeof(chosen) << "\n";
#endif
}
