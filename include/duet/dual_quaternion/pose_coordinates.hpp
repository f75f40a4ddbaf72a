// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/rate.hpp>

#include <Eigen/Core>

/// \file
/// Poses as seven numbers γ = [t; α], translation and unit quaternion (w, x, y, z), and their rates
/// (N20, N21).

namespace duet {

/// Seven coordinates of a pose, [t; α]: the position of its origin, then a quaternion, scalar
/// first.
template <class T>
using vector7 = Eigen::Matrix<T, 7, 1>;

/// A pose as seven coordinates γ = [t; α].
template <class T>
[[nodiscard]] vector7<T> pose_coordinates(const dual_quaternion<T>& a) {
  const quaternion<T> alpha = rotation(a);
  vector7<T> gamma;
  gamma << translation(a), alpha.w(), alpha.x(), alpha.y(), alpha.z();
  return gamma;
}
/// The pose of γ = [t; α], α of unit norm.
template <class T>
[[nodiscard]] dual_quaternion<T> from_pose_coordinates(const vector7<T>& gamma) {
  return pose(quaternion<T>(gamma[3], gamma[4], gamma[5], gamma[6]),
              vector3<T>(gamma[0], gamma[1], gamma[2]));
}

/// N21: the 6×7 matrix J2 = [I 2t̂E; 0 2E] with the spatial twist [v^s; ω^s] = J2 γ̇.
template <class T>
[[nodiscard]] Eigen::Matrix<T, 6, 7> pose_rate_matrix(const dual_quaternion<T>& a) {
  const vector3<T> t = translation(a);
  const Eigen::Matrix<T, 3, 4> e = quaternion_rate_matrix(rotation(a), frame::spatial);
  Eigen::Matrix<T, 6, 7> m = Eigen::Matrix<T, 6, 7>::Zero();
  m.template topLeftCorner<3, 3>().setIdentity();
  for (int j = 0; j < 4; ++j) {
    const vector3<T> omega(2 * e(0, j), 2 * e(1, j), 2 * e(2, j));
    m.template block<3, 1>(3, 3 + j) = omega;
    m.template block<3, 1>(0, 3 + j) = t.cross(omega);
  }
  return m;
}

/// Rate γ̇ = [ṫ; α̇] of a pose that moves with the spatial twist [v; ω]: ṫ = v − t × ω, α̇ = ½ ω α.
/// The inverse of J2 among the γ̇ that preserve |α| = 1.
template <class A, Promotable<A> B>
[[nodiscard]] vector7<promote_t<A, B>> pose_coordinates_rate(const dual_quaternion<A>& a,
                                                             const vector6<B>& spatial_twist) {
  using T = promote_t<A, B>;
  const vector3<T> omega = spatial_twist.template tail<3>().template cast<T>();
  const vector3<T> v = spatial_twist.template head<3>().template cast<T>();
  const vector3<T> t_dot = v - translation(a).template cast<T>().cross(omega);
  const quaternion<T> alpha_dot = quaternion_rate(rotation(a), omega, frame::spatial);
  vector7<T> result;
  result << t_dot, alpha_dot.w(), alpha_dot.x(), alpha_dot.y(), alpha_dot.z();
  return result;
}

} // namespace duet
