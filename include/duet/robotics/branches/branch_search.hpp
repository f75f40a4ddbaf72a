// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/robotics/branches/loop_equation.hpp>
#include <duet/robotics/branches/loop_solution_set.hpp>

#include <array>
#include <cstddef>

/// \file
/// Selection of the method that finds all solutions of a loop of six joints.

namespace duet {

/// Method by which `all_inverse_kinematics` found the solutions.
enum class solution_method {
  spherical_wrist, ///< closed form: three consecutive axes meet in a point
  parallel_axes,   ///< closed form: three consecutive axes are parallel
  three_prismatic, ///< closed form: three prismatic joints
  two_prismatic,   ///< zeros of a polynomial: two prismatic joints
  elimination      ///< zeros of a determinant (Raghavan–Roth)
};

/// Name of a `solution_method`.
[[nodiscard]] inline const char* to_text(solution_method method) {
  constexpr std::array names{"spherical_wrist", "parallel_axes", "three_prismatic", "two_prismatic",
                             "elimination"};
  return names[std::size_t(method)];
}

namespace detail {

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

/// All solutions of a loop by Raghavan–Roth elimination, for arms without special geometry.
[[nodiscard]] DUET_COMPILED_FUNCTION loop_solution_set eliminated(const loop_equation& loop);

} // namespace detail
} // namespace duet

#ifndef DUET_COMPILED
#include <duet/robotics/branches/branch_solver.hpp>
#endif
