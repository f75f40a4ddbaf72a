// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "loop_equation.hpp"

#include "../tip_pose.hpp"
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/chain_view.hpp>
#include <duet/kinematics/chain_walk.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/robotics/all_inverse_kinematics.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

/// \file
/// Loop equation of a chain of six joints with its tip (end effector) at a goal.

namespace duet::detail {
DUET_ABI_BEGIN

/// View of a chain of N joints, a number known at compile time: functions that traverse it compute
/// sines in SIMD vectors, and return matrices of fixed size. Refers to what the `chain_view` does.
template <int N>
class known_size_view {
public:
  using scalar_type = double;
  using own_jacobian = void;
  static constexpr int joints = N;

  explicit known_size_view(const chain_view& chain) : chain_(chain) {}

  [[nodiscard]] int size() const { return N; }
  [[nodiscard]] std::span<const joint_step<double>> steps() const { return chain_.steps(); }
  [[nodiscard]] const attached_frame<double>& tip() const { return chain_.tip(); }
  [[nodiscard]] joint_limits<double> limits(int i) const { return chain_.limits(i); }

private:
  chain_view chain_;
};

/// Joint axes of a chain in the zero configuration, in a frame at their centre and in units of
/// their size.
struct chain_screws {
  std::array<loop_joint, 6> joints{};
  tip_pose tip{}; ///< pose in the zero configuration, in the frame and units of the base
  three_vector<double> centre{};
  double size = 1;

  /// Takes the axes from a chain.
  ///
  /// \param skip  index of a joint that is left out, fixed at its coordinate in
  /// θ; negative: no joint
  template <class C, class X>
  chain_screws(const C& chain, const X& theta, int skip) {
    tip = attached(walk<true, double>(
                       chain, theta, chain.size(),
                       [&](Eigen::Index i, const auto& step, const auto& axis, const auto& point) {
                         if (i != skip) {
                           joints[std::size_t(i > skip && skip >= 0 ? i - 1 : i)] = {
                               step.is_rotational(), axis, point};
                         }
                       }),
                   chain.tip().offset);
    normalise();
  }

  /// Loop equation with the tip at a goal.
  ///
  /// \param goal  tip pose in the base frame
  [[nodiscard]] loop_equation loop_to(const tip_pose& goal) const {
    tip_pose closing = goal * inverse_pose(tip);
    closing.translation = 1 / size * (closing.point(centre) - centre);
    return {joints, closing};
  }

private:
  /// Finds the centre and the size of the axes, and scales them. The centre is the point with the
  /// smallest sum of squared distances from the axes.
  void normalise() {
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
      j.point = orthogonal_part(j.point - centre, j.axis);
      largest = std::max(largest, length_of(j.point));
    }
    const double to_tip = length_of(tip.translation - centre), rounding = 1e-12 * reach;
    size = largest > rounding ? largest : to_tip > rounding ? to_tip : 1; // all axes meet
    for (loop_joint& j : joints) {
      j.point = 1 / size * j.point;
    }
  }
};

/// Solutions of the loop equation of a chain with its tip at a goal, in the coordinates of the
/// chain.
class branches_of_chain {
public:
  branches_of_chain(const chain_view& chain, const dual_quaternion<double>& goal)
      : chain_(chain), goal_(to_tip_pose(normalized(goal))),
        axes_(chain_, six_coordinates(six_coordinates::Zero()), -1), loop_(axes_.loop_to(goal_)) {}

  [[nodiscard]] const loop_equation& loop() const { return loop_; }

  /// Solution in the coordinates of the chain, without its singular value.
  [[nodiscard]] inverse_kinematics_solution
  operator()(const loop_solution& x,
             const std::optional<coupled_prismatic_pair>& coupled_pair = {}) const {
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

  /// True if the candidate is a solution and not among `others`.
  [[nodiscard]] bool is_new(const inverse_kinematics_solution& solution,
                            const std::vector<inverse_kinematics_solution>& others) const {
    return solution.residual < max_residual &&
           std::none_of(others.begin(), others.end(),
                        [&](const auto& other) { return is_same(solution, other); });
  }

private:
  static constexpr double max_residual = 1e-8;

  /// Largest prismatic displacement relative to the arm's size; at least 1.
  [[nodiscard]] double max_prismatic_travel(const Eigen::Ref<const six_coordinates>& theta) const {
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
  void move_within_limits(six_coordinates& theta, const coupled_prismatic_pair& pair) const {
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

  /// True if equal except for full turns.
  [[nodiscard]] bool is_same(const inverse_kinematics_solution& a,
                             const inverse_kinematics_solution& b) const {
    six_coordinates d = loop_.wrapped(a.joints - b.joints);
    for (int i = 0; i < 6; ++i) {
      d[i] /= loop_.joints[std::size_t(i)].is_revolute ? 1 : axes_.size;
    }
    return d.cwiseAbs().maxCoeff() < max_residual;
  }

  [[nodiscard]] inverse_kinematics_solution
  described(const loop_solution& x,
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

  known_size_view<6> chain_;
  tip_pose goal_;
  chain_screws axes_;
  loop_equation loop_;
};

DUET_ABI_END
} // namespace duet::detail
