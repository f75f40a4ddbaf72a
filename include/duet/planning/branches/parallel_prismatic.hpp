// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/planning/branches/general_loop.hpp>
#include <duet/planning/branches/loop_equation.hpp>
#include <duet/planning/branches/loop_solution_set.hpp>
#include <duet/planning/branches/orthonormalise.hpp>
#include <duet/planning/branches/subproblems.hpp>
#include <duet/planning/branches/two_prismatic.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <optional>

/// \file
/// Loops with two prismatic joints that are parallel in every configuration.
///
/// Together they can do no more than one of them: the tip reaches a five-dimensional set of poses
/// only, and at each of these the two joints have a self-motion. With one fixed at 0 there are six
/// equations for five coordinates. If its axis were perpendicular to the other's, there would be as
/// many coordinates as equations, and up to eight solutions, as for any two prismatic joints. Those
/// solutions that do not use it are all there are.

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
    const loop_joint& slide = from.joints[0];
    std::size_t k = 1;
    while (k < 6 && from.joints[k].turns && is_on(slide.axis, from.joints[k].axis)) {
      ++k;
    }
    if (!slide.turns && k < 6 && !from.joints[k].turns && is_on(slide.axis, from.joints[k].axis)) {
      return parallel_prismatic{from, first, k};
    }
    from = from.shifted();
  }
  return {};
}

/// Gauss–Newton method for all coordinates except one, which is fixed.
///
/// \return true if it closes the loop
[[nodiscard]] inline bool close_with_held(const loop_equation& loop, Eigen::Index held,
                                          six_coordinates& theta) {
  constexpr double rounding = 1e-12;
  for (int k = 0; k < 6; ++k) {
    const closure_error gap(loop, theta);
    Eigen::Matrix<double, 6, 5> moving;
    moving << gap.jacobian.leftCols(held), gap.jacobian.rightCols(5 - held);
    Eigen::Matrix<double, 5, 5> inverse = Eigen::Matrix<double, 5, 5>::Identity(); // R⁻¹ of Q R
    orthonormalise(moving, inverse);
    const Eigen::Matrix<double, 5, 1> step = inverse * (moving.transpose() * gap.twist);
    theta.head(held) += step.head(held);
    theta.tail(5 - held) += step.tail(5 - held);
  }
  const closure_error left(loop, theta);
  return left.twist.norm() <= rounding * left.size;
}

/// Solutions in which the second of the prismatic joints is at 0.
[[nodiscard]] inline loop_solution_set solve_parallel_prismatic(const parallel_prismatic& slides) {
  const auto held = Eigen::Index(slides.second);
  const Eigen::Vector3d n = slides.loop.joints[slides.second].axis, u = n.unitOrthogonal();
  loop_equation across = slides.loop; // no known arm has an axis in that direction
  across.joints[slides.second].axis =
      components(Eigen::Vector3d(std::cos(.7) * u + std::sin(.7) * n.cross(u)));
  const loop_solution_set all = solve_general_loop<two_prismatic>(across);
  loop_solution_set result;
  for (loop_solution each : all.solutions) {
    constexpr double close_to_zero = 1e-5; // double solutions are less accurate
    const bool is_unused = std::abs(each.theta[held]) < close_to_zero;
    each.theta[held] = 0;
    if (is_unused && close_with_held(slides.loop, held, each.theta)) {
      six_coordinates theta;
      for (Eigen::Index k = 0; k < 6; ++k) {
        theta[(k + Eigen::Index(slides.first)) % 6] = each.theta[k];
      }
      result.solutions.push_back({theta, each.multiplicity});
    }
  }
  result.is_complete = all.is_complete && result.solutions.empty();
  const double same_way =
      dot(slides.loop.joints[0].axis, slides.loop.joints[slides.second].axis) > 0 ? -1 : 1;
  result.in_place = {int(slides.first), int((slides.first + slides.second) % 6), same_way};
  return result;
}

} // namespace duet::detail
