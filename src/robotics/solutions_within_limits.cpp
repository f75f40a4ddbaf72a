// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "solutions_within_limits.hpp"
#include <duet/robotics/all_inverse_kinematics.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace duet::detail {
DUET_ABI_BEGIN

double wrap_into_limits(double theta, const joint_limits<double>& limits) {
  constexpr double full_turn = 2 * std::numbers::pi;
  for (const double x : {theta, theta + full_turn, theta - full_turn}) {
    if (x >= limits.lower && x <= limits.upper) {
      return x;
    }
  }
  return theta;
}

bool is_algebraic(const chain_view& chain, int n) {
  int prismatic_count = 0;
  for (int i = 0; i < chain.size(); ++i) {
    if (chain.kind(i) == joint_kind::helical) {
      return false;
    }
    prismatic_count += chain.kind(i) == joint_kind::prismatic;
  }
  return chain.size() == n && prismatic_count <= (n == 6 ? 3 : 1);
}

solution_list solutions_within_limits(const chain_view& chain, const dual_quaternion<double>& goal,
                                      const pose_tolerance& tolerance) {
  constexpr double full_turn = 2 * std::numbers::pi;
  const auto all = all_inverse_kinematics(chain, goal);
  solution_list result{{}, all.is_complete};
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

DUET_ABI_END
} // namespace duet::detail
