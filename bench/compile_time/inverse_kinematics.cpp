// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Joints for a pose.

#include <duet/kinematics/robots.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

Eigen::Matrix<double, 7, 1> joints(const duet::dual_quaternion<double>& goal,
                                   const Eigen::Matrix<double, 7, 1>& start) {
  return duet::inverse_kinematics(duet::robots::panda(), goal, start).joints;
}
