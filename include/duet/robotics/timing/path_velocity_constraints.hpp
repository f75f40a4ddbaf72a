// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/kinematics/joint_trajectory.hpp>
#include <duet/robotics/timing/piece_polynomial.hpp>
#include <duet/robotics/timing/reference_parametrisation.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

/// \file
/// Velocity, acceleration and jerk limits as constraints on the squared path velocity b(τ) = τ̇²
/// (D. Verscheure et al., Time-optimal path tracking for robots: a convex optimization approach,
/// 2009). For those who extend duet.

namespace duet::detail {

/// Linear form of the three B-spline coefficients of the squared path velocity that
/// are active in a segment.
using linear_form = std::array<double, 3>;

[[nodiscard]] inline double times(const linear_form& row, const double* c) {
  return row[0] * c[0] + row[1] * c[1] + row[2] * c[2];
}

/// Polynomial in τ − k, by its powers, of a squared path velocity in interval k. The latter is a
/// quadratic B-spline whose outer coefficients are its values at the ends.
[[nodiscard]] inline std::array<linear_form, 3> path_velocity_powers(std::size_t k,
                                                                     std::size_t intervals) {
  const linear_form start = k == 0 ? linear_form{1, 0, 0} : linear_form{.5, .5, 0};
  const linear_form end = k + 1 == intervals ? linear_form{0, 0, 1} : linear_form{0, .5, .5};
  std::array<linear_form, 3> result{start, {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    const double middle = i == 1 ? 1 : 0;
    result[1][i] = 2 * (middle - start[i]);
    result[2][i] = start[i] - 2 * middle + end[i];
  }
  return result;
}

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

/// Bernstein coefficients of p u² for cubic polynomials u and p given by theirs; those of p are
/// linear forms.
[[nodiscard]] inline std::array<linear_form, 10> times_square(const std::array<linear_form, 4>& p,
                                                              const std::array<double, 4>& u) {
  constexpr std::array<double, 4> of_3{1, 3, 3, 1}; // binomial coefficients
  constexpr std::array<double, 10> of_9{1, 9, 36, 84, 126, 126, 84, 36, 9, 1};
  std::array<linear_form, 10> result{};
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      for (std::size_t r = 0; r < 4; ++r) {
        const double factor = of_3[a] * of_3[b] * of_3[r] / of_9[a + b + r] * u[a] * u[b];
        for (std::size_t i = 0; i < 3; ++i) {
          result[a + b + r][i] += factor * p[r][i];
        }
      }
    }
  }
  return result;
}

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
  template <class V>
  path_velocity_constraints(const std::vector<joint_cubic<V>>& curve,
                            const std::vector<reference_piece>& path, std::size_t intervals,
                            const V& velocity, const V& acceleration, const V& jerk) {
    pieces.reserve(path.size());
    joints.reserve(path.size() * std::size_t(velocity.size()));
    for (const reference_piece& piece : path) {
      add(curve[piece.edge], piece, intervals, velocity, acceleration, jerk);
    }
  }

private:
  template <class V>
  void add(const joint_cubic<V>& q, const reference_piece& piece, std::size_t intervals,
           const V& velocity, const V& acceleration, const V& jerk) {
    using polynomial = piece_polynomial;
    const double l = piece.length, f = piece.from;
    // With x = s − start: q' = p_0 + p_1 x + p_2 x² / 2, q'' = p_1 + p_2 x, q''' = p_2.
    const std::array<V, 3> p{q.first(piece.start), q.second(piece.start), V(6 * q.c3)};
    const polynomial offset{{0, piece.a * l, piece.b * l * l, piece.c * l * l * l}};
    const polynomial slope{{piece.a, 2 * piece.b * l, 3 * piece.c * l * l}};
    const polynomial bend{{2 * piece.b, 6 * piece.c * l}};
    const polynomial half_square = .5 * (offset * offset);

    // Factors of p_0, p_1 and p_2; those of accelerations and jerks for each coefficient.
    const std::array rates{cubic_approximation(slope), cubic_approximation(offset * slope),
                           cubic_approximation(half_square * slope)};
    std::array<std::array<cubic_approximation, 3>, 3> changes, jerks;
    piece_bounds bounds{piece.interval, l, {}, {}};
    const auto b = path_velocity_powers(piece.interval, intervals);
    for (std::size_t i = 0; i < 3; ++i) {
      const double start = b[0][i] + f * (b[1][i] + f * b[2][i]);
      const double rise = b[1][i] + 2 * f * b[2][i], curvature = b[2][i];
      bounds.squared_velocity[0][i] = start;
      bounds.squared_velocity[1][i] = start + rise * l / 3;
      bounds.squared_velocity[2][i] = start + l * (2 * rise + l * curvature) / 3;
      bounds.squared_velocity[3][i] = start + l * (rise + l * curvature);
      const polynomial squared_velocity{{start, rise * l, curvature * l * l}};
      const polynomial half_rise{{rise / 2, curvature * l}};
      const polynomial square = slope * slope * squared_velocity;
      const polynomial change = bend * squared_velocity + slope * half_rise;
      const polynomial both = 3 * (slope * change);
      const polynomial third =
          6 * piece.c * squared_velocity + 3 * (bend * half_rise) + curvature * slope;
      changes[i] = {cubic_approximation(change), cubic_approximation(square + offset * change),
                    cubic_approximation(offset * square + half_square * change)};
      jerks[i] = {cubic_approximation(third), cubic_approximation(both + offset * third),
                  cubic_approximation(slope * square + offset * both + half_square * third)};
    }
    std::array<double, 4> largest_rate{};
    for (Eigen::Index j = 0; j < velocity.size(); ++j) {
      joint_bounds rows;
      double beyond = 0;
      std::array<double, 4> rate{};
      for (std::size_t k = 0; k < 3; ++k) {
        const double factor = p[k][j], size = std::abs(factor);
        for (std::size_t r = 0; r < 4; ++r) {
          rate[r] += factor * rates[k].at[r];
        }
        beyond += size * rates[k].error;
        for (std::size_t i = 0; i < 3; ++i) {
          for (std::size_t r = 0; r < 4; ++r) {
            rows.acceleration[r][i] += factor * changes[i][k].at[r] / acceleration[j];
            rows.jerk[r][i] += factor * jerks[i][k].at[r] / jerk[j];
          }
          rows.beyond_acceleration[i] += size * changes[i][k].error / acceleration[j];
          rows.beyond_jerk[i] += size * jerks[i][k].error / jerk[j];
        }
      }
      for (std::size_t r = 0; r < 4; ++r) {
        const double size = std::abs(rate[r]) + (r == 1 || r == 2 ? beyond : 0);
        largest_rate[r] = std::max(largest_rate[r], size / velocity[j]);
      }
      joints.push_back(rows);
    }
    bounds.square_rate = times_square(bounds.squared_velocity, largest_rate);
    pieces.push_back(bounds);
  }
};

} // namespace duet::detail
