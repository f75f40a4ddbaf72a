// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "chain_loop.hpp"
#include "loop_equation.hpp"

#include "../splitmix64.hpp"
#include "../tip_pose.hpp"
#include <duet/core/config.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

/// \file
/// The set of configurations of seven joints that hold the tip at a pose: projection onto it, the
/// Jacobian's null space, and the set's dimension at a point.

namespace duet::detail {
DUET_ABI_BEGIN

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
                                             const seven_coordinates& a) const;
  [[nodiscard]] seven_coordinates moved(seven_coordinates x, const seven_coordinates& d) const;

  [[nodiscard]] double error(const seven_coordinates& x) const;

  /// Point of M that damped least squares (Levenberg–Marquardt) leads to from an initial guess. If
  /// the Jacobian is singular on M convergence is linear, with a factor of one half per step.
  ///
  /// \param max_distance  maximum distance from the initial guess
  /// \return empty if it does not converge within that distance
  [[nodiscard]] std::optional<seven_coordinates> projected(const seven_coordinates& from,
                                                           double max_distance) const;

  /// Orthonormal basis of the Jacobian's null space.
  [[nodiscard]] null_space kernel(const seven_coordinates& x) const;

  /// Random unit vector of a null space.
  [[nodiscard]] static seven_coordinates any_direction(const null_space& kernel,
                                                       splitmix64& random);

  /// Dimension of M at a point, from the projections of points at a distance `step` in
  /// directions of the Jacobian's null space. (At crossings: the dimension of the span of all
  /// curves that meet there.)
  [[nodiscard]] int dimension(const seven_coordinates& x, double step, splitmix64& random) const;

  /// Neighbouring point of M at about the distance `step`, or nearer; empty if
  /// the projection fails.
  [[nodiscard]] std::optional<seven_coordinates> neighbour(const seven_coordinates& x, double step,
                                                           const null_space& basis,
                                                           splitmix64& random) const;

  /// Random point of M; empty if the search from a random configuration fails.
  [[nodiscard]] std::optional<seven_coordinates> any_point(splitmix64& random) const;

private:
  using square = Eigen::Matrix<double, 7, 7>;
  using decomposition = Eigen::JacobiSVD<square>;

  const redundant_arm& arm_;
};

DUET_ABI_END
} // namespace duet::detail
