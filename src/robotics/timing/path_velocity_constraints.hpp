// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/kinematics/joint_trajectory.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

/// \file
/// Velocity, acceleration and jerk limits as constraints on the squared path velocity b(τ) = τ̇²
/// (D. Verscheure et al., Time-optimal path tracking for robots: a convex optimization approach,
/// 2009), and the minimum-time one among those that satisfy them.

namespace duet::detail {
DUET_ABI_BEGIN

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
  /// Computes the last two coefficients c_1 and c_0 at an end in motion at p_0, from the next two
  /// positions and the coefficient before them.
  static void advance(double p_0, double p_1, double p_2, double c_2, double& c_1, double& c_0);
  /// Coefficients of s in [k, k + 1] by powers of τ − k.
  [[nodiscard]] std::array<double, 4> powers(std::size_t k) const;

  std::vector<double> c_;
};

/// Linear form of the three B-spline coefficients of the squared path velocity that
/// are active in a segment.
using linear_form = std::array<double, 3>;

[[nodiscard]] inline double times(const linear_form& row, const double* c) {
  return row[0] * c[0] + row[1] * c[1] + row[2] * c[2];
}

/// Polynomial in τ − k, by its powers, of a squared path velocity in interval k. The latter is a
/// quadratic B-spline whose outer coefficients are its values at the ends.
[[nodiscard]] std::array<linear_form, 3> path_velocity_powers(std::size_t k, std::size_t intervals);

/// Constraints |x c| ≤ limit of one joint, relative to its limits: accelerations, and jerks divided
/// by τ̇, by their four Bernstein coefficients in a segment. `beyond` c bounds the error of the
/// middle two; the outer ones are values at the ends.
struct joint_bounds {
  std::array<linear_form, 4> acceleration{}, jerk{};
  linear_form beyond_acceleration{}, beyond_jerk{};
};

/// Bernstein coefficients in a segment of the squared path velocity, and of the square of the
/// largest joint velocity relative to its limit.
struct piece_bounds {
  std::size_t first; ///< index of the coefficient that c[0] is
  double length;     ///< length of the segment in τ
  std::array<linear_form, 4> squared_velocity{};
  std::array<linear_form, 10> square_rate{};
};

/// Constraints on a squared path velocity b = τ̇² that is a quadratic B-spline of τ
/// with positive coefficients, one more than nodes of τ; the outer ones are its values at
/// the ends. Joint velocities are q' s' √b with s' = ds/dτ; accelerations and jerks /
/// √b are linear in it:
///
///     q̈     = q'' s'² b + q' change,               change = s̈ = s'' b + s' b' / 2
///     q⃛ / τ̇ = q''' s'³ pace + 3 q'' s' change + q' third,
///     third  = s''' b + 3/2 s'' b' + s' b'' / 2
struct path_velocity_constraints {
  std::vector<piece_bounds> pieces;
  std::vector<joint_bounds> joints; ///< constraints of each segment, one per joint

  /// Collects the constraints of all segments of a path.
  ///
  /// \param intervals  number of intervals of τ
  path_velocity_constraints(const std::vector<joint_cubic>& curve,
                            const std::vector<reference_piece>& path, std::size_t intervals,
                            const Eigen::VectorXd& velocity, const Eigen::VectorXd& acceleration,
                            const Eigen::VectorXd& jerk);

private:
  void add(const joint_cubic& q, const reference_piece& piece, std::size_t intervals,
           const Eigen::VectorXd& velocity, const Eigen::VectorXd& acceleration,
           const Eigen::VectorXd& jerk);
};

/// Squared path velocity within limits, by the coefficients of its B-spline.
struct path_velocity_result {
  std::vector<double> coefficients;
  std::array<double, 2> reached{}; ///< fraction of the required value attained at each end
  std::size_t nearest_joint = 0;   ///< joint whose acceleration and jerk limits are the nearest
};

/// Nearly minimum-time squared path velocity by a log-barrier interior-point method: the margins to
/// the limits cost about 10 / accuracy of the time.
///
/// \param ends  squared path velocities required at the ends, where joint velocities satisfy their
/// limits; 0: free
[[nodiscard]] path_velocity_result
minimum_time_path_velocity(const path_velocity_constraints& bounds,
                           const std::array<double, 2>& ends, double accuracy);

DUET_ABI_END
} // namespace duet::detail
