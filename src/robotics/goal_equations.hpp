// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "planning_model.hpp"
#include "small_vector.hpp"
#include "tip_pose.hpp"

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/robotics/goals.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

/// \file
/// Goals as linear equations at each configuration, for the search for joint coordinates.

namespace duet::detail {
DUET_ABI_BEGIN

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

/// Goal with lengths in the planner's unit.
struct scaled_goal {
  goal_view goal; ///< in the user's unit
  double length;  ///< the planner's unit of length

  [[nodiscard]] twist_constraint constraint(const tip_pose& tip) const {
    twist_constraint x =
        goal.constraint(to_dual_quaternion({tip.rotation, length * tip.translation}));
    x.lower.head<3>() /= length;
    x.upper.head<3>() /= length;
    x.matrix.topRightCorner<3, 3>() /= length;
    x.matrix.bottomLeftCorner<3, 3>() *= length;
    return x;
  }
  [[nodiscard]] double distance_from(const three_vector<double>& point) const {
    const three_vector<double> unscaled_point = length * point;
    return goal.distance_from(unscaled_point.eigen()) / length;
  }
};

/// Full pose as a goal.
struct full_pose_goal {
  tip_pose target;

  [[nodiscard]] twist_constraint constraint(const dual_quaternion<double>& tip) const {
    twist_constraint result;
    const small_twist e = error_twist(to_tip_pose(tip), target);
    result.matrix.setIdentity();
    for (std::ptrdiff_t i = 0; i < 6; ++i) {
      result.lower[i] = e[i];
    }
    result.upper = result.lower;
    return result;
  }
  [[nodiscard]] double distance_from(const vector3<double>& point) const {
    return length_of(target.translation - components(point));
  }
};

/// Residual twist: the part of a constraint that is not satisfied yet, and its size.
struct residual_twist {
  small_twist e;
  pose_error residual;

  explicit residual_twist(const twist_constraint& constraint) {
    for (std::ptrdiff_t i = 0; i < 6; ++i) {
      e[i] = std::max(constraint.lower[i], std::min(constraint.upper[i], 0.0));
    }
    residual = deviation_of(e);
  }
};

/// Row of M J, J in `frame::hybrid`.
template <int Capacity>
[[nodiscard]] small_vector<Capacity> goal_row(const twist_constraint& constraint,
                                              std::ptrdiff_t row,
                                              const small_matrix<6, Capacity>& jacobian) {
  small_vector<Capacity> result;
  for (std::ptrdiff_t k = 0; k < jacobian.cols(); ++k) {
    for (std::ptrdiff_t i = 0; i < 6; ++i) {
      result[k] += constraint.matrix(row, i) * jacobian(i, k);
    }
  }
  return result;
}

/// Sets the equations M J Δ = e of a goal; rows within their bounds impose no equation.
template <int Capacity>
void set_equations(goal_equations<Capacity>& x, const scaled_goal& goal) {
  const twist_constraint constraint = goal.constraint(x.at.tip);
  const residual_twist unsatisfied(constraint);
  x.e = unsatisfied.e;
  x.residual = unsatisfied.residual;
  const small_matrix<6, Capacity> jacobian = x.at.jacobian;
  for (std::ptrdiff_t i = 0; i < 6; ++i) {
    const bool is_equation =
        constraint.lower[i] == constraint.upper[i] && !constraint.matrix.row(i).isZero(0);
    x.is_free[std::size_t(i)] = x.e[i] == 0 && !is_equation;
    const auto row =
        x.is_free[std::size_t(i)] ? small_vector<Capacity>{} : goal_row(constraint, i, jacobian);
    for (std::ptrdiff_t k = 0; k < jacobian.cols(); ++k) {
      x.at.jacobian(i, k) = row[k];
    }
  }
}

/// True if a goal is certainly out of reach: the tip is never farther from the first joint than the
/// lengths of links, prismatic joints and tool together.
[[nodiscard]] inline bool is_beyond(const chain_reach& reach, const scaled_goal& goal,
                                    const pose_tolerance& tolerance) {
  const double max_distance = (reach.links + reach.travel + reach.tool) * (1 + 1e-12);
  return reach.has_joints && goal.distance_from(reach.first) > max_distance + tolerance.translation;
}

DUET_ABI_END
} // namespace duet::detail
