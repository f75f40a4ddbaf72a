// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: find_start_configuration takes no start
// within: 3

#include <duet/kinematics/robots.hpp>
#include <duet/robotics/choose_start.hpp>

#include <iostream>

int main() {
  const auto arm = duet::robots::panda();
  const auto path = [](double u) {
    return duet::pose(duet::quaternion<double>(1), duet::vector3<double>(u, 0, 0.5));
  };
#ifdef DUET_MUST_FAIL
  const Eigen::Matrix<double, 7, 1> start = Eigen::Matrix<double, 7, 1>::Zero();
  std::cout << find_start_configuration(arm, start, path, 0.5, 1).starts << "\n";
#else
  std::cout << find_start_configuration(arm, path, 0.5, 1).starts << "\n";
#endif
}
