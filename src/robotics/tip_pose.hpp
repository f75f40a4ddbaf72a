// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "bounded_step.hpp"
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/chain_walk.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <cmath>

/// \file
/// Pose of a chain's tip, and the error between two poses.

namespace duet::detail {
DUET_ABI_BEGIN

/// Pose of the tip.
using tip_pose = link_displacement<double>;

[[nodiscard]] inline tip_pose to_tip_pose(const dual_quaternion<double>& a) {
  return {rotation(a), components(translation(a))};
}
[[nodiscard]] inline dual_quaternion<double> to_dual_quaternion(const tip_pose& a) {
  return pose_of_unit(a.rotation, a.translation.eigen());
}
[[nodiscard]] inline double length_of(const three_vector<double>& x) {
  return std::sqrt(dot(x, x));
}

/// Twist [v; ω], in `frame::hybrid`, of the shorter screw motion from one pose to another in unit
/// time: ω = 2 log r of the rotation r between them, the displacement of the origin ∫₀¹ exp(sω) v
/// ds, solved for v.
[[nodiscard]] inline small_twist error_twist(const tip_pose& from, const tip_pose& to) {
  quaternion<double> r = to.rotation * conj(from.rotation);
  if (r.w() < 0) {
    r = -r;
  }
  const three_vector<double> displacement = to.translation - from.translation;
  const three_vector<double> sines{r.x(), r.y(), r.z()};
  const double sine = length_of(sines);
  if (!(sine > 0)) {
    return small_twist(displacement.x, displacement.y, displacement.z, 0, 0, 0);
  }
  const double half = std::atan2(sine, r.w()); // of the angle
  const three_vector<double> axis = 1 / sine * sines, across = cross(axis, displacement);
  const auto v = displacement - half * across + (1 - half * r.w() / sine) * cross(axis, across);
  const auto omega = 2 * half * axis;
  return small_twist(v.x, v.y, v.z, omega.x, omega.y, omega.z);
}

/// Lengths of v and ω. That of v is the distance of the origins if the two poses are near.
[[nodiscard]] inline pose_error deviation_of(const small_twist& e) {
  return {e.head<3>().norm(), e.tail<3>().norm()};
}
[[nodiscard]] inline pose_error pose_error_between(const tip_pose& a, const tip_pose& b) {
  return {length_of(b.translation - a.translation), deviation_of(error_twist(a, b)).rotation};
}

DUET_ABI_END
} // namespace duet::detail
