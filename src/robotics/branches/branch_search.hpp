// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "loop_equation.hpp"

#include <duet/robotics/all_inverse_kinematics.hpp>

#include <cstdint>

/// \file
/// All solutions of a loop of six joints: selection of the method, and the methods for loops
/// without a closed form.

namespace duet::detail {
DUET_ABI_BEGIN

/// All solutions of a loop, by the method that suits its geometry.
class branch_search {
public:
  explicit branch_search(const loop_equation& loop);

  [[nodiscard]] const loop_solution_set& answer() const { return answer_; }
  [[nodiscard]] solution_method method() const { return method_; }

private:
  branch_search() = default;

  void search(const loop_equation& loop);
  void search_near_goal(const loop_equation& loop);
  /// Solves the loop that begins with its joint number `first` as a loop of the type `Form`.
  ///
  /// \return false if no solution is found and coordinates are undetermined
  template <class Form, class... Rest>
  bool solve(solution_method method, int first, const loop_equation& loop, const Rest&... rest);

  loop_solution_set answer_;
  solution_method method_ = solution_method::elimination;
};

/// Loop with a goal close to the given one.
[[nodiscard]] loop_equation with_disturbed_goal(loop_equation loop, double by, std::uint64_t seed);

/// True if the goal is farther away than the joints can reach.
[[nodiscard]] bool is_beyond_reach(const loop_equation& loop);

/// True if no solution is regular, whatever the goal, as if two neighbouring joints rotate about
/// one axis.
[[nodiscard]] bool is_always_singular(const loop_equation& loop);

/// All solutions of a loop by Raghavan–Roth elimination, for arms without special geometry.
[[nodiscard]] loop_solution_set eliminated(const loop_equation& loop);

/// All solutions of a loop with two prismatic joints, by the zeros of a polynomial.
[[nodiscard]] loop_solution_set solve_two_prismatic(const loop_equation& loop);

DUET_ABI_END
} // namespace duet::detail
