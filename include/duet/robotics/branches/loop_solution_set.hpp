// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/robotics/branches/loop_equation.hpp>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

/// \file
/// Solutions of a loop of six joints and their completeness.

namespace duet::detail {

/// Solution of a loop with its multiplicity.
struct loop_solution {
  six_coordinates theta;
  int multiplicity = 1;
  double sigma = 1; ///< smallest singular value of the loop's Jacobian; 1 if not computed
};

/// Two prismatic joints that are parallel in every configuration: displacements by x of the first
/// and by `second_factor` x of the second leave the loop closed.
struct coupled_prismatic_pair {
  int first = 0, second = 0;
  double second_factor = -1;
};

/// Solutions of a loop, and whether they are complete.
struct loop_solution_set {
  std::vector<loop_solution> solutions;
  int complex_solutions = 0;
  bool is_complete = false;
  std::optional<coupled_prismatic_pair> coupled_pair =
      {}; ///< if set, a solution represents all that it makes
};

/// Angle wrapped to (−π, π].
[[nodiscard]] inline double wrap_angle(double x) {
  constexpr double pi = std::numbers::pi, full_turn = 2 * pi;
  const double size = std::abs(x);
  // `std::remainder` alone gives the same, but takes twenty times as long.
  const double r = size <= pi       ? x
                   : size <= 3 * pi ? x - std::copysign(full_turn, x)
                                    : std::remainder(x, full_turn);
  return r <= -pi ? pi : r;
}

} // namespace duet::detail
