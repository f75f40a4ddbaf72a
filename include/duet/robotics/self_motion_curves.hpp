// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/chain_view.hpp>
#include <duet/kinematics/serial_chain.hpp>

#include <Eigen/Core>

#include <vector>

/// \file
/// Self-motion of redundant arms of seven joints: all configurations for a pose, as curves.

namespace duet {
DUET_ABI_BEGIN

/// Options of `self_motion_curves`.
struct self_motion_options {
  /// Maximum distance from one point of a curve to the next, and between the values at which each
  /// joint is fixed in the search for curves: radians, or lengths relative to the arm's size.
  double resolution = .1;
};

/// Self-motion: a curve of joint coordinates on which the tip stays at its pose; at singular poses
/// also a component of another dimension, given by `dimension`.
struct self_motion_curve {
  /// Configurations one after the other, without jumps of full turns; a sample in no order if
  /// `dimension` is not 1.
  std::vector<Eigen::VectorXd> joints;
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
[[nodiscard]] std::vector<self_motion_curve>
self_motion_curves(const chain_view& chain, const dual_quaternion<double>& goal,
                   const self_motion_options& options = {});

DUET_ASKS_FOR_ONE_CONFIGURATION(self_motion_curves, std::vector<self_motion_curve>)

DUET_ABI_END
} // namespace duet
