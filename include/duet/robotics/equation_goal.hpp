// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/derivative/jacobian.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/robotics/pose_region.hpp>

#include <Eigen/Core>

#include <type_traits>

/// \file
/// User-defined goals given by equations.

namespace duet {

/// Goal f(A) = 0 for the pose A of the tip, up to six equations, which dual numbers differentiate.
///
/// \tparam F  A ↦ six numbers, an Eigen vector or an array: three lengths, then three angles in
/// radians, zeros for fewer equations. Generic over the scalars of A
///
/// Example: a tip a metre from the origin, `equation_goal{[]<class S>(const dual_quaternion<S>& a)
/// { return std::array<S, 6>{translation(a).norm() - 1}; }}`
template <class F>
struct equation_goal {
  F equations; ///< f

  /// For those who extend duet: required by `TipGoal`.
  [[nodiscard]] twist_constraint constraint(const dual_quaternion<double>& tip) const {
    const quaternion<double> r = rotation(tip);
    const vector3<double> t = translation(tip);
    const auto moved = [&](const auto& twist) {
      using S = std::decay_t<decltype(twist[0])>;
      const vector3<S> half(twist[3] / 2, twist[4] / 2, twist[5] / 2);
      const vector3<S> at(t[0] + twist[0], t[1] + twist[1], t[2] + twist[2]);
      return equations(pose(exp(half) * r, at));
    };
    const auto linearised = jacobian(moved, vector6<double>(vector6<double>::Zero()));
    twist_constraint result;
    result.matrix = linearised.jacobian;
    for (int i = 0; i < 6; ++i) {
      result.lower[i] = result.upper[i] = -linearised.value[i];
    }
    return result;
  }
};
template <class F>
equation_goal(F) -> equation_goal<F>;

} // namespace duet
