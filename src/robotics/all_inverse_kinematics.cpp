// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "branches/branch_search.hpp"
#include "branches/chain_loop.hpp"
#include "branches/singular_value.hpp"
#include "solutions_within_limits.hpp"

#include <duet/core/batch/math.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/robotics/all_inverse_kinematics.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace duet::detail {
DUET_ABI_BEGIN

void chain_screws::normalise() {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const loop_joint& j : joints) {
    const Eigen::Vector3d n = j.axis, p = j.point;
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - n * n.transpose();
    squares += across;
    sum += across * p;
  }
  // If all axes are parallel `squares` is singular. It is therefore damped, and the solution is
  // refined as often as is needed to remove the effect of the damping otherwise.
  const Eigen::Matrix3d damped = (squares + 1e-6 * Eigen::Matrix3d::Identity()).inverse();
  Eigen::Vector3d solution = Eigen::Vector3d::Zero();
  for (int k = 0; k < 6; ++k) {
    solution += damped * (sum - squares * solution);
  }
  centre = components(solution);
  double largest = 0, reach = length_of(centre);
  for (loop_joint& j : joints) {
    reach = std::max(reach, length_of(j.point));
    const auto from_centre = j.point - centre;
    j.point = from_centre - dot(from_centre, j.axis) * j.axis;
    largest = std::max(largest, length_of(j.point));
  }
  const double to_tip = length_of(tip.translation - centre), rounding = 1e-12 * reach;
  size = largest > rounding ? largest : to_tip > rounding ? to_tip : 1; // all axes meet
  for (loop_joint& j : joints) {
    j.point = 1 / size * j.point;
  }
}

inverse_kinematics_solution
branches_of_chain::operator()(const loop_solution& x,
                              const std::optional<coupled_prismatic_pair>& coupled_pair) const {
  constexpr double rounding = 2e-13; // closed forms have larger errors near singularities
  inverse_kinematics_solution result = described(x, coupled_pair);
  if (!coupled_pair && result.residual * max_prismatic_travel(result.joints) > rounding) {
    loop_solution refined = x;
    static_cast<void>(close_loop(loop_, refined.theta, 1));
    const inverse_kinematics_solution other = described(refined, coupled_pair);
    if (other.residual < result.residual) { // the refinement may diverge
      result = other;
    }
  }
  return result;
}

bool branches_of_chain::is_new(const inverse_kinematics_solution& solution,
                               const std::vector<inverse_kinematics_solution>& others) const {
  return solution.residual < max_residual &&
         std::none_of(others.begin(), others.end(),
                      [&](const auto& other) { return is_same(solution, other); });
}

double
branches_of_chain::max_prismatic_travel(const Eigen::Ref<const six_coordinates>& theta) const {
  double result = 1;
  for (int i = 0; i < 6; ++i) {
    if (!loop_.joints[std::size_t(i)].is_revolute) {
      result = std::max(result, std::abs(theta[i]) / axes_.size);
    }
  }
  return result;
}

void branches_of_chain::move_within_limits(six_coordinates& theta,
                                           const coupled_prismatic_pair& pair) const {
  double &first = theta[pair.first], &second = theta[pair.second];
  const auto one = chain_.limits(pair.first), other = chain_.limits(pair.second);
  const double factor = pair.second_factor;
  // Range of the displacement of the first joint by its limits and by those of the second.
  const auto [min_step, max_step] =
      std::minmax({factor * (other.lower - second), factor * (other.upper - second)});
  const double lower = std::max(one.lower - first, min_step),
               upper = std::min(one.upper - first, max_step);
  if (lower <= upper) {
    const double middle = (lower + upper) / 2,
                 by = std::isfinite(middle) ? middle : std::clamp(0., lower, upper);
    first = std::clamp(first + by, one.lower, one.upper);
    second = std::clamp(second + factor * by, other.lower, other.upper);
  }
}

bool branches_of_chain::is_same(const inverse_kinematics_solution& a,
                                const inverse_kinematics_solution& b) const {
  bool result = true;
  for (int i = 0; i < 6 && result; ++i) {
    const double d = a.joints[i] - b.joints[i];
    const bool is_revolute = loop_.joints[std::size_t(i)].is_revolute;
    result = std::abs(is_revolute ? wrap_angle(d) : d / axes_.size) < max_residual;
  }
  return result;
}

inverse_kinematics_solution
branches_of_chain::described(const loop_solution& x,
                             const std::optional<coupled_prismatic_pair>& coupled_pair) const {
  six_coordinates theta;
  for (int i = 0; i < 6; ++i) {
    const bool is_revolute = loop_.joints[std::size_t(i)].is_revolute;
    theta[i] = is_revolute ? wrap_into_limits(wrap_angle(x.theta[i]), chain_.limits(i))
                           : axes_.size * x.theta[i];
  }
  if (coupled_pair) {
    move_within_limits(theta, *coupled_pair);
  }
  inverse_kinematics_solution result{theta, 0, 0, x.multiplicity};
  for (int i = 0; i < 6; ++i) {
    const auto limits = chain_.limits(i);
    result.within_limits =
        result.within_limits && theta[i] >= limits.lower && theta[i] <= limits.upper;
  }
  const tip_pose tip =
      attached(walk<true, double>(chain_, theta, 6, visit_nothing), chain_.tip().offset);
  const pose_error error = deviation_of(error_twist(tip, goal_));
  result.residual =
      std::max(error.translation / (axes_.size * max_prismatic_travel(theta)), error.rotation);
  return result;
}

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
  result.solutions.reserve(search.answer().solutions.size());
  for (const detail::loop_solution& x : search.answer().solutions) {
    auto solution = branches(x, search.answer().coupled_pair);
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
