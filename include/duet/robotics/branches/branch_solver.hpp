// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/robotics/branches/branch_search.hpp>
#include <duet/robotics/branches/close_loop.hpp>
#include <duet/robotics/branches/closed_forms.hpp>
#include <duet/robotics/branches/general_loop.hpp>
#include <duet/robotics/branches/loop_equation.hpp>
#include <duet/robotics/branches/loop_solution_set.hpp>
#include <duet/robotics/branches/parallel_prismatic.hpp>
#include <duet/robotics/branches/subproblems.hpp>
#include <duet/robotics/planning_model.hpp>

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
  if (!a.is_revolute || !b.is_revolute || !c.is_revolute ||
      length_of(cross(a.axis, b.axis)) < across || length_of(cross(b.axis, c.axis)) < across) {
    return {};
  }
  const vector3d point = nearest_point(a, b);
  const auto is_on_axis = [&](const loop_joint& j) {
    return length_of(cross(j.axis, point - j.point)) < rounding;
  };
  return is_on_axis(b) && is_on_axis(c) ? std::optional(point) : std::nullopt;
}

[[nodiscard]] inline bool are_parallel(const loop_joint& a, const loop_joint& b) {
  return a.is_revolute && b.is_revolute && is_on(a.axis, b.axis);
}

template <class Form, class... Rest>
bool branch_search::solve(solution_method method, int first, const loop_equation& loop,
                          const Rest&... rest) {
  constexpr int max_solutions = std::same_as<Form, three_prismatic_loop> ? 2 : 8;
  constexpr double rounding = 1e-13, nearby = .01;
  const bool is_determined = Form(loop, rest...)([&](six_coordinates theta, int multiplicity) {
    const closure_error closure(loop, theta);
    if (closure.twist.norm() > rounding * closure.size) { // near a singularity
      six_coordinates refined = theta;
      if (close_loop(loop, refined) && (refined - theta).norm() < nearby * closure.size) {
        theta = refined;
      } else if (multiplicity > 1) {
        return; // a complex pair that is nearly real
      }
    }
    loop_solution solution{theta, multiplicity};
    for (int k = 0; k < 6; ++k) {
      const auto i = std::size_t((k + first) % 6);
      solution.theta[Eigen::Index(i)] =
          loop.joints[std::size_t(k)].is_revolute ? wrap_angle(theta[k]) : theta[k];
    }
    answer_.solutions.push_back(solution);
    answer_.complex_solutions -= multiplicity;
  });
  if (!is_determined && answer_.solutions.empty()) {
    answer_.complex_solutions = 0;
    return false;
  }
  method_ = method;
  answer_.complex_solutions = std::max(0, answer_.complex_solutions + max_solutions);
  answer_.is_complete = is_determined;
  return true;
}

DUET_COMPILED_FUNCTION loop_solution_set eliminated(const loop_equation& loop) {
  return solve_general_loop<elimination>(loop);
}

DUET_COMPILED_FUNCTION branch_search::branch_search(const loop_equation& loop) {
  search(loop);
  const bool is_certain = answer_.solutions.empty() && is_beyond_reach(loop),
             is_general = method_ == solution_method::elimination || // search near the goal, too
                          method_ == solution_method::two_prismatic;
  if (answer_.solutions.empty() && !is_certain && !is_general) {
    search_near_goal(loop);
  }
  // `two_prismatic` detects permanent self-motion itself.
  if (method_ != solution_method::two_prismatic) {
    answer_.is_complete = is_certain || (answer_.is_complete && !is_always_singular(loop));
  }
}

/// Searches for solutions with slightly displaced goals: round-off may have made a double solution
/// complex, and with a nearby goal it is complex or two real ones.
inline void branch_search::search_near_goal(const loop_equation& loop) {
  constexpr int attempts = 6;
  constexpr double displacement = 1e-7;
  for (int k = 0; k < attempts && answer_.solutions.empty(); ++k) {
    branch_search nearby;
    nearby.search(with_disturbed_goal(loop, displacement, std::uint64_t(k) + 1));
    for (loop_solution x : nearby.answer_.solutions) {
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
  const auto prismatic_count = std::count_if(joints.begin(), joints.end(),
                                             [](const loop_joint& j) { return !j.is_revolute; });
  if (prismatic_count == 3) {
    solve<three_prismatic_loop>(solution_method::three_prismatic, 0, loop);
    return;
  }
  if (prismatic_count == 2) {
    const auto pair = parallel_prismatic_of(loop);
    answer_ = pair ? solve_parallel_prismatic(*pair) : solve_general_loop<two_prismatic>(loop);
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
  for (std::size_t i = 0; i < 4 && prismatic_count == 0; ++i) {
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
