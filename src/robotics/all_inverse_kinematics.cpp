// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "branches/chain_loop.hpp"
#include "branches/loop_equation.hpp"
#include "branches/singular_value.hpp"

#include <duet/core/batch/math.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/robotics/all_inverse_kinematics.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

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
  int prismatic_count = 0, helical_count = 0;
  for (int i = 0; i < chain.size(); ++i) {
    prismatic_count += chain.kind(i) == joint_kind::prismatic;
    helical_count += chain.kind(i) == joint_kind::helical;
  }
  return chain.size() == n && helical_count == 0 && prismatic_count <= (n == 6 ? 3 : 1);
}

void require_algebraic(const chain_view& chain, int n, const char* function) {
  require(chain.size() == n, "duet: ", function, ": the chain has ", chain.size(),
          " moving joints (expected ", n, ")");
  int prismatic_count = 0;
  for (int i = 0; i < chain.size(); ++i) {
    require(chain.kind(i) != joint_kind::helical, "duet: ", function, ": joint ", i,
            " is helical (expected revolute or prismatic)");
    prismatic_count += chain.kind(i) == joint_kind::prismatic;
  }
  require(is_algebraic(chain, n), "duet: ", function, ": the chain has ", prismatic_count,
          " prismatic joints (expected at most ", n == 6 ? 3 : 1, ")");
}

solution_list solutions_within_limits(const chain_view& chain, const dual_quaternion<double>& goal,
                                      const pose_tolerance& tolerance) {
  const auto all = all_inverse_kinematics(chain, goal);
  solution_list result{{}, all.is_complete};
  for (const auto& each : all.solutions) {
    auto theta = each.joints;
    bool is_within = true;
    for (int i = 0; i < chain.size(); ++i) {
      const bool is_prismatic = chain.kind(i) == joint_kind::prismatic;
      const double slack = is_prismatic ? tolerance.translation : tolerance.rotation;
      const double lower = chain.limits(i).lower - slack, upper = chain.limits(i).upper + slack;
      theta[i] = is_prismatic ? theta[i] : moved_by_full_turns(theta[i], lower, upper);
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

namespace {

/// Computes the singular values in SIMD batches of eight, which take little longer than one value.
void fill_singular_values(const known_size_view<6>& chain,
                          std::vector<inverse_kinematics_solution>& all) {
  using eight = batch<double, 8>;
  for (std::size_t first = 0; first < all.size(); first += 8) {
    Eigen::Matrix<eight, 6, 1> theta; // if there are fewer, the last one is repeated
    for (int k = 0; k < 6; ++k) {
      theta[k] = eight::from_lanes(
          [&](int i) { return all[std::min(first + std::size_t(i), all.size() - 1)].joints[k]; });
    }
    const eight values = smallest_singular_value(jacobian(chain, theta, frame::hybrid));
    for (std::size_t i = first; i < std::min(first + 8, all.size()); ++i) {
      all[i].smallest_singular_value = values[int(i - first)];
    }
  }
}

} // namespace
} // namespace duet::detail

namespace duet {
DUET_ABI_BEGIN

all_inverse_kinematics_result all_inverse_kinematics(const chain_view& chain,
                                                     const dual_quaternion<double>& goal) {
  detail::require_algebraic(chain, 6, "all_inverse_kinematics");
  detail::require_pose(goal, "all_inverse_kinematics", "the goal");
  const detail::branches_of_chain branches(chain, goal);
  const detail::loop_solution_set all = detail::solutions_of(branches.loop());
  all_inverse_kinematics_result result{{}, all.complex_solutions, all.method, all.is_complete};
  result.solutions.reserve(all.solutions.size());
  for (const detail::loop_solution& x : all.solutions) {
    auto solution = branches(x, all.coupled_pair);
    if (branches.is_new(solution, result.solutions)) {
      result.solutions.push_back(std::move(solution));
    } else {
      result.complex_solutions += x.multiplicity; // two that nearly coincide, complex by round-off
    }
  }
  detail::fill_singular_values(detail::known_size_view<6>(chain), result.solutions);
  std::sort(result.solutions.begin(), result.solutions.end(), [](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.joints.begin(), a.joints.end(), b.joints.begin(),
                                        b.joints.end());
  });
  return result;
}

DUET_ABI_END
} // namespace duet
