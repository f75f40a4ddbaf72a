// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/kinematics/chain_walk.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/robotics/branches/loop_equation.hpp>
#include <duet/robotics/planning_model.hpp>

#include <array>
#include <cstddef>

/// \file
/// Loop equation of a chain of six joints with its tip (end effector) at a goal.

namespace duet::detail {

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

} // namespace duet::detail

#ifndef DUET_COMPILED
#include <duet/robotics/branches/chain_loop_units.hpp>
#endif
