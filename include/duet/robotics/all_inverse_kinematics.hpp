// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/derivative/argument.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/chain_view.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

/// \file
/// All solutions of inverse kinematics of six-joint arms for a pose of the tip.

namespace duet {
DUET_ABI_BEGIN

/// Method by which `all_inverse_kinematics` found the solutions.
enum class solution_method {
  spherical_wrist, ///< closed form: three consecutive axes meet in a point
  parallel_axes,   ///< closed form: three consecutive axes are parallel
  three_prismatic, ///< closed form: three prismatic joints
  two_prismatic,   ///< zeros of a polynomial: two prismatic joints
  elimination      ///< zeros of a determinant (Raghavan–Roth)
};

/// Name of a `solution_method`.
[[nodiscard]] inline const char* to_text(solution_method method) {
  constexpr std::array names{"spherical_wrist", "parallel_axes", "three_prismatic", "two_prismatic",
                             "elimination"};
  return names[std::size_t(method)];
}

/// One solution of inverse kinematics: a configuration in which an arm reaches a pose.
struct inverse_kinematics_solution {
  /// Coordinates; those of revolute joints are within (−π, π], or a full turn from there if that is
  /// within the limits.
  Eigen::VectorXd joints;
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
struct all_inverse_kinematics_result {
  /// Solutions in lexicographic order of their coordinates.
  std::vector<inverse_kinematics_solution> solutions;
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

/// All solutions of the inverse kinematics of a six-joint arm: the joint coordinates at which its
/// tip frame has the pose `goal`, within limits or not.
///
/// Spherical wrists, three consecutive parallel axes and three prismatic joints are recognised, to
/// 1e-9 of the arm's size, and solved in closed form. Two prismatic joints: zeros of a polynomial
/// of degree 8. Any other arm: elimination after Raghavan and Roth for two loops whose axes are
/// displaced from the given ones by 1e-4 and less of the arm's size, so that no solutions coincide,
/// and Newton's method from there (docs/how-to/all_ik_solutions.md). Joints beyond their limits are
/// reported by `within_limits`. If the joints have a self-motion, some of its configurations are
/// returned: for two prismatic joints that are parallel in every configuration, one for each
/// solution of the other joints, at the centre of the range that the limits of both admit.
///
/// \param chain  six joints, revolute or prismatic, at most three of them prismatic
/// \throws invalid_input for other chains, and for a goal that is not a pose
[[nodiscard]] all_inverse_kinematics_result
all_inverse_kinematics(const chain_view& chain, const dual_quaternion<double>& goal);

DUET_ASKS_FOR_ONE_CONFIGURATION(all_inverse_kinematics, all_inverse_kinematics_result)

template <SerialChain C, VectorLike Start>
DUET_REFUSED(
    "all solutions are found without an initial guess: all_inverse_kinematics(chain, goal)")
all_inverse_kinematics_result
    all_inverse_kinematics(const C&, const dual_quaternion<double>&, const Start&);
template <SerialChain C, Real T>
DUET_REFUSED("the goal is a rotation, which has no position: pose(q, t)")
all_inverse_kinematics_result all_inverse_kinematics(const C&, const quaternion<T>&);

DUET_ABI_END
} // namespace duet
