// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/robotics/all_inverse_kinematics.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

/// \file
/// All solutions of six joints for a pose that are within the limits, except for full turns.

namespace duet::detail {

/// True if the chain has n joints whose equations are algebraic, as `all_inverse_kinematics` and
/// `self_motion_curves` require.
template <class C>
[[nodiscard]] bool is_algebraic(const C& chain, int n) {
  int prismatic_count = 0;
  for (int i = 0; i < chain.size(); ++i) {
    if (chain.kind(i) == joint_kind::helical) {
      return false;
    }
    prismatic_count += chain.kind(i) == joint_kind::prismatic;
  }
  return chain.size() == n && prismatic_count <= (n == 6 ? 3 : 1);
}

/// Solutions of inverse kinematics, and whether there are no others.
template <int N>
struct solution_list {
  std::vector<joint_vector<double, N>> joints;
  bool is_complete = false;
};

/// Solutions of `all_inverse_kinematics` within the limits, revolute joints moved into them by full
/// turns. Joints that miss a limit by no more than the tolerance are clamped to it.
template <class C>
[[nodiscard]] solution_list<C::joints> solutions_within_limits(const C& chain,
                                                               const dual_quaternion<double>& goal,
                                                               const pose_tolerance& tolerance) {
  constexpr double full_turn = 2 * std::numbers::pi;
  const auto all = all_inverse_kinematics(chain, goal);
  solution_list<C::joints> result{{}, all.is_complete};
  for (const auto& each : all.solutions) {
    auto theta = each.joints;
    bool is_within = true;
    for (int i = 0; i < chain.size(); ++i) {
      const bool is_prismatic = chain.kind(i) == joint_kind::prismatic;
      const double slack = is_prismatic ? tolerance.translation : tolerance.rotation;
      const double lower = chain.limits(i).lower - slack, upper = chain.limits(i).upper + slack;
      if (!is_prismatic && theta[i] < lower) {
        theta[i] += full_turn * std::ceil((lower - theta[i]) / full_turn);
      } else if (!is_prismatic && theta[i] > upper) {
        theta[i] -= full_turn * std::ceil((theta[i] - upper) / full_turn);
      }
      is_within = is_within && theta[i] >= lower && theta[i] <= upper;
      theta[i] = std::clamp(theta[i], chain.limits(i).lower, chain.limits(i).upper);
    }
    if (is_within) {
      result.joints.push_back(theta);
    }
  }
  return result;
}

} // namespace duet::detail
