// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/robotics/branches/chain_loop.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

/// \file
/// Characteristic length and centre of a loop of six joints, used for scaling. Compiled into
/// duet::compiled.

namespace duet::detail {

#ifdef DUET_DEFINES_COMPILED
DUET_COMPILED_FUNCTION void chain_screws::normalise() {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const loop_joint& j : joints) {
    const Eigen::Vector3d n = j.axis, p = j.point;
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - n * n.transpose();
    squares += across;
    sum += across * p;
  }
  // If all axes are parallel `squares` is singular. It is therefore damped, and the solution is
  // refined as often as is needed to remove the effect of the damping otherwise. (Eigen's
  // decompositions take g++ two seconds to compile.)
  const Eigen::Matrix3d damped = (squares + 1e-6 * Eigen::Matrix3d::Identity()).inverse();
  Eigen::Vector3d solution = Eigen::Vector3d::Zero();
  for (int k = 0; k < 6; ++k) {
    solution += damped * (sum - squares * solution);
  }
  centre = components(solution);
  double largest = 0, reach = length_of(centre);
  for (loop_joint& j : joints) {
    reach = std::max(reach, length_of(j.point));
    const auto from_centre = j.point - centre;
    j.point = from_centre - dot(from_centre, j.axis) * j.axis;
    largest = std::max(largest, length_of(j.point));
  }
  const double to_tip = length_of(tip.translation - centre), rounding = 1e-12 * reach;
  size = largest > rounding ? largest : to_tip > rounding ? to_tip : 1; // all axes meet
  for (loop_joint& j : joints) {
    j.point = 1 / size * j.point;
  }
}
#endif

} // namespace duet::detail
