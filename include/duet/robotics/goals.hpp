// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <Eigen/Core>

#include <array>
#include <concepts>
#include <functional>
#include <string>
#include <type_traits>

/// \file
/// Partial goals of `inverse_kinematics`: positions, directions, task space regions, equations.

namespace duet {
DUET_ABI_BEGIN

/// Constraint on the twist of a tip at a given pose: the twists ξ = [v; ω], in `frame::hybrid`,
/// that take the tip to the goal to first order satisfy lower ≤ M ξ ≤ upper. The first three rows
/// are lengths, the others radians; rows that are zero impose nothing.
struct twist_constraint {
  Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero(); ///< constraint matrix M
  vector6<double> lower = vector6<double>::Zero(); ///< lower bounds of M ξ; −∞ for none
  vector6<double> upper = vector6<double>::Zero(); ///< upper bounds; equal to `lower` in equations
};

/// Requirements of a goal of `inverse_kinematics`: `constraint(tip)` returns the constraint on the
/// twist that takes the tip from a pose to the goal.
///
/// An optional member `distance_from(point)` returns a lower bound of the distance of any tip at
/// the goal from a point of the base frame, which proves that goals are out of reach.
template <class G>
concept TipGoal = requires(const G& goal, const dual_quaternion<double>& tip) {
  { goal.constraint(tip) } -> std::same_as<twist_constraint>;
};

/// Task space region: bounds on the position and rotation of the tip, a partial goal.
///
/// The origin of the tip lies between `lower` and `upper` in `frame`. The rotation R of the tip in
/// that frame is a rotation about `axis` by an angle between `rotation_lower` and `rotation_upper`,
/// followed by a rotation of at most `max_tilt` about an axis orthogonal to it. The axis, carried
/// along by the tip, thus lies within a cone of half-angle `max_tilt` about its direction in
/// `frame`. (Task space regions as in Berenson, Srinivasa, Kuffner, Task space regions, 2011, whose
/// ranges of roll, pitch and yaw depend on the order of rotations.) Use `with_tool` for other
/// points and axes of the tip.
struct task_space_region {
  dual_quaternion<double> frame;           ///< pose of the region in the base frame
  std::array<double, 3> lower = {0, 0, 0}; ///< lower corner of the box in `frame`; may be −∞
  std::array<double, 3> upper = {0, 0, 0}; ///< upper corner of the box in `frame`; may be ∞
  std::array<double, 3> axis = {0, 0, 1};  ///< unit vector in the tip frame and in `frame`
  double max_tilt = 0;                     ///< maximum tilt of the axis, radians; π for any
  double rotation_lower = 0;               ///< minimum rotation angle about the axis, radians
  double rotation_upper = 0;               ///< maximum rotation angle; 2π more is any, radians

  /// For those who extend duet: required by `TipGoal`.
  [[nodiscard]] twist_constraint constraint(const dual_quaternion<double>& tip) const;
  /// For those who extend duet: optional for `TipGoal`.
  [[nodiscard]] double distance_from(const vector3<double>& point) const;
};

/// Goal for the origin of the tip at a position in the base frame, with any rotation.
[[nodiscard]] task_space_region position_goal(const vector3<double>& position);

/// Goal for a pose up to rotations about an axis of the tip, a unit vector in its frame.
[[nodiscard]] task_space_region free_axis_goal(const dual_quaternion<double>& a,
                                               const vector3<double>& axis);

/// Goal for a pose within a tolerance: success for arms with fewer than six joints, which reach
/// most poses only approximately. The region is the largest box of equal sides and equal ranges of
/// angles inside the tolerance: sides 2 translation/√3; tilts and rotations about z up to
/// rotation/√2.
///
/// \throws invalid_input for a tolerance that is negative or not finite
[[nodiscard]] task_space_region pose_goal(const dual_quaternion<double>& a,
                                          const pose_tolerance& tolerance);

/// Goal for the direction of an axis of the tip, a unit vector in its frame, along a unit vector in
/// the base frame; the position is free.
///
/// \param tilt  maximum angle between the axis and the direction, radians
/// \throws invalid_input for vectors that are not unit vectors
[[nodiscard]] task_space_region pointing_goal(const vector3<double>& axis,
                                              const vector3<double>& direction, double tilt = 0);

/// Goal for the position of the tip's origin and for the direction of an axis of the tip.
///
/// \param tilt  maximum angle between the axis and the direction, radians
/// \throws invalid_input for vectors that are not unit vectors
[[nodiscard]] task_space_region position_and_pointing_goal(const vector3<double>& position,
                                                           const vector3<double>& axis,
                                                           const vector3<double>& direction,
                                                           double tilt = 0);

/// Goal f(A) = 0 for the pose A of the tip, up to six equations, which dual numbers differentiate.
///
/// \tparam F  A ↦ six numbers, an Eigen vector or an array: three lengths, then three angles in
/// radians, zeros for fewer equations. Generic over the scalars of A
///
/// Example: a tip a metre from the origin, `equation_goal{[]<class S>(const dual_quaternion<S>& a)
/// { return std::array<S, 6>{translation(a).norm() - 1}; }}`
template <class F>
struct equation_goal {
  F equations; ///< f

  /// For those who extend duet: required by `TipGoal`.
  [[nodiscard]] twist_constraint constraint(const dual_quaternion<double>& tip) const {
    const quaternion<double> r = rotation(tip);
    const vector3<double> t = translation(tip);
    const auto moved = [&](const auto& twist) {
      using S = std::decay_t<decltype(twist[0])>;
      const vector3<S> half(twist[3] / 2, twist[4] / 2, twist[5] / 2);
      const vector3<S> at(t[0] + twist[0], t[1] + twist[1], t[2] + twist[2]);
      return equations(pose(exp(half) * r, at));
    };
    const auto linearised = jacobian(moved, vector6<double>(vector6<double>::Zero()));
    twist_constraint result;
    result.matrix = linearised.jacobian;
    for (int i = 0; i < 6; ++i) {
      result.lower[i] = result.upper[i] = -linearised.value[i];
    }
    return result;
  }
};
template <class F>
equation_goal(F) -> equation_goal<F>;

DUET_ABI_END
namespace detail {
DUET_ABI_BEGIN

/// \throws invalid_input for a region that contains no pose
void require_goal(const task_space_region& region, const std::string& name);

/// View of a goal of any type: a pose, or a goal with a constraint of its own.
struct goal_view {
  const dual_quaternion<double>* pose = nullptr; ///< null for other goals
  std::function<twist_constraint(const dual_quaternion<double>&)> constraint;
  /// Lower bound of the distance of tips at the goal from a point; empty if the goal has none.
  std::function<double(const vector3<double>&)> distance_from;
  /// Throws invalid_input for what is not a pose and for a region that contains no pose; empty for
  /// other goals.
  std::function<void(const std::string& name)> check;

  goal_view(const dual_quaternion<double>& goal);
  template <TipGoal G>
  goal_view(const G& goal) : constraint([&goal](const auto& tip) { return goal.constraint(tip); }) {
    if constexpr (requires(const vector3<double>& point) { goal.distance_from(point); }) {
      distance_from = [&goal](const auto& point) { return double(goal.distance_from(point)); };
    }
    if constexpr (std::convertible_to<const G&, const task_space_region&>) {
      check = [&goal](const std::string& name) { require_goal(goal, name); };
    }
  }
};

DUET_ABI_END
} // namespace detail
} // namespace duet
