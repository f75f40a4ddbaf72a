// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/kinematics/joint_trajectory.hpp>
#include <duet/robotics/time_parametrised.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <vector>

/// \file
/// Curves through waypoints in joint space, and validated arguments of
/// `time_optimal_trajectory`.

namespace duet::detail {
DUET_ABI_BEGIN

/// Polygon of distinct points, with the arc length s of each along the polygon.
struct joint_polygon {
  std::vector<Eigen::VectorXd> points;
  std::vector<double> s;
  std::vector<double> waypoint_s; ///< arc length s of each given waypoint
  Eigen::VectorXd first_slope,
      last_slope; ///< slopes of the curve at its ends; 0: default of the type of curve

  explicit joint_polygon(const std::vector<Eigen::VectorXd>& waypoints);
  [[nodiscard]] std::size_t edges() const { return points.size() - 1; }
  [[nodiscard]] double length(std::size_t k) const { return s[k + 1] - s[k]; }
  [[nodiscard]] Eigen::VectorXd chord(std::size_t k) const {
    return (points[k + 1] - points[k]) / length(k);
  }
};

/// Slopes of the monotone piecewise cubic interpolant (PCHIP) of F. N. Fritsch and J. Butland (A
/// method for constructing local monotone piecewise cubic interpolants, 1984): a weighted harmonic
/// mean of the slopes of both edges, and 0 where their signs differ. Every component therefore
/// rises and falls with the points and stays between them.
[[nodiscard]] std::vector<Eigen::VectorXd> pchip_slopes(const joint_polygon& polygon);

/// Slopes of the natural cubic spline through the points, which has continuous second derivatives;
/// these are 0 at ends whose slopes are not given (natural end conditions). Its equations are h₁ d₀
/// + 2 (h₀ + h₁) d₁ + h₀ d₂ = 3 (h₁ c₀ + h₀ c₁) with the lengths h and chords c of both edges.
[[nodiscard]] std::vector<Eigen::VectorXd> natural_cubic_slopes(const joint_polygon& polygon);

/// Piecewise cubic Hermite curve through the points of a polygon with given
/// slopes, one cubic per edge.
[[nodiscard]] std::vector<joint_cubic> hermite_curve(const joint_polygon& polygon,
                                                     const std::vector<Eigen::VectorXd>& slopes);

/// Waypoints, limits and boundary velocities of a time parametrisation, validated.
struct time_parametrisation_input {
  joint_polygon polygon;
  std::size_t waypoints;
  Eigen::VectorXd velocity, acceleration, jerk;
  double initial_speed = 0, final_speed = 0; ///< path velocities ṡ at the ends
  int parts;
  Eigen::VectorXd lower, upper; ///< joint ranges on the curve; infinite: unbounded
};

[[nodiscard]] time_parametrisation_input
validated_input(const std::vector<Eigen::VectorXd>& waypoints, const Eigen::VectorXd& velocity,
                const Eigen::VectorXd& acceleration, const time_parametrisation_options& options);

/// Replaces slopes at the ends of edges on which a joint would leave its range by those of the
/// monotone curve (PCHIP).
///
/// \throws invalid_input if a joint still leaves its range because of its velocity at an end
[[nodiscard]] std::vector<Eigen::VectorXd>
slopes_within_ranges(const time_parametrisation_input& problem,
                     std::vector<Eigen::VectorXd> slopes);

DUET_ABI_END
} // namespace duet::detail
