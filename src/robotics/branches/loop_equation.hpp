// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "../tip_pose.hpp"
#include <duet/core/batch/vector_sine_cosine.hpp>
#include <duet/core/config.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/chain_view.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/robotics/all_inverse_kinematics.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

/// \file
/// Loop equation of six joints whose successive displacements equal a given one, and the search for
/// all its solutions, those of inverse kinematics; chain and goal enter through it only.

namespace duet::detail {
DUET_ABI_BEGIN

/// Joint in the zero configuration: revolute about the line through `point` along `axis`, or
/// prismatic along `axis`. All in one frame.
struct loop_joint {
  bool is_revolute = true;
  three_vector<double> axis{}, point{};
};

/// Inverse of the displacement x ↦ R x + t.
[[nodiscard]] inline tip_pose inverse_pose(const tip_pose& a) {
  return {conj(a.rotation), -1 * rotated(conj(a.rotation), a.translation)};
}

[[nodiscard]] inline loop_joint displaced(const tip_pose& by, const loop_joint& j) {
  return {j.is_revolute, rotated(by.rotation, j.axis), by.point(j.point)};
}

/// Point on the axis of `a` that is nearest to that of `b`.
[[nodiscard]] inline three_vector<double> nearest_point(const loop_joint& a, const loop_joint& b) {
  const three_vector<double> n = cross(a.axis, b.axis);
  return a.point + dot(cross(b.point - a.point, b.axis), n) / dot(n, n) * a.axis;
}

using six_coordinates = Eigen::Matrix<double, 6, 1>;
using six_columns = Eigen::Matrix<double, 6, 6>;

/// Angle wrapped to (−π, π].
[[nodiscard]] inline double wrap_angle(double x) {
  constexpr double pi = std::numbers::pi, full_turn = 2 * pi;
  const double size = std::abs(x);
  // `std::remainder` alone gives the same, but takes twenty times as long.
  const double r = size <= pi       ? x
                   : size <= 3 * pi ? x - std::copysign(full_turn, x)
                                    : std::remainder(x, full_turn);
  return r <= -pi ? pi : r;
}

/// Loop-closure equation exp(θ₁S₁) … exp(θ₆S₆) = closing, a product of exponentials.
struct loop_equation {
  std::array<loop_joint, 6> joints{};
  tip_pose closing{quaternion<double>(1), {0, 0, 0}};

  /// Coordinates, or differences of them, with those of revolute joints wrapped to (−π, π].
  [[nodiscard]] six_coordinates wrapped(six_coordinates theta) const {
    for (int i = 0; i < 6; ++i) {
      theta[i] = joints[std::size_t(i)].is_revolute ? wrap_angle(theta[i]) : theta[i];
    }
    return theta;
  }
  /// Loop that begins with a later joint: exp(θ₂S₂) … exp(θ₆S₆) exp(θ₁ Ad(closing⁻¹)S₁) is the same
  /// displacement.
  [[nodiscard]] loop_equation shifted(int count = 1) const {
    loop_equation result = *this;
    for (int k = 0; k < count; ++k) {
      std::rotate(result.joints.begin(), result.joints.begin() + 1, result.joints.end());
      result.joints[5] = displaced(inverse_pose(closing), result.joints[5]);
    }
    return result;
  }
  /// Loop in reverse order, exp(−θ₆S₆) … exp(−θ₁S₁) = closing⁻¹.
  [[nodiscard]] loop_equation reversed() const {
    loop_equation result{joints, inverse_pose(closing)};
    std::reverse(result.joints.begin(), result.joints.end());
    for (loop_joint& j : result.joints) {
      j.axis = -1 * j.axis;
    }
    return result;
  }
};

/// Rotation about an axis, from the sine and the cosine of half its angle.
[[nodiscard]] inline quaternion<double> rotation_about_axis(const three_vector<double>& axis,
                                                            double sine, double cosine) {
  return {cosine, sine * axis.x, sine * axis.y, sine * axis.z};
}

/// Angle of a rotation about n.
[[nodiscard]] inline double angle_of(const quaternion<double>& q, const three_vector<double>& n) {
  return 2 * std::atan2(n.x * q.x() + n.y * q.y() + n.z * q.z(), q.w());
}

/// Component of x orthogonal to a unit vector n.
[[nodiscard]] inline three_vector<double> orthogonal_part(const three_vector<double>& x,
                                                          const three_vector<double>& n) {
  return x - dot(n, x) * n;
}

/// Sines and cosines of half the coordinates.
[[nodiscard]] inline sines_at_once<6> half_angle_sincos_of(const six_coordinates& theta) {
  return sines_at_once<6>(theta[0] / 2, theta[1] / 2, theta[2] / 2, theta[3] / 2, theta[4] / 2,
                          theta[5] / 2);
}

/// Product of the displacements of `count` joints from joint `first` on (forward kinematics).
[[nodiscard]] inline tip_pose
product_of_joints(const loop_equation& loop, const six_coordinates& theta, int first, int count) {
  const auto halves = half_angle_sincos_of(theta);
  tip_pose result{quaternion<double>(1), {0, 0, 0}};
  for (int i = first; i < first + count; ++i) {
    const loop_joint& j = loop.joints[std::size_t(i)];
    const quaternion<double> q = rotation_about_axis(j.axis, halves.sine(i), halves.cosine(i));
    result = result * (j.is_revolute ? tip_pose{q, j.point - rotated(q, j.point)}
                                     : tip_pose{quaternion<double>(1), theta[i] * j.axis});
  }
  return result;
}

/// Closure error of a loop: the twist [v; ω] that closes it, and the Jacobian of the six joints, in
/// the frame of the axes.
struct closure_error {
  six_coordinates twist;
  six_columns jacobian;
  double size = 1; ///< largest prismatic displacement, at least 1: round-off grows with it

  closure_error(const loop_equation& loop, const six_coordinates& theta) {
    const auto halves = half_angle_sincos_of(theta);
    tip_pose link{quaternion<double>(1), {0, 0, 0}};
    for (int column = 0; column < 6; ++column) {
      const loop_joint& j = loop.joints[std::size_t(column)];
      const three_vector<double> n = rotated(link.rotation, j.axis);
      if (!j.is_revolute) {
        jacobian.col(column) << n.x, n.y, n.z, 0, 0, 0;
        link.translation = link.translation + theta[column] * n;
        size = std::max(size, std::abs(theta[column]));
        continue;
      }
      const three_vector<double> p = link.point(j.point), m = cross(p, n);
      jacobian.col(column) << m.x, m.y, m.z, n.x, n.y, n.z;
      link.rotation =
          link.rotation * rotation_about_axis(j.axis, halves.sine(column), halves.cosine(column));
      link.translation = p - rotated(link.rotation, j.point);
    }
    const tip_pose remaining = loop.closing * inverse_pose(link);
    const double twice =
        remaining.rotation.w() < 0 ? -2 : 2; // 2 sin(angle/2) rises up to half a turn
    twist << remaining.translation.x, remaining.translation.y, remaining.translation.z,
        twice * remaining.rotation.x(), twice * remaining.rotation.y(),
        twice * remaining.rotation.z();
  }
};

/// Newton's method from an initial guess θ to a solution, accurate to round-off; near singularities
/// by damped least squares (Levenberg–Marquardt).
///
/// \param size_of_angles  divisor of angular errors, as `closure_error::size` is of lengths, and at
/// most that size: the default, which saves a step if many initial guesses are tried; or 1
/// \return true if it converges
[[nodiscard]] bool close_loop(const loop_equation& loop, six_coordinates& theta,
                              double size_of_angles = HUGE_VAL);

/// Solution of a loop with its multiplicity.
struct loop_solution {
  six_coordinates theta;
  int multiplicity = 1;
  double sigma = 1; ///< smallest singular value of the loop's Jacobian; 1 if not computed
};

/// Two prismatic joints that are parallel in every configuration: displacements by x of the first
/// and by `second_factor` x of the second leave the loop closed.
struct coupled_prismatic_pair {
  int first = 0, second = 0;
  double second_factor = -1;
};

/// Solutions of a loop, and whether they are complete.
struct loop_solution_set {
  std::vector<loop_solution> solutions = {};
  int complex_solutions = 0;
  bool is_complete = false;
  solution_method method = solution_method::elimination;
  std::optional<coupled_prismatic_pair> coupled_pair =
      {}; ///< if set, a solution represents all that it makes
};

/// All solutions of a loop, by the method that suits its geometry.
[[nodiscard]] loop_solution_set solutions_of(const loop_equation& loop);

/// Loop with a goal close to the given one.
[[nodiscard]] loop_equation with_disturbed_goal(loop_equation loop, double by, std::uint64_t seed);

/// True if the goal is farther away than the joints can reach.
[[nodiscard]] bool is_beyond_reach(const loop_equation& loop);

/// True if no solution is regular, whatever the goal, as if two neighbouring joints rotate about
/// one axis.
[[nodiscard]] bool is_always_singular(const loop_equation& loop);

/// All solutions of a loop by Raghavan–Roth elimination, for arms without special geometry.
[[nodiscard]] loop_solution_set eliminated(const loop_equation& loop);

/// All solutions of a loop with two prismatic joints, by the zeros of a polynomial.
[[nodiscard]] loop_solution_set solve_two_prismatic(const loop_equation& loop);

/// θ moved by full turns to below the upper limit or to above the lower one.
[[nodiscard]] inline double moved_by_full_turns(double theta, double lower, double upper) {
  constexpr double full_turn = 2 * std::numbers::pi;
  return theta > upper   ? theta - full_turn * std::ceil((theta - upper) / full_turn)
         : theta < lower ? theta + full_turn * std::ceil((lower - theta) / full_turn)
                         : theta;
}

/// θ moved by a full turn into the limits, if that is possible.
[[nodiscard]] double wrap_into_limits(double theta, const joint_limits<double>& limits);

/// True if the chain has n joints whose equations are algebraic, as `all_inverse_kinematics` and
/// `self_motion_curves` require: revolute, or up to three of six or one of seven prismatic.
[[nodiscard]] bool is_algebraic(const chain_view& chain, int n);

/// \throws invalid_input for other chains, with the name of the function
void require_algebraic(const chain_view& chain, int n, const char* function);

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
