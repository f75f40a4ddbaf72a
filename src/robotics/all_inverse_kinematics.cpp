// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "branches/branch_search.hpp"
#include "branches/chain_loop.hpp"
#include "branches/singular_value.hpp"

#include <duet/core/batch/math.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/robotics/all_inverse_kinematics.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace duet::detail {
namespace {

/// \throws invalid_input for a chain that does not have six joints, each revolute or prismatic
void require_six_joints(const chain_view& chain) {
  require(chain.size() == 6, "duet: all_inverse_kinematics: the chain has ", chain.size(),
          " moving joints (expected 6)");
  int prismatic_count = 0;
  for (int i = 0; i < chain.size(); ++i) {
    require(chain.kind(i) != joint_kind::helical, "duet: all_inverse_kinematics: joint ", i,
            " is helical (expected revolute or prismatic)");
    prismatic_count += chain.kind(i) == joint_kind::prismatic ? 1 : 0;
  }
  require(prismatic_count <= 3, "duet: all_inverse_kinematics: the chain has ", prismatic_count,
          " prismatic joints (expected at most 3)");
}

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
  detail::require_six_joints(chain);
  detail::require_pose(goal, "all_inverse_kinematics", "the goal");
  const detail::branches_of_chain branches(chain, goal);
  const detail::branch_search search(branches.loop());
  all_inverse_kinematics_result result;
  result.complex_solutions = search.answer().complex_solutions;
  result.method = search.method();
  result.is_complete = search.answer().is_complete;
  std::vector<detail::branch> all;
  all.reserve(search.answer().solutions.size());
  for (const detail::loop_solution& x : search.answer().solutions) {
    const detail::branch solution = branches(x, search.answer().coupled_pair);
    if (branches.is_new(solution, all)) {
      all.push_back(solution);
    } else {
      result.complex_solutions += x.multiplicity; // two that nearly coincide, complex by round-off
    }
  }
  for (const detail::branch& x : all) {
    result.solutions.push_back({x.joints, x.residual, 0, x.multiplicity, x.within_limits});
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
