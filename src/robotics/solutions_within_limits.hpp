// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/chain_view.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/motion_plan.hpp>

#include <Eigen/Core>

#include <vector>

/// \file
/// All solutions of six joints for a pose that are within the limits, except for full turns. For
/// those who extend duet.

namespace duet::detail {
DUET_ABI_BEGIN

/// θ moved by a full turn into the limits, if that is possible.
[[nodiscard]] double wrap_into_limits(double theta, const joint_limits<double>& limits);

/// True if the chain has n joints whose equations are algebraic, as `all_inverse_kinematics` and
/// `self_motion_curves` require.
[[nodiscard]] bool is_algebraic(const chain_view& chain, int n);

/// Solutions of inverse kinematics, and whether there are no others.
struct solution_list {
  std::vector<Eigen::VectorXd> joints;
  bool is_complete = false;
};

/// Solutions of `all_inverse_kinematics` within the limits, revolute joints moved into them by full
/// turns. Joints that miss a limit by no more than the tolerance are clamped to it.
[[nodiscard]] solution_list solutions_within_limits(const chain_view& chain,
                                                    const dual_quaternion<double>& goal,
                                                    const pose_tolerance& tolerance);

DUET_ABI_END
} // namespace duet::detail
