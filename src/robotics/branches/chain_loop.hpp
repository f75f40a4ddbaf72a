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

#include <array>
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
  void normalise();
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
             const std::optional<coupled_prismatic_pair>& coupled_pair = {}) const;

  /// True if the candidate is a solution and not among `others`.
  [[nodiscard]] bool is_new(const inverse_kinematics_solution& solution,
                            const std::vector<inverse_kinematics_solution>& others) const;

private:
  static constexpr double max_residual = 1e-8;

  /// Largest prismatic displacement relative to the arm's size; at least 1.
  [[nodiscard]] double max_prismatic_travel(const Eigen::Ref<const six_coordinates>& theta) const;

  /// Moves two coupled prismatic joints to the centre of the range that the limits of both admit,
  /// or by the smallest displacement into an unbounded one.
  void move_within_limits(six_coordinates& theta, const coupled_prismatic_pair& pair) const;

  /// True if equal except for full turns.
  [[nodiscard]] bool is_same(const inverse_kinematics_solution& a,
                             const inverse_kinematics_solution& b) const;

  [[nodiscard]] inverse_kinematics_solution
  described(const loop_solution& x,
            const std::optional<coupled_prismatic_pair>& coupled_pair) const;

  known_size_view<6> chain_;
  tip_pose goal_;
  chain_screws axes_;
  loop_equation loop_;
};

DUET_ABI_END
} // namespace duet::detail
