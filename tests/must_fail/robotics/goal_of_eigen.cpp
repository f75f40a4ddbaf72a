// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: a rotation or pose of Eigen: from_eigen
// within: 5
// forms: 2

#include <duet/interop/eigen.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

#include <Eigen/Geometry>

#include <iostream>

int main() {
  const auto arm = duet::robots::panda();
  const Eigen::Matrix<double, 7, 1> start = Eigen::Matrix<double, 7, 1>::Zero();
  const Eigen::Isometry3d goal = Eigen::Isometry3d::Identity();
#if DUET_MUST_FAIL == 1
  const auto result = duet::inverse_kinematics(arm, goal, start);
#elif DUET_MUST_FAIL == 2
  std::cout << duet::inverse_kinematics(arm, goal, start).joints << "\n";
#else
  std::cout << duet::inverse_kinematics(arm, duet::from_eigen(goal), start).joints << "\n";
#endif
}
