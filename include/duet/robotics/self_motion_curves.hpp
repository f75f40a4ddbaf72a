// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/refused.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/robotics/branches/chain_loop.hpp>
#include <duet/robotics/branches/loop_equation.hpp>
#include <duet/robotics/branches/redundant_arm.hpp>
#include <duet/robotics/planning_model.hpp>

#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// Self-motion of redundant arms of seven joints: all configurations for a pose, as curves.

namespace duet {

/// Options of `self_motion_curves`.
struct self_motion_options {
  /// Maximum distance from one point of a curve to the next, and between the values at which each
  /// joint is fixed in the search for curves: radians, or lengths relative to the arm's size.
  double resolution = .1;
};

/// Self-motion: a curve of joint coordinates on which the tip stays at its pose; at singular poses
/// also a component of another dimension, given by `dimension`.
///
/// \tparam N  as in `serial_chain`
template <int N>
struct self_motion_curve {
  /// Configurations one after the other, without jumps of full turns; a sample in no order if
  /// `dimension` is not 1.
  std::vector<detail::joint_vector<double, N>> joints;
  /// True if the last point leads to the first, except for full turns. Otherwise the curve ends at
  /// singularities.
  bool is_closed = false;
  /// Dimension of the component. 1: a curve. 0: an isolated configuration, the only one in
  /// `joints`. 2 or more: a surface or more, of which `joints` is a sample, up to 64 configurations
  /// far from each other.
  int dimension = 1;

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("joints", joints);
    f("is_closed", is_closed);
    f("dimension", dimension);
  }
};

namespace detail {

/// \throws invalid_input for a chain that does not have seven joints, all revolute or one prismatic
template <class C>
void require_seven_joints(const C& chain) {
  require(chain.size() == 7, "duet: self_motion_curves: the chain has ", chain.size(),
          " moving joints (expected 7)");
  int prismatic_count = 0;
  for (int i = 0; i < chain.size(); ++i) {
    require(chain.kind(i) != joint_kind::helical, "duet: self_motion_curves: joint ", i,
            " is helical (expected revolute or prismatic)");
    prismatic_count += chain.kind(i) == joint_kind::prismatic;
  }
  require(prismatic_count <= 1, "duet: self_motion_curves: the chain has ", prismatic_count,
          " prismatic joints (expected at most 1)");
}

/// Chain and goal as the search uses them; refers to the chain.
template <class C>
[[nodiscard]] redundant_arm seven_joints_of(const C& chain, const tip_pose& goal) {
  using joints = joint_vector<double, C::joints>;
  const chain_model<C> model(chain);
  redundant_arm result;
  result.size = model.length;
  result.goal = goal;
  for (std::size_t i = 0; i < 7; ++i) {
    result.is_revolute[i] = model.is_rotational[i];
  }
  result.tip_error = [model,
                      scaled_goal = tip_pose{goal.rotation, 1 / model.length * goal.translation}](
                         const seven_coordinates& x, seven_columns& jacobian) {
    const auto state = model.at(model.joints(x));
    const small_twist e = error_twist(state.tip, scaled_goal);
    six_coordinates error;
    for (int k = 0; k < 6; ++k) {
      error[k] = e[k];
      for (int i = 0; i < 7; ++i) {
        jacobian(k, i) = state.jacobian(k, i);
      }
    }
    return error;
  };
  result.axes_without = [&chain](int fixed, double value) {
    joints theta = joints::Zero(chain.size());
    theta[fixed] = value;
    return chain_screws(chain, theta, fixed);
  };
  return result;
}

} // namespace detail

/// All self-motions of a redundant arm of seven joints: curves of joint coordinates on which it
/// holds its tip at the pose `goal`, within limits or not, and at singular poses the components of
/// other dimensions.
///
/// Each revolute joint is fixed at values at intervals of `resolution`, where
/// `all_inverse_kinematics` solves for the other six. From these solutions the curves are traced by
/// predictor–corrector continuation: steps along the null space of the Jacobian and projections by
/// the Levenberg–Marquardt method. Curves that cross are continued smoothly through the crossing
/// and are separate elements. A component on which every joint moves less than `resolution` may be
/// missed.
///
/// At a singular pose, as with a straight elbow, wrist or shoulder, solutions from 256 random
/// configurations are added. The dimension at a solution is that of the span of the solutions near
/// it. Curves on which the Jacobian is singular everywhere are followed like the others; there
/// joint coordinates have half of the digits. A component of two or more dimensions is one element
/// with that `dimension` and a sample of it.
///
/// \param chain  seven joints, all revolute or one of them prismatic
/// \return a vector of `self_motion_curve`
/// \throws invalid_input for other chains, a goal that is not a pose, and a resolution outside (0,
/// 1]
template <SerialChain C>
[[nodiscard]] std::vector<self_motion_curve<C::joints>>
self_motion_curves(const C& chain, const dual_quaternion<double>& goal,
                   const self_motion_options& options = {}) {
  detail::require_seven_joints(chain);
  detail::require_pose(goal, "self_motion_curves", "the goal");
  detail::require_option("self_motion_curves", "resolution", options.resolution,
                         options.resolution > 0 && options.resolution <= 1, "within (0, 1]");
  const auto arm = detail::seven_joints_of(chain, detail::to_tip_pose(normalized(goal)));
  std::vector<self_motion_curve<C::joints>> result;
  for (const detail::traced_curve& curve : detail::all_curves(arm, options.resolution)) {
    self_motion_curve<C::joints> configurations;
    configurations.is_closed = curve.is_closed;
    configurations.dimension = curve.dimension;
    for (const auto& x : curve.points) {
      configurations.joints.push_back(detail::to_chain_joints(chain, x));
    }
    result.push_back(std::move(configurations));
  }
  return result;
}

DUET_ASKS_FOR_ONE_CONFIGURATION(self_motion_curves, std::vector<self_motion_curve<C::joints>>)

} // namespace duet
