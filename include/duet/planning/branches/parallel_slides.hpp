// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/planning/branches/general_loop.hpp>
#include <duet/planning/branches/joint_loop.hpp>
#include <duet/planning/branches/loop_answer.hpp>
#include <duet/planning/branches/orthonormalise.hpp>
#include <duet/planning/branches/turns.hpp>
#include <duet/planning/branches/two_slides.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <optional>

/// \file
/// A loop of which two joints slide along each other, whatever the others do.
///
/// Together they can do no more than one of them: the tip reaches poses of five dimensions only,
/// and where it is at one, they move in place. With one held at 0 there are six equations for five
/// coordinates. If its axis were across the other's there were as many coordinates as equations,
/// and up to eight solutions, as of any two slides. Those of them that do not use it are all there
/// are.

namespace duet::detail {

/// A loop that begins with one of two such slides.
struct parallel_slides {
  joint_loop loop;
  std::size_t first;  ///< where that one is in the loop that was given
  std::size_t second; ///< where the other one is in this loop
};

/// These slides, if nothing but turns about their own direction is between them, one way round or
/// the other.
[[nodiscard]] inline std::optional<parallel_slides> parallel_slides_of(const joint_loop& loop) {
  joint_loop from = loop;
  for (std::size_t first = 0; first < 6; ++first) {
    const loop_joint& slide = from.joints[0];
    std::size_t k = 1;
    while (k < 6 && from.joints[k].turns && is_on(slide.axis, from.joints[k].axis)) {
      ++k;
    }
    if (!slide.turns && k < 6 && !from.joints[k].turns && is_on(slide.axis, from.joints[k].axis)) {
      return parallel_slides{from, first, k};
    }
    from = from.shifted();
  }
  return {};
}

/// Gauss and Newton's method for all coordinates but one, which stays.
/// \return is the loop closed then?
[[nodiscard]] inline bool close_with_held(const joint_loop& loop, Eigen::Index held,
                                          six_coordinates& theta) {
  constexpr double rounding = 1e-12;
  for (int k = 0; k < 6; ++k) {
    const loop_gap gap(loop, theta);
    Eigen::Matrix<double, 6, 5> moving;
    moving << gap.jacobian.leftCols(held), gap.jacobian.rightCols(5 - held);
    Eigen::Matrix<double, 5, 5> inverse = Eigen::Matrix<double, 5, 5>::Identity(); // R⁻¹ of Q R
    orthonormalise(moving, inverse);
    const Eigen::Matrix<double, 5, 1> step = inverse * (moving.transpose() * gap.twist);
    theta.head(held) += step.head(held);
    theta.tail(5 - held) += step.tail(5 - held);
  }
  const loop_gap left(loop, theta);
  return left.twist.norm() <= rounding * left.size;
}

/// The solutions in which one of the slides, the second, is at 0.
[[nodiscard]] inline loop_answer solve_parallel_slides(const parallel_slides& slides) {
  const auto held = Eigen::Index(slides.second);
  const Eigen::Vector3d n = slides.loop.joints[slides.second].axis, u = n.unitOrthogonal();
  joint_loop across = slides.loop; // in none of the directions in which known arms have axes
  across.joints[slides.second].axis =
      components(Eigen::Vector3d(std::cos(.7) * u + std::sin(.7) * n.cross(u)));
  const loop_answer all = solve_general_loop<two_slides>(across);
  loop_answer result;
  for (loop_solution each : all.solutions) {
    constexpr double close_to_zero = 1e-5; // where two solutions meet they are less precise
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
