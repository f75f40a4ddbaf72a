// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/robotics/branches/general_loop.hpp>
#include <duet/robotics/branches/loop_equation.hpp>
#include <duet/robotics/branches/loop_solution_set.hpp>
#include <duet/robotics/branches/orthonormalise.hpp>
#include <duet/robotics/branches/subproblems.hpp>
#include <duet/robotics/branches/two_prismatic.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <optional>

/// \file
/// Loops with two prismatic joints that are parallel in every configuration.
///
/// The two joints are redundant: the tip reaches only a five-dimensional set of poses, and at each
/// of these the joints have a self-motion. With one joint fixed at 0 there are six equations for
/// five coordinates. If the axis of that joint were perpendicular to the other one, the loop would
/// have up to eight solutions, as with any two prismatic joints. The solutions of the original loop
/// are those of the modified loop in which the coordinate of that joint is 0.

namespace duet::detail {

/// Loop that begins with one of two such prismatic joints.
struct parallel_prismatic {
  loop_equation loop;
  std::size_t first;  ///< index of that joint in the given loop
  std::size_t second; ///< index of the other one in this loop
};

/// Pair of such prismatic joints, if only rotations about their common direction are between them,
/// in one direction of the loop or the other.
[[nodiscard]] inline std::optional<parallel_prismatic>
parallel_prismatic_of(const loop_equation& loop) {
  loop_equation from = loop;
  for (std::size_t first = 0; first < 6; ++first) {
    const loop_joint& prismatic = from.joints[0];
    std::size_t k = 1;
    while (k < 6 && from.joints[k].is_revolute && is_on(prismatic.axis, from.joints[k].axis)) {
      ++k;
    }
    if (!prismatic.is_revolute && k < 6 && !from.joints[k].is_revolute &&
        is_on(prismatic.axis, from.joints[k].axis)) {
      return parallel_prismatic{from, first, k};
    }
    from = from.shifted();
  }
  return {};
}

/// Gauss–Newton method for all coordinates except one, which is fixed.
///
/// \return true if it closes the loop
[[nodiscard]] inline bool close_with_fixed(const loop_equation& loop, Eigen::Index fixed,
                                           six_coordinates& theta) {
  constexpr double rounding = 1e-12;
  for (int k = 0; k < 6; ++k) {
    const closure_error closure(loop, theta);
    Eigen::Matrix<double, 6, 5> moving;
    moving << closure.jacobian.leftCols(fixed), closure.jacobian.rightCols(5 - fixed);
    Eigen::Matrix<double, 5, 5> inverse = Eigen::Matrix<double, 5, 5>::Identity(); // R⁻¹ of Q R
    orthonormalise(moving, inverse);
    const Eigen::Matrix<double, 5, 1> step = inverse * (moving.transpose() * closure.twist);
    theta.head(fixed) += step.head(fixed);
    theta.tail(5 - fixed) += step.tail(5 - fixed);
  }
  const closure_error closure(loop, theta);
  return closure.twist.norm() <= rounding * closure.size;
}

/// Solutions in which the second of the prismatic joints is at 0.
[[nodiscard]] inline loop_solution_set solve_parallel_prismatic(const parallel_prismatic& pair) {
  const auto fixed = Eigen::Index(pair.second);
  const Eigen::Vector3d n = pair.loop.joints[pair.second].axis, u = n.unitOrthogonal();
  loop_equation across = pair.loop; // no known arm has an axis in that direction
  across.joints[pair.second].axis =
      components(Eigen::Vector3d(std::cos(.7) * u + std::sin(.7) * n.cross(u)));
  const loop_solution_set all = solve_general_loop<two_prismatic>(across);
  loop_solution_set result;
  for (loop_solution each : all.solutions) {
    constexpr double close_to_zero = 1e-5; // double solutions are less accurate
    const bool is_unused = std::abs(each.theta[fixed]) < close_to_zero;
    each.theta[fixed] = 0;
    if (is_unused && close_with_fixed(pair.loop, fixed, each.theta)) {
      six_coordinates theta;
      for (Eigen::Index k = 0; k < 6; ++k) {
        theta[(k + Eigen::Index(pair.first)) % 6] = each.theta[k];
      }
      result.solutions.push_back({theta, each.multiplicity});
    }
  }
  result.is_complete = all.is_complete && result.solutions.empty();
  const double second_factor =
      dot(pair.loop.joints[0].axis, pair.loop.joints[pair.second].axis) > 0 ? -1 : 1;
  result.coupled_pair = {int(pair.first), int((pair.first + pair.second) % 6), second_factor};
  return result;
}

} // namespace duet::detail
