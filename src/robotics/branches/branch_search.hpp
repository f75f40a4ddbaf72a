// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "loop_equation.hpp"

#include <duet/robotics/all_inverse_kinematics.hpp>

/// \file
/// Selection of the method that finds all solutions of a loop of six joints.

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

DUET_ABI_END
} // namespace duet::detail
