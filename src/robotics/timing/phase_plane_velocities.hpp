// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/kinematics/joint_trajectory.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

/// \file
/// Maximum squared path velocity x = ṡ² along a path in the phase plane (s, ṡ) under velocity and
/// acceleration limits.

namespace duet::detail {
DUET_ABI_BEGIN

/// Constraint |y + slope x| ≤ reach on the squared path velocities x = ṡ² at the start of a segment
/// and y at its end.
struct speed_bound {
  double slope, reach;
};

/// Interval of the y between `lower` and `upper` that satisfy all constraints for a given x, from
/// the value of one line at x to that of another.
struct feasible_path_velocities {
  struct line {
    double at_zero, slope, value;
  };
  line lower, upper;

  feasible_path_velocities(std::span<const speed_bound> bounds, double x, double from, double to);
};

/// Nearest value to x for which some y between `lower` and `upper` satisfies all constraints;
/// NaN if no such y exists. The length of the interval of such y is a concave function of x.
/// Newton's method approaches its nearer zero from outside without passing it, from one pair of
/// active lines to the next.
[[nodiscard]] double nearest_speed(std::span<const speed_bound> bounds, double x, double lower,
                                   double upper);

/// Constraints on ṡ² at the starts and ends of the segments of a path, between which it is linear
/// in s.
struct path_bounds {
  std::vector<double> before, after; ///< largest ṡ² that velocity limits admit
  std::vector<speed_bound> bounds;   ///< constraints, as many for each segment
  std::size_t bounds_each;

  explicit path_bounds(Eigen::Index joints) : bounds_each(std::size_t(3 * joints)) {}

  void reserve(std::size_t parts);
  [[nodiscard]] std::size_t size() const { return before.size(); }
  [[nodiscard]] std::span<const speed_bound> of(std::size_t part) const;
  /// Adds the constraints by which velocities and accelerations stay within limits on an entire
  /// segment. With ṡ² linear in s the acceleration q' s̈ + q'' ṡ² is a quadratic polynomial and
  /// lies between its Bernstein coefficients, which are linear in both ṡ².
  void add(const joint_cubic& q, const Eigen::VectorXd& velocity,
           const Eigen::VectorXd& acceleration);

private:
  /// Constraint |a x + b y| ≤ c, solved for y.
  [[nodiscard]] speed_bound bound(double a, double b, double c);
  /// Applies a velocity limit. If |q'| is below a line from l to r l, ṡ² may be below (limit /
  /// line)², which is a convex function, and is above its chord divided by the largest ratio of the
  /// two. That ratio is attained at (2 r + 1) / (3 r + 3) of the segment.
  void apply_velocity_limit(const std::array<double, 3>& p, double limit);
};

/// Infeasible boundary velocity: the end of the path, and the largest ṡ² that is feasible there.
struct infeasible_boundary {
  bool at_start = false, at_end = false;
  double largest = 0;
};

/// Maximum squared path velocities ṡ² at the ends of all segments. The backward pass finds the
/// range from which the given end can be reached; the forward pass takes the largest values that
/// this range and the constraints admit.
///
/// \param infeasible  set if a boundary velocity is infeasible; then the result has no meaning
[[nodiscard]] std::vector<double> phase_plane_velocities(const path_bounds& path, double first,
                                                         double last,
                                                         infeasible_boundary& infeasible);

DUET_ABI_END
} // namespace duet::detail
