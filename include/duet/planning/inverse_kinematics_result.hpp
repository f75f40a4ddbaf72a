// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/zero_initialized.hpp>
#include <duet/mechanism/serial_chain.hpp>
#include <duet/planning/motion_plan.hpp>

#include <cstdint>

/// \file
/// What `inverse_kinematics` is told, and what it returns.

namespace duet {

/// Settings of `inverse_kinematics`.
struct inverse_kinematics_options {
  /// How close the tip comes to the goal.
  pose_tolerance tolerance = 1e-6;
  /// How many random configurations to begin anew from once the given start has led nowhere.
  int restarts = 100;
  /// The most from each of them.
  int iterations = 50;
  /// Of the random configurations.
  std::uint64_t seed = 1;
  /// From how many solutions on an objective is lowered, of which the best is returned.
  int candidates = 10;
};

/// What was found; where `reason` is not `reached`, the nearest to the goal that was met with.
///
/// \tparam N  as of `serial_chain`
template <int N>
struct inverse_kinematics_result {
  /// Within the limits.
  detail::joint_vector<double, N> joints =
      detail::zero_initialized<detail::joint_vector<double, N>>();
  pose_deviation deviation; ///< of the tip from the goal
  int iterations = 0;       ///< from all configurations together
  int restarts = 0;         ///< how many random configurations it began anew from
  /// Why it ended: `reached` where the tip is at the goal, else what is in the way.
  stop_reason reason = stop_reason::no_progress;

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("joints", joints);
    f("deviation", deviation);
    f("iterations", iterations);
    f("restarts", restarts);
    f("reason", reason);
  }
};

namespace detail {

/// \throws invalid_input
inline void require_options(const inverse_kinematics_options& options) {
  constexpr const char* caller = "inverse_kinematics";
  require_positive(caller, "tolerance", options.tolerance);
  require_positive(caller, "iterations", options.iterations);
  require_option(caller, "restarts", options.restarts, options.restarts >= 0, "a number from 0 up");
  require_positive(caller, "candidates", options.candidates);
}

} // namespace detail
} // namespace duet
