// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/kinematics/motion_plan.hpp>
#include <duet/robotics/time_parametrised.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <vector>

/// \file
/// Time parametrisation of joint curves: curves through waypoints, maximum squared path velocities
/// x = ṡ² in the phase plane (s, ṡ) under velocity and acceleration limits, and minimum-time
/// squared path velocities b(τ) = τ̇² under jerk limits, too (D. Verscheure et al., Time-optimal
/// path tracking for robots: a convex optimization approach, 2009).

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

/// Segment of a path on one edge of a curve and in one interval [k, k + 1] of τ: its start on the
/// edge, and s relative to that start, a t + b t² + c t³ with t = τ − k − from, 0 ≤ t ≤ length.
struct reference_piece {
  std::size_t edge, interval;
  double from, length, start, a, b, c;
};

/// True for each end of a path at which a motion is at rest.
struct ends_at_rest {
  bool first = true, last = true;
};

/// Arc length s of a path as a cubic B-spline of τ, 0 ≤ τ ≤ n: twice continuously differentiable
/// and increasing, as its coefficients are except for the outer ones. At ends at rest s grows with
/// τ³, so that a motion with any τ̇ > 0 there is at rest without acceleration.
class reference_parametrisation {
public:
  /// Approximates given arc lengths.
  ///
  /// \param arc_lengths  approximate s at τ = 0, 1, …, n, n ≥ 4; exact at τ = 0 and n
  explicit reference_parametrisation(const std::vector<double>& arc_lengths,
                                     ends_at_rest rest = {});

  /// Derivative ds/dτ at an end.
  [[nodiscard]] double first_slope() const { return (c_[2] - c_[0]) / 2; }
  [[nodiscard]] double last_slope() const { return (c_[c_.size() - 1] - c_[c_.size() - 3]) / 2; }

  /// All segments, split at the ends of intervals and of edges.
  ///
  /// \param knots  arc lengths s at which edges begin and end
  [[nodiscard]] std::vector<reference_piece> pieces(const std::vector<double>& knots) const;

private:
  std::vector<double> c_;
};

/// Timed segments of a path in order, and their total duration.
struct timed_path {
  std::vector<timed_piece> pieces;
  double duration = 0;
};

/// Motion with approximately the given velocities at its ends that needs the smallest fraction of
/// the acceleration limits for them, as an initial guess for jerk limits. (Near the minimum-time
/// motion, path velocities near the ends would have to change, and searches that start there stall
/// in a corner of the feasible set.)
[[nodiscard]] timed_path min_acceleration_motion(const time_parametrisation_input& problem,
                                                 const std::vector<joint_cubic>& curve);

/// Trajectory along a curve with a squared path velocity τ̇²(τ) over n intervals of τ, given by its
/// B-spline coefficients.
[[nodiscard]] timed_path trajectory_from_path_velocity(const std::vector<joint_cubic>& curve,
                                                       const std::vector<reference_piece>& path,
                                                       std::size_t n,
                                                       const Eigen::VectorXd& squared_velocity);

/// Path arguments s of a motion at n + 1 equidistant times; the last one is the length of the path.
[[nodiscard]] std::vector<double> arc_lengths_of(const timed_path& path, std::size_t n,
                                                 double length);

/// Near-minimum-time motion along a curve within velocity, acceleration and jerk limits.
///
/// \throws invalid_input for velocities at ends with which no motion is found
[[nodiscard]] timed_path timed_within_jerks(const time_parametrisation_input& problem,
                                            const std::vector<joint_cubic>& curve);

/// Minimum-time motion along a curve, as `joint_trajectory`.
[[nodiscard]] joint_trajectory timed(const time_parametrisation_input& problem,
                                     const std::vector<joint_cubic>& curve);

DUET_ABI_END
} // namespace duet::detail
