// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// The geometric Jacobian of a link of a robot that is read from a file.

#include <duet/io/urdf.hpp>
#include <duet/kinematics/tree_jacobian.hpp>

#include <string>

Eigen::MatrixXd twists(const std::string& path, const Eigen::VectorXd& q) {
  const auto robot = duet::read_urdf_tree(path);
  return jacobian(robot, q, duet::frame::hybrid, robot.link("hand"));
}
