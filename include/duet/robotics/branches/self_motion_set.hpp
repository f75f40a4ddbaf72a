// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/robotics/branches/loop_equation.hpp>
#include <duet/robotics/branches/loop_solution_set.hpp>
#include <duet/robotics/branches/seven_joint_arm.hpp>
#include <duet/robotics/splitmix64.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>

/// \file
/// The set of configurations of seven joints that hold the tip at a pose: projection onto it, the
/// Jacobian's null space, and the set's dimension at a point.

namespace duet::detail {

/// Tolerances for the self-motion set of one arm at one goal.
struct self_motion_tolerance {
  static constexpr double on_set = 1e-12;    ///< error of the pose on the set
  static constexpr double singular = 1e-5;   ///< singular value, relative to the largest
  static constexpr double same = 1e-6;       ///< distance of coinciding points of regular curves
  static constexpr double same_rough = 1e-4; ///< distance where the Jacobian is singular
};

/// Self-motion set M = {θ : the tip is at the goal}, with angles modulo full turns.
///
/// At a regular point M is a curve along the Jacobian's null space. If the null space has more
/// dimensions, M may still be a curve (two that coincide, as for a straight elbow), curves that
/// cross, an isolated point, or have as many dimensions: neighbouring points of M decide.
class self_motion_set {
public:
  using null_space = Eigen::Matrix<double, 7, Eigen::Dynamic, Eigen::ColMajor, 7, 7>;

  explicit self_motion_set(const redundant_arm& arm) : arm_(arm) {}

  /// Difference b − a, rotation angles by the shorter arc; lengths relative to the arm's size.
  [[nodiscard]] seven_coordinates difference(const seven_coordinates& b,
                                             const seven_coordinates& a) const {
    seven_coordinates d = b - a;
    for (int i = 0; i < 7; ++i) {
      d[i] = arm_.is_revolute[std::size_t(i)] ? wrap_angle(d[i]) : d[i] / arm_.size;
    }
    return d;
  }
  [[nodiscard]] seven_coordinates moved(seven_coordinates x, const seven_coordinates& d) const {
    for (int i = 0; i < 7; ++i) {
      x[i] += arm_.is_revolute[std::size_t(i)] ? d[i] : arm_.size * d[i];
    }
    return x;
  }

  [[nodiscard]] double error(const seven_coordinates& x) const {
    seven_columns j;
    return arm_.tip_error(x, j).norm();
  }

  /// Point of M that damped least squares (Levenberg–Marquardt) leads to from an initial guess. If
  /// the Jacobian is singular on M convergence is linear, with a factor of one half per step.
  ///
  /// \param max_distance  maximum distance from the initial guess
  /// \return empty if it does not converge within that distance
  [[nodiscard]] std::optional<seven_coordinates> projected(const seven_coordinates& from,
                                                           double max_distance) const {
    constexpr int iterations = 60;
    constexpr double rounding = 1e-15;
    constexpr double enough = 2e-15; // near a double point half of the digits are lost
    seven_coordinates x = from, best = from;
    double min_error = std::numeric_limits<double>::infinity();
    int since = 0; // steps since the error last fell
    for (int k = 0; k < iterations && since < (min_error < self_motion_tolerance::on_set ? 2 : 8);
         ++k) {
      seven_columns j;
      const six_coordinates e = arm_.tip_error(x, j);
      const double size = e.norm();
      ++since;
      if (size < .9 * min_error) {
        since = 0;
      }
      if (size < min_error) {
        min_error = size;
        best = x;
      }
      if (size < enough) {
        break;
      }
      Eigen::Matrix<double, 6, 6> gram = j * j.transpose();
      gram.diagonal().array() += std::min(.02 * size * size, .08) + rounding;
      x = moved(x, j.transpose() * gram.llt().solve(e));
      if (!(difference(x, from).norm() < max_distance)) {
        return {};
      }
    }
    return min_error < self_motion_tolerance::on_set ? std::optional(best) : std::nullopt;
  }

  /// Orthonormal basis of the Jacobian's null space.
  [[nodiscard]] null_space kernel(const seven_coordinates& x) const {
    seven_columns j;
    static_cast<void>(arm_.tip_error(x, j));
    // The product of the singular values gives a bound on the smallest: the mean square of the
    // others is not below their geometric mean. If it is far from 0 normal equations suffice.
    constexpr double regular = 1e-3;
    const Eigen::LLT<Eigen::Matrix<double, 6, 6>> gram(j * j.transpose());
    const double product = gram.matrixLLT().diagonal().prod(), squares = j.squaredNorm();
    if (gram.info() == Eigen::Success &&
        product > regular * std::sqrt(squares) * std::pow(squares / 5, 2.5)) {
      const square projector = square::Identity() - j.transpose() * gram.solve(j);
      Eigen::Index largest = 0;
      projector.diagonal().maxCoeff(&largest);
      const seven_coordinates column = projector.col(largest);
      return (column - j.transpose() * gram.solve(j * column)).normalized();
    }
    square rows = square::Zero();
    rows.topRows<6>() = j;
    const decomposition svd(rows, Eigen::ComputeFullV);
    const auto& sizes = svd.singularValues();
    Eigen::Index rank = 0;
    while (rank < 6 && sizes[rank] > self_motion_tolerance::singular * sizes[0]) {
      ++rank;
    }
    return svd.matrixV().rightCols(7 - rank);
  }

  /// Random unit vector of a null space.
  [[nodiscard]] static seven_coordinates any_direction(const null_space& kernel,
                                                       splitmix64& random) {
    seven_coordinates result;
    do {
      result.setZero();
      for (Eigen::Index k = 0; k < kernel.cols(); ++k) {
        result += (2 * random() - 1) * kernel.col(k);
      }
    } while (!(result.norm() > .1));
    return result.normalized();
  }

  /// Dimension of M at a point, from the projections of points at a distance `step` in
  /// directions of the Jacobian's null space. (At crossings: the dimension of the span of all
  /// curves that meet there.)
  [[nodiscard]] int dimension(const seven_coordinates& x, double step, splitmix64& random) const {
    const null_space basis = kernel(x);
    if (basis.cols() == 1) {
      return 1;
    }
    constexpr double min_fraction = .01; // fraction of the mean square; curvature contributes step²
    square spread = square::Zero();
    const int count = 4 * int(basis.cols());
    for (int k = 0; k < count; ++k) {
      const auto point = neighbour(x, step, basis, random);
      if (point) {
        const seven_coordinates d = difference(*point, x) / step;
        spread += d * d.transpose() / count;
      }
    }
    const auto sizes = decomposition(spread).singularValues();
    return int((sizes.array() > min_fraction).count());
  }

  /// Neighbouring point of M at about the distance `step`, or nearer; empty if
  /// the projection fails.
  [[nodiscard]] std::optional<seven_coordinates> neighbour(const seven_coordinates& x, double step,
                                                           const null_space& basis,
                                                           splitmix64& random) const {
    return projected(moved(x, step * any_direction(basis, random)), 3 * step);
  }

  /// Random point of M; empty if the search from a random configuration fails.
  [[nodiscard]] std::optional<seven_coordinates> any_point(splitmix64& random) const {
    seven_coordinates x;
    for (int i = 0; i < 7; ++i) {
      const double part = 2 * random() - 1;
      x[i] = part * (arm_.is_revolute[std::size_t(i)] ? std::numbers::pi : arm_.size);
    }
    return projected(x, std::numeric_limits<double>::infinity());
  }

private:
  using square = Eigen::Matrix<double, 7, 7>;
  using decomposition = Eigen::JacobiSVD<square>;

  const redundant_arm& arm_;
};

} // namespace duet::detail
