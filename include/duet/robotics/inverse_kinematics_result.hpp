// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/zero_initialized.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/serial_chain.hpp>

#include <cstdint>

/// \file
/// Options and result of `inverse_kinematics`.

namespace duet {

/// Options of `inverse_kinematics`.
struct inverse_kinematics_options {
  /// Maximum error of the tip pose relative to the goal: units of length, and radians.
  pose_tolerance tolerance = 1e-6;
  /// Maximum number of random restarts if the search does not converge from the given start.
  int max_restarts = 100;
  /// Maximum number of iterations per attempt.
  int max_iterations = 50;
  /// Seed of the random configurations.
  std::uint64_t seed = 1;
  /// Number of solutions from which an objective is minimised; the best result is returned.
  int candidates = 10;
};

/// Result of `inverse_kinematics`; unless `reason` is `reached`, the configuration nearest to the
/// goal that was found.
///
/// \tparam N  as in `serial_chain`
template <int N>
struct inverse_kinematics_result {
  /// Joint coordinates within the limits: radians, or units of length for prismatic joints.
  detail::joint_vector<double, N> joints =
      detail::zero_initialized<detail::joint_vector<double, N>>();
  pose_error deviation; ///< error of the tip pose relative to the goal
  int iterations = 0;   ///< number of iterations of all attempts together
  int restarts = 0;     ///< number of random restarts
  /// Termination reason: `reached` if the tip is at the goal, otherwise what blocks the search.
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
  require_positive(caller, "max_iterations", options.max_iterations);
  require_option(caller, "max_restarts", options.max_restarts, options.max_restarts >= 0,
                 "a non-negative number");
  require_positive(caller, "candidates", options.candidates);
}

} // namespace detail
} // namespace duet
