// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/robotics/goal_equations.hpp>
#include <duet/robotics/inverse_kinematics_search.hpp>
#include <duet/robotics/planning_model.hpp>
#include <duet/robotics/pose_region.hpp>
#include <duet/robotics/small_vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

/// \file
/// Type-erased goals of the inverse kinematics search, which is compiled once for all of them.

namespace duet::detail {

/// Interface of a goal for the search, with lengths in the planner's unit.
class tip_goal {
public:
  virtual ~tip_goal() = default;
  [[nodiscard]] virtual twist_constraint constraint(const tip_pose& tip) const = 0;
  [[nodiscard]] virtual double distance_from(const three_vector<double>&) const { return 0; }
};

/// Goal of the type G, which uses the user's unit of length.
template <TipGoal G>
class tip_goal_of final : public tip_goal {
public:
  /// \param length  the planner's unit of length
  tip_goal_of(const G& goal, double length) : goal_(goal), length_(length) {}
  [[nodiscard]] twist_constraint constraint(const tip_pose& tip) const override {
    twist_constraint x =
        goal_.constraint(to_dual_quaternion({tip.rotation, length_ * tip.translation}));
    x.lower.head<3>() /= length_;
    x.upper.head<3>() /= length_;
    x.matrix.topRightCorner<3, 3>() /= length_;
    x.matrix.bottomLeftCorner<3, 3>() *= length_;
    return x;
  }
  [[nodiscard]] double distance_from(const three_vector<double>& point) const override {
    if constexpr (requires { goal_.distance_from(point.eigen()); }) {
      const three_vector<double> unscaled_point = length_ * point;
      return goal_.distance_from(unscaled_point.eigen()) / length_;
    } else {
      return 0;
    }
  }

private:
  const G& goal_;
  double length_;
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
void set_equations(goal_equations<Capacity>& x, const tip_goal& goal) {
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
[[nodiscard]] inline bool is_beyond(const chain_reach& reach, const tip_goal& goal,
                                    const pose_tolerance& tolerance) {
  const double max_distance = (reach.links + reach.travel + reach.tool) * (1 + 1e-12);
  return reach.has_joints && goal.distance_from(reach.first) > max_distance + tolerance.translation;
}

#ifdef DUET_COMPILED
DUET_COMPILED_TEMPLATE class inverse_kinematics_search<8, tip_goal>;
DUET_COMPILED_TEMPLATE class inverse_kinematics_search<16, tip_goal>;
#endif

} // namespace duet::detail
