// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>

#include <sstream>

/// \file
/// Settings of planners.

namespace duet {

/// Settings of `follow_path` and `plan_screw_motion`. Steps along the path are fractions of it.
struct plan_options {
  /// How close waypoints come to the path, in units of length and radians.
  double tolerance = 1e-6;
  /// How far the tip may be from it where joints move straight on between waypoints.
  double deviation = 1e-5;
  /// From one waypoint to the next.
  double largest_step = .1;
  /// Below it there is no going on without moving in place.
  double smallest_step = 1e-6;
  /// How fast joints move away from their limits where that leaves the tip in place, in coordinates
  /// per path.
  double centring = 1;
  /// Between the places where the tip may stop for the joints to move in place; 0: nowhere.
  double search_step = .02;
  /// How far the joints then move from one configuration to the next, in coordinates.
  double self_motion_step = .1;
  /// Of Newton's method, in all.
  int iterations = 1000000;
};

namespace detail {

/// \throws invalid_input
inline void require_option(bool holds, const char* caller, const char* name, double value,
                           const char* range) {
  if (!holds) {
    std::ostringstream message;
    message << "duet: " << caller << ": " << name << " is " << value << ", not " << range;
    throw invalid_input(message.str());
  }
}
/// \throws invalid_input
inline void require_positive_option(const char* caller, const char* name, double value) {
  require_option(value > 0 && value - value == 0, caller, name, value, "a number above 0");
}

/// \throws invalid_input
inline void require_options(const plan_options& options) {
  constexpr const char* caller = "plan";
  require_positive_option(caller, "tolerance", options.tolerance);
  require_positive_option(caller, "deviation", options.deviation);
  require_positive_option(caller, "largest_step", options.largest_step);
  require_positive_option(caller, "smallest_step", options.smallest_step);
  require_positive_option(caller, "self_motion_step", options.self_motion_step);
  require_option(options.centring >= 0 && options.centring - options.centring == 0, caller,
                 "centring", options.centring, "a number from 0 up");
  require_option(options.search_step == 0 ||
                     (options.search_step >= 1e-6 && options.search_step <= 1),
                 caller, "search_step", options.search_step, "0 or from 1e-6 to 1");
}

} // namespace detail
} // namespace duet
