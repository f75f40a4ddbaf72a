// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/math.hpp>
#include <duet/core/compiler/refused.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/zero_initialized.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/chain_walk.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/robotics/branches/branch_search.hpp>
#include <duet/robotics/branches/chain_loop.hpp>
#include <duet/robotics/branches/loop_equation.hpp>
#include <duet/robotics/branches/singular_value.hpp>
#include <duet/robotics/planning_model.hpp>
#include <duet/robotics/tip_pose.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

/// \file
/// All solutions of inverse kinematics of six-joint arms for a pose of the tip.

namespace duet {

/// One solution of inverse kinematics: a configuration in which an arm reaches a pose.
///
/// \tparam N  as in `serial_chain`
template <int N>
struct inverse_kinematics_solution {
  /// Coordinates; those of revolute joints are within (−π, π], or a full turn from there if that is
  /// within the limits.
  detail::joint_vector<double, N> joints =
      detail::zero_initialized<detail::joint_vector<double, N>>();
  /// Error of the tip relative to the goal: the larger one of the rotation angle and of the
  /// distance relative to the arm's size, or to the largest prismatic displacement if that is
  /// larger.
  double residual = 0;
  /// Smallest singular value of the Jacobian in `frame::hybrid`; 0 at a singular solution.
  double smallest_singular_value = 0;
  /// Multiplicity; 2 at a double (singular) solution: between this solution and another one the tip
  /// stays within 3e-13 of the goal.
  int multiplicity = 1;
  bool within_limits = true; ///< true if all joints are within their limits

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("joints", joints);
    f("residual", residual);
    f("smallest_singular_value", smallest_singular_value);
    f("multiplicity", multiplicity);
    f("within_limits", within_limits);
  }
};

/// All solutions of inverse kinematics of an arm for a pose.
///
/// \tparam N  as in `serial_chain`
template <int N>
struct all_inverse_kinematics_result {
  /// Solutions in lexicographic order of their coordinates.
  std::vector<inverse_kinematics_solution<N>> solutions;
  /// Number of complex solutions: 16 at most in all. (An upper bound for arms of special geometry
  /// that are not solved in closed form.)
  int complex_solutions = 0;
  solution_method method = solution_method::elimination; ///< method that found the solutions
  /// True if it is certain, to round-off, that there are no other regular solutions. False if the
  /// joints have a self-motion, or if nothing was found and there may be one.
  bool is_complete = false;

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("solutions", solutions);
    f("complex_solutions", complex_solutions);
    f("method", method);
    f("is_complete", is_complete);
  }
};

namespace detail {

/// \throws invalid_input for a chain that does not have six joints, each revolute or prismatic
template <class C>
void require_six_joints(const C& chain) {
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

/// θ moved by a full turn into the limits, if that is possible.
[[nodiscard]] inline double wrap_into_limits(double theta, const joint_limits<double>& limits) {
  constexpr double full_turn = 2 * std::numbers::pi;
  for (const double x : {theta, theta + full_turn, theta - full_turn}) {
    if (x >= limits.lower && x <= limits.upper) {
      return x;
    }
  }
  return theta;
}

template <class C>
class branches_of_chain {
public:
  using branch = inverse_kinematics_solution<C::joints>;

  branches_of_chain(const C& chain, const dual_quaternion<double>& goal)
      : chain_(chain), goal_(to_tip_pose(normalized(goal))),
        axes_(chain, joint_vector<double, C::joints>::Zero(chain.size()).eval(), -1),
        loop_(axes_.loop_to(goal_)) {}

  [[nodiscard]] const loop_equation& loop() const { return loop_; }

  /// Solution in the coordinates of the chain, without its singular value.
  [[nodiscard]] branch
  operator()(const loop_solution& x,
             const std::optional<coupled_prismatic_pair>& coupled_pair = {}) const {
    constexpr double rounding = 2e-13; // closed forms have larger errors near singularities
    branch result = described(x, coupled_pair);
    if (!coupled_pair && result.residual * max_prismatic_travel(result.joints) > rounding) {
      loop_solution refined = x;
      static_cast<void>(close_loop(loop_, refined.theta, 1));
      const branch other = described(refined, coupled_pair);
      result = other.residual < result.residual ? other : result; // the refinement may diverge
    }
    return result;
  }

  /// True if the candidate is a solution and not among `others`.
  [[nodiscard]] bool is_new(const branch& solution, const std::vector<branch>& others) const {
    return solution.residual < max_residual &&
           std::none_of(others.begin(), others.end(),
                        [&](const branch& other) { return is_same(solution, other); });
  }

private:
  static constexpr double max_residual = 1e-8;

  /// Largest prismatic displacement relative to the arm's size; at least 1.
  [[nodiscard]] double max_prismatic_travel(const joint_vector<double, C::joints>& theta) const {
    double result = 1;
    for (int i = 0; i < 6; ++i) {
      if (!loop_.joints[std::size_t(i)].is_revolute) {
        result = std::max(result, std::abs(theta[i]) / axes_.size);
      }
    }
    return result;
  }

  /// Moves two coupled prismatic joints to the centre of the range that the limits of both admit,
  /// or by the smallest displacement into an unbounded one.
  void move_within_limits(joint_vector<double, C::joints>& theta,
                          const coupled_prismatic_pair& pair) const {
    double &first = theta[pair.first], &second = theta[pair.second];
    const auto &one = chain_.limits(pair.first), &other = chain_.limits(pair.second);
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

  /// True if equal except for full turns.
  [[nodiscard]] bool is_same(const branch& a, const branch& b) const {
    bool result = true;
    for (int i = 0; i < 6 && result; ++i) {
      const double d = a.joints[i] - b.joints[i];
      const bool is_revolute = loop_.joints[std::size_t(i)].is_revolute;
      result = std::abs(is_revolute ? wrap_angle(d) : d / axes_.size) < max_residual;
    }
    return result;
  }

  [[nodiscard]] branch described(const loop_solution& x,
                                 const std::optional<coupled_prismatic_pair>& coupled_pair) const {
    branch result;
    result.joints.resize(chain_.size());
    result.multiplicity = x.multiplicity;
    for (int i = 0; i < 6; ++i) {
      const bool is_revolute = loop_.joints[std::size_t(i)].is_revolute;
      result.joints[i] = is_revolute ? wrap_into_limits(wrap_angle(x.theta[i]), chain_.limits(i))
                                     : axes_.size * x.theta[i];
    }
    if (coupled_pair) {
      move_within_limits(result.joints, *coupled_pair);
    }
    for (int i = 0; i < 6; ++i) {
      const auto& limits = chain_.limits(i);
      const double theta = result.joints[i];
      result.within_limits = result.within_limits && theta >= limits.lower && theta <= limits.upper;
    }
    const tip_pose tip =
        attached(walk<true, double>(chain_, result.joints, 6, visit_nothing), chain_.tip().offset);
    const pose_error error = deviation_of(error_twist(tip, goal_));
    result.residual = std::max(
        error.translation / (axes_.size * max_prismatic_travel(result.joints)), error.rotation);
    return result;
  }

  const C& chain_;
  tip_pose goal_;
  chain_screws axes_;
  loop_equation loop_;
};

/// Computes the singular values in SIMD batches of eight, which take little longer than one value.
template <class C>
void fill_singular_values(const C& chain,
                          std::vector<inverse_kinematics_solution<C::joints>>& all) {
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

} // namespace detail

/// All solutions of the inverse kinematics of a six-joint arm: the joint coordinates at which its
/// tip frame has the pose `goal`, within limits or not.
///
/// Spherical wrists, three consecutive parallel axes and three prismatic joints are recognised, to
/// 1e-9 of the arm's size, and solved in closed form. Two prismatic joints: zeros of a polynomial
/// of degree 8. Any other arm: elimination after Raghavan and Roth for two loops whose axes are
/// displaced from the given ones by 1e-4 and less of the arm's size, so that no solutions coincide,
/// and Newton's method from there (docs/all_inverse_kinematics.md). Joints beyond their limits are
/// reported by `within_limits`. If the joints have a self-motion, some of its configurations are
/// returned: for two prismatic joints that are parallel in every configuration, one for each
/// solution of the other joints, at the centre of the range that the limits of both admit.
///
/// \param chain  six joints, revolute or prismatic, at most three of them prismatic
/// \throws invalid_input for other chains, and for a goal that is not a pose
template <SerialChain C>
[[nodiscard]] all_inverse_kinematics_result<C::joints>
all_inverse_kinematics(const C& chain, const dual_quaternion<double>& goal) {
  detail::require_six_joints(chain);
  detail::require_pose(goal, "all_inverse_kinematics", "the goal");
  const detail::branches_of_chain<C> branches(chain, goal);
  const detail::branch_search search(branches.loop());
  all_inverse_kinematics_result<C::joints> result;
  result.complex_solutions = search.answer().complex_solutions;
  result.method = search.method();
  result.is_complete = search.answer().is_complete;
  result.solutions.reserve(search.answer().solutions.size());
  for (const detail::loop_solution& x : search.answer().solutions) {
    const auto solution = branches(x, search.answer().coupled_pair);
    if (branches.is_new(solution, result.solutions)) {
      result.solutions.push_back(solution);
    } else {
      result.complex_solutions += x.multiplicity; // two that nearly coincide, complex by round-off
    }
  }
  detail::fill_singular_values(chain, result.solutions);
  std::sort(result.solutions.begin(), result.solutions.end(), [](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.joints.begin(), a.joints.end(), b.joints.begin(),
                                        b.joints.end());
  });
  return result;
}

DUET_ASKS_FOR_ONE_CONFIGURATION(all_inverse_kinematics, all_inverse_kinematics_result<C::joints>)

template <SerialChain C, VectorLike Start>
DUET_REFUSED(
    "all solutions are found without an initial guess: all_inverse_kinematics(chain, goal)")
all_inverse_kinematics_result<C::joints> all_inverse_kinematics(const C&,
                                                                const dual_quaternion<double>&,
                                                                const Start&);
template <SerialChain C, Real T>
DUET_REFUSED("the goal is a rotation, which has no position: pose(q, t)")
all_inverse_kinematics_result<C::joints> all_inverse_kinematics(const C&, const quaternion<T>&);

} // namespace duet
