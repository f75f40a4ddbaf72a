// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: FrameOnChain

#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/robots.hpp>

int main() {
  const auto arm = duet::robots::panda();
  const Eigen::Matrix<double, 7, 1> theta = Eigen::Matrix<double, 7, 1>::Zero();
#ifdef DUET_MUST_FAIL
  static_cast<void>(arm.pose(theta, 3, 4));                          // mistake
  static_cast<void>(arm.pose(theta, 3.5));                           // mistake
  static_cast<void>(jacobian(arm, theta, duet::frame::body, theta)); // mistake
#else
  static_cast<void>(arm.pose(theta, 3));
  static_cast<void>(jacobian(arm, theta, duet::frame::body, arm.tip()));
#endif
}
