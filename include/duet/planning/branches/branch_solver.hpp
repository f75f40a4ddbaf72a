// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/planning/branches/branch_search.hpp>
#include <duet/planning/branches/close_loop.hpp>
#include <duet/planning/branches/closed_forms.hpp>
#include <duet/planning/branches/general_loop.hpp>
#include <duet/planning/branches/loop_equation.hpp>
#include <duet/planning/branches/loop_solution_set.hpp>
#include <duet/planning/branches/parallel_prismatic.hpp>
#include <duet/planning/branches/subproblems.hpp>
#include <duet/planning/planning_model.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>

/// \file
/// Selection of the method that finds all solutions of a loop of six joints. Compiled into
/// duet::compiled.

namespace duet::detail {

#ifdef DUET_DEFINES_COMPILED
/// Common point of the axes of three joints, if there is one.
[[nodiscard]] inline std::optional<vector3d> common_point(const loop_joint& a, const loop_joint& b,
                                                          const loop_joint& c) {
  constexpr double rounding = 1e-9, across = 1e-6;
  if (!a.turns || !b.turns || !c.turns || length_of(cross(a.axis, b.axis)) < across ||
      length_of(cross(b.axis, c.axis)) < across) {
    return {};
  }
  const vector3d point = nearest_point(a, b);
  const auto is_on_axis = [&](const loop_joint& j) {
    return length_of(cross(j.axis, point - j.point)) < rounding;
  };
  return is_on_axis(b) && is_on_axis(c) ? std::optional(point) : std::nullopt;
}

[[nodiscard]] inline bool are_parallel(const loop_joint& a, const loop_joint& b) {
  return a.turns && b.turns && is_on(a.axis, b.axis);
}

template <class Form, class... Rest>
bool branch_search::solve(solution_method method, int first, const loop_equation& loop,
                          const Rest&... rest) {
  constexpr int most = std::same_as<Form, three_prismatic_loop> ? 2 : 8;
  constexpr double rounding = 1e-13, beside = .01;
  const bool is_determined = Form(loop, rest...)([&](six_coordinates theta, int multiplicity) {
    const closure_error gap(loop, theta);
    if (gap.twist.norm() > rounding * gap.size) { // near a singularity
      six_coordinates refined = theta;
      if (close_loop(loop, refined) && (refined - theta).norm() < beside * gap.size) {
        theta = refined;
      } else if (multiplicity > 1) {
        return; // a complex pair that is nearly real
      }
    }
    loop_solution found{theta, multiplicity};
    for (int k = 0; k < 6; ++k) {
      const auto i = std::size_t((k + first) % 6);
      found.theta[Eigen::Index(i)] =
          loop.joints[std::size_t(k)].turns ? wrap_angle(theta[k]) : theta[k];
    }
    answer_.solutions.push_back(found);
    answer_.complex_solutions -= multiplicity;
  });
  if (!is_determined && answer_.solutions.empty()) {
    answer_.complex_solutions = 0;
    return false;
  }
  method_ = method;
  answer_.complex_solutions = std::max(0, answer_.complex_solutions + most);
  answer_.is_complete = is_determined;
  return true;
}

DUET_COMPILED_FUNCTION loop_solution_set eliminated(const loop_equation& loop) {
  return solve_general_loop<elimination>(loop);
}

DUET_COMPILED_FUNCTION branch_search::branch_search(const loop_equation& loop) {
  search(loop);
  const bool is_certain = answer_.solutions.empty() && is_beyond_reach(loop),
             is_general = method_ == solution_method::elimination ||
                          method_ == solution_method::two_prismatic; // both displace by themselves
  if (answer_.solutions.empty() && !is_certain && !is_general) {
    search_beside(loop);
  }
  if (method_ != solution_method::two_prismatic) { // which detects permanent self-motion itself
    answer_.is_complete = is_certain || (answer_.is_complete && !is_always_singular(loop));
  }
}

/// Searches for solutions with slightly displaced goals: round-off may have made a double solution
/// complex, and with a nearby goal it is complex or two real ones.
inline void branch_search::search_beside(const loop_equation& loop) {
  constexpr int times = 6;
  constexpr double by = 1e-7;
  for (int k = 0; k < times && answer_.solutions.empty(); ++k) {
    branch_search beside;
    beside.search(with_disturbed_goal(loop, by, std::uint64_t(k) + 1));
    for (loop_solution x : beside.answer_.solutions) {
      answer_.is_complete = false;
      if (answer_.solutions.empty() && close_loop(loop, x.theta)) {
        answer_.solutions.push_back(x);
        answer_.complex_solutions = std::max(0, answer_.complex_solutions - x.multiplicity);
      }
    }
  }
}

inline void branch_search::search(const loop_equation& loop) {
  const auto& joints = loop.joints;
  const auto sliding =
      std::count_if(joints.begin(), joints.end(), [](const loop_joint& j) { return !j.turns; });
  if (sliding == 3) {
    solve<three_prismatic_loop>(solution_method::three_prismatic, 0, loop);
    return;
  }
  if (sliding == 2) {
    const auto in_place = parallel_prismatic_of(loop);
    answer_ =
        in_place ? solve_parallel_prismatic(*in_place) : solve_general_loop<two_prismatic>(loop);
    method_ = solution_method::two_prismatic;
    return;
  }
  const auto from = [&](int first) {
    loop_equation result = loop;
    for (int k = 0; k < first; ++k) {
      result = result.shifted();
    }
    return result;
  };
  for (std::size_t i = 0; i < 4 && sliding == 0; ++i) {
    const loop_joint &a = joints[i], &b = joints[i + 1], &c = joints[i + 2];
    const int first = int(i), after = (first + 3) % 6;
    if (const auto centre = common_point(a, b, c)) {
      const vector3d in_loop = after == 0 ? *centre : inverse_pose(loop.closing).point(*centre);
      if (solve<spherical_loop>(solution_method::spherical_wrist, after, from(after), in_loop)) {
        return;
      }
    } else if (are_parallel(a, b) && are_parallel(b, c)) {
      if (solve<planar_loop>(solution_method::parallel_axes, first, from(first))) {
        return;
      }
    }
  }
  answer_ = eliminated(loop);
}
#endif

} // namespace duet::detail
