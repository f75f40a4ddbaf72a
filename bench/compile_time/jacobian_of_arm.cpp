// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// The geometric Jacobian of a robot.

#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/robots.hpp>

Eigen::Matrix<double, 6, 7> twists(const Eigen::Matrix<double, 7, 1>& theta) {
  return jacobian(duet::robots::panda(), theta, duet::frame::hybrid);
}
