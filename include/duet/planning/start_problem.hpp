// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/mechanism/serial_chain.hpp>
#include <duet/planning/clearance.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/path_step.hpp>

#include <functional>
#include <limits>
#include <optional>

/// \file
/// What `choose_start` is told, and what it returns.

namespace duet {

/// Settings of `choose_start`.
struct start_options {
  /// How paths are followed.
  plan_options plan = {};
  /// How many starts are tried at most.
  int starts = 64;
  /// From one configuration to the next at most, where seven joints move with the tip in place.
  double resolution = .3;
  /// From one pose to the next where poses without a solution are looked for, a fraction of the
  /// path.
  double sampling = .01;
};

/// What `choose_start` found.
///
/// \tparam N  as of `serial_chain`
template <int N>
struct start_choice {
  /// Along the path from the start that was chosen, `plan.joints.front()`; where none leads to its
  /// end, the one that comes farthest. Empty where no start has a solution.
  motion_plan<N> plan;
  int starts = 0; ///< how many were tried
  /// Where no start leads to the end: the first parameter, to 1e-6 of the path, at which no joint
  /// coordinates were found; nothing where all poses that were looked at have some.
  std::optional<double> unsolved;
  /// `reached`; else what is in the way there: at `unsolved`, or else of `plan`.
  stop_reason reason = stop_reason::no_solution;
  /// Is it certain that there is no solution at `unsolved`? Of six joints all are known.
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

/// What the search sees of a chain and a path, whatever their types.
template <int Room>
struct start_problem {
  using joints = joint_vector<double, -Room>;

  serial_chain<-Room> chain;
  const scene* around; ///< or nothing
  const path_function& path;
  double first, last;
  const start_options& options;
  std::function<motion_plan<-Room>(const joints&, const plan_options&)> follow;
  std::function<double(const joints&)> objective; ///< or nothing
};

} // namespace detail
} // namespace duet
