// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/planning/bounded_step.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/planning_model.hpp>
#include <duet/planning/small_vector.hpp>

#include <array>

/// \file
/// What goals are for the search for joint coordinates: linear equations at each configuration.

namespace duet::detail {

/// What is left to do at some θ: J Δ = e.
template <int Room>
struct goal_equations {
  chain_state<Room> at;
  small_twist e;
  pose_deviation left;
  std::array<bool, 6> is_free{}; ///< of the six equations, those that there are none of
};

/// What a pose asks for: all that the tip can do.
template <int Room>
void set_equations(goal_equations<Room>& x, const tip_place& goal) {
  x.e = error_twist(x.at.tip, goal);
  x.left = {length_of(goal.translation - x.at.tip.translation), deviation_of(x.e).angle};
}
/// Is it certain that a pose is out of reach?
[[nodiscard]] inline bool is_beyond(const chain_reach& reach, const tip_place& goal,
                                    const pose_tolerance& tolerance) {
  return reach.is_beyond(goal, tolerance);
}

} // namespace duet::detail
