// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/planning/branches/joint_loop.hpp>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

/// \file
/// What is known of the solutions of a loop of six joints.

namespace duet::detail {

/// A solution of a loop, and how many coincide in it.
struct loop_solution {
  six_coordinates theta;
  int multiplicity = 1;
  double sigma = 1; ///< smallest singular value of the loop's Jacobian, if it was computed
};

/// Two joints that slide along each other wherever the others are: the first by x and the second by
/// `second_way` x leave the loop closed.
struct slides_in_place {
  int first = 0, second = 0;
  double second_way = -1;
};

/// What is known of the solutions of a loop.
struct loop_answer {
  std::vector<loop_solution> solutions;
  int complex_solutions = 0;
  bool is_complete = false;
  std::optional<slides_in_place> in_place = {}; ///< then a solution stands for all that these make
};

/// The angle between −π and π, π included.
[[nodiscard]] inline double turned_back(double x) {
  constexpr double pi = std::numbers::pi, turn = 2 * pi;
  const double size = std::abs(x);
  // The same but for the last of these, which takes twenty times as long.
  const double r = size <= pi       ? x
                   : size <= 3 * pi ? x - std::copysign(turn, x)
                                    : std::remainder(x, turn);
  return r <= -pi ? pi : r;
}

} // namespace duet::detail
