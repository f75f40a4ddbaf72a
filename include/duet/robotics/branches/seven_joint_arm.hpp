// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/robotics/branches/chain_loop.hpp>
#include <duet/robotics/branches/loop_equation.hpp>
#include <duet/robotics/planning_model.hpp>

#include <Eigen/Core>

#include <array>
#include <functional>
#include <vector>

/// \file
/// Redundant arm of seven joints of any type with a goal, and components of its self-motion.

namespace duet::detail {

using seven_coordinates = Eigen::Matrix<double, 7, 1>;
using seven_columns = Eigen::Matrix<double, 6, 7>;

/// Arm of seven joints, and the goal of its tip (end effector).
struct redundant_arm {
  std::array<bool, 7> is_revolute{};
  double size = 1; ///< characteristic length of the arm
  tip_pose goal{};
  /// Pose error of the tip, and the Jacobian; lengths relative to the arm's size.
  std::function<six_coordinates(const seven_coordinates&, seven_columns&)> tip_error;
  /// Axes of the other joints, with one fixed at a coordinate.
  std::function<chain_screws(int, double)> axes_without;
};

/// Consecutive points of a curve, or a sample of a component of another dimension.
struct traced_curve {
  std::vector<seven_coordinates> points;
  bool is_closed = false;
  int dimension = 1;
  int kernel = 1; ///< dimension of the Jacobian's null space at almost all points
};

} // namespace duet::detail
