// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/robotics/clearance.hpp>
#include <duet/robotics/path_step.hpp>

#include <functional>
#include <limits>
#include <optional>

/// \file
/// Options and result of `find_start_configuration`.

namespace duet {

/// Options of `find_start_configuration`.
struct start_options {
  /// Options of the planner that follows paths.
  plan_options plan = {};
  /// Maximum number of starts that are tried.
  int max_starts = 64;
  /// Maximum distance from one configuration to the next on self-motion curves of seven joints, as
  /// `self_motion_options::resolution`.
  double resolution = .3;
  /// Distance between the poses that are checked for a solution, a fraction of the path.
  double sampling = .01;
};

/// Result of `find_start_configuration`.
///
/// \tparam N  as in `serial_chain`
template <int N>
struct start_search_result {
  /// Plan from the start configuration that was found, `plan.joints.front()`; if none leads to the
  /// end of the path, the one that comes farthest. Empty if no start has a solution.
  motion_plan<N> plan;
  int starts = 0; ///< number of starts tried
  /// First parameter, to 1e-6 of the path, at which no joint coordinates were found, if no start
  /// leads to the end; nothing if all poses that were checked have some.
  std::optional<double> unsolved;
  /// Termination reason: `reached`; else what blocks the path at `unsolved`, or else that of
  /// `plan`.
  stop_reason reason = stop_reason::no_solution;
  /// True if certainly there is no solution at `unsolved`. Of six joints all are known.
  bool is_certain = false;

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("plan", plan);
    f("starts", starts);
    f("unsolved", unsolved.value_or(std::numeric_limits<double>::quiet_NaN()));
    f("reason", reason);
    f("is_certain", is_certain);
  }
};

namespace detail {

/// Chain and path as the search uses them, independent of their types.
template <int Capacity>
struct start_problem {
  using joints = joint_vector<double, -Capacity>;

  serial_chain<-Capacity> chain;
  const scene* around; ///< or null
  const path_function& path;
  double first, last;
  const start_options& options;
  std::function<motion_plan<-Capacity>(const joints&, const plan_options&)> follow;
  std::function<double(const joints&)> objective; ///< or empty
};

} // namespace detail
} // namespace duet
