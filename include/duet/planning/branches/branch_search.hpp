// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/planning/branches/joint_loop.hpp>
#include <duet/planning/branches/loop_answer.hpp>

#include <array>
#include <cstddef>

/// \file
/// Which way all solutions of a loop are found.

namespace duet {

/// How `all_inverse_kinematics` found the solutions.
enum class branch_method {
  spherical_wrist, ///< closed form: three axes, one after the other, meet in a point
  parallel_axes,   ///< closed form: three axes, one after the other, are parallel
  three_slides,    ///< closed form: three joints slide
  two_slides,      ///< zeros of a polynomial: two joints slide
  elimination      ///< zeros of a determinant
};

/// The name of a `branch_method`.
[[nodiscard]] inline const char* to_text(branch_method method) {
  constexpr std::array names{"spherical_wrist", "parallel_axes", "three_slides", "two_slides",
                             "elimination"};
  return names[std::size_t(method)];
}

namespace detail {

/// All solutions of a loop, by the way that suits it.
class branch_search {
public:
  explicit branch_search(const joint_loop& loop);

  [[nodiscard]] const loop_answer& answer() const { return answer_; }
  [[nodiscard]] branch_method method() const { return method_; }

private:
  branch_search() = default;

  void search(const joint_loop& loop);
  void search_beside(const joint_loop& loop);
  /// Solves the loop that begins with its joint number `first` as a loop of the type `Form`.
  template <class Form, class... Rest>
  bool solve(branch_method method, int first, const joint_loop& loop, const Rest&... rest);

  loop_answer answer_;
  branch_method method_ = branch_method::elimination;
};

/// All solutions of a loop by elimination, as of arms of no special geometry.
[[nodiscard]] DUET_COMPILED_FUNCTION loop_answer eliminated(const joint_loop& loop);

} // namespace detail
} // namespace duet

#ifndef DUET_COMPILED
#include <duet/planning/branches/branch_solver.hpp>
#endif
