// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: a chain has three Jacobians, name the frame
// within: 5
// forms: 2

#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/robots.hpp>

#include <iostream>

void use() {
  const Eigen::Matrix<double, 6, 1> theta = Eigen::Matrix<double, 6, 1>::Zero();
#if DUET_MUST_FAIL == 1
  duet::jacobian(duet::robots::ur5e(), theta);
#elif DUET_MUST_FAIL == 2
  std::cout << duet::jacobian(duet::robots::ur5e(), theta) << "\n";
#else
  static_cast<void>(duet::jacobian(duet::robots::ur5e(), theta, duet::frame::hybrid));
#endif
}
