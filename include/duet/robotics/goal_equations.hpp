// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/kinematics/motion_plan.hpp>
#include <duet/robotics/bounded_step.hpp>
#include <duet/robotics/planning_model.hpp>
#include <duet/robotics/small_vector.hpp>

#include <array>

/// \file
/// Goals as linear equations at each configuration, for the search for joint coordinates.

namespace duet::detail {

/// Equations J Δ = e of a goal at some θ.
template <int Capacity>
struct goal_equations {
  chain_state<Capacity> at;
  small_twist e;
  pose_error residual;
  std::array<bool, 6> is_free{}; ///< true for each of the six rows without an equation
};

/// Sets the equations of a pose: all six components of the twist.
template <int Capacity>
void set_equations(goal_equations<Capacity>& x, const tip_pose& goal) {
  x.e = error_twist(x.at.tip, goal);
  x.residual = {length_of(goal.translation - x.at.tip.translation), deviation_of(x.e).rotation};
}
/// True if a pose is certainly out of reach.
[[nodiscard]] inline bool is_beyond(const chain_reach& reach, const tip_pose& goal,
                                    const pose_tolerance& tolerance) {
  return reach.is_beyond(goal, tolerance);
}

} // namespace duet::detail
