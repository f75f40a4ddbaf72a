// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/mechanism/chain_walk.hpp>
#include <duet/planning/branches/joint_loop.hpp>
#include <duet/planning/planning_model.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <array>
#include <cstddef>

/// \file
/// The loop that a chain of six joints and a goal make.

namespace duet::detail {

/// The axes of a chain's joints where all coordinates are zero, in a frame in their middle and in
/// units of their size.
struct chain_axes {
  std::array<loop_joint, 6> joints{};
  tip_place tip{}; ///< where all coordinates are zero, in the base's frame and units
  three_vector<double> middle{};
  double size = 1;

  /// \param skip  the number of a joint that is left out, at the coordinate that it has in θ
  template <class C, class X>
  chain_axes(const C& chain, const X& theta, int skip) {
    tip = attached(walk<true, double>(
                       chain, theta, chain.size(),
                       [&](Eigen::Index i, const auto& step, const auto& axis, const auto& point) {
                         if (i != skip) {
                           joints[std::size_t(i > skip && skip >= 0 ? i - 1 : i)] = {step.turns(),
                                                                                     axis, point};
                         }
                       }),
                   chain.tip().offset);
    choose_units();
  }

  /// \param goal  of the tip, in the base
  [[nodiscard]] joint_loop loop_to(const tip_place& goal) const {
    tip_place closing = goal * inverse_place(tip);
    closing.translation = 1 / size * (closing.point(middle) - middle);
    return {joints, closing};
  }

private:
  /// The middle is the point whose squared distances from the axes have the least sum.
  void choose_units();
};

} // namespace duet::detail

#ifndef DUET_COMPILED
#include <duet/planning/branches/chain_loop_units.hpp>
#endif
