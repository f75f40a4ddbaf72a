// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/quaternion/euler.hpp>

#include <Eigen/Core>

/// \file
/// Analytical Jacobians of a chain with respect to pose coordinates: translation and quaternion,
/// translation and Euler angles.

namespace duet {

/// Analytical Jacobian ∂γ/∂θ, 7 rows, of γ = [t; α] (N20, N21): J2 times it is the spatial
/// Jacobian. α is the quaternion of `chain.pose(theta)`, with the sign that it has there. Arguments
/// as `jacobian`.
///
/// \return a matrix of 7 rows and a column for each joint
template <SerialChain C, VectorLike X, FrameOnChain<C> At = tip_of_chain>
[[nodiscard]] auto pose_coordinates_jacobian(const C& chain, const X& theta, const At& at = {}) {
  using S = detail::chain_scalar<C, X>;
  const auto [a, m] = pose_and_jacobian(chain, theta, frame::spatial, at);
  detail::joint_columns<S, 7, C::joints> result(7, m.cols());
  for (Eigen::Index i = 0; i < m.cols(); ++i) {
    result.col(i) = pose_coordinates_rate(a, vector6<S>(m.col(i)));
  }
  return result;
}

/// Analytical Jacobian ∂[t; a, b, c]/∂θ, 6 rows, for the intrinsic Euler angles of a sequence:
/// `euler_jacobian<zyx>(chain, θ)`. Unbounded near gimbal lock, where the rates of the angles do
/// not exist. Arguments as `jacobian`.
///
/// \return a matrix of 6 rows and a column for each joint
template <euler_sequence Sequence, SerialChain C, VectorLike X, FrameOnChain<C> At = tip_of_chain>
[[nodiscard]] auto euler_jacobian(const C& chain, const X& theta, const At& at = {}) {
  using S = detail::chain_scalar<C, X>;
  auto [a, m] = pose_and_jacobian(chain, theta, frame::hybrid, at);
  const auto angles = euler<Sequence>(rotation(a));
  const matrix3<S> axes = euler_rate_matrix<Sequence>(angles[0], angles[1]);
  const vector3<S> x = axes.col(0), y = axes.col(1), z = axes.col(2);
  const vector3<S> yz = y.cross(z), zx = z.cross(x), xy = x.cross(y);
  const S volume = x.dot(yz);
  for (Eigen::Index i = 0; i < m.cols(); ++i) {
    const vector3<S> omega(m(3, i), m(4, i), m(5, i));
    m(3, i) = yz.dot(omega) / volume;
    m(4, i) = zx.dot(omega) / volume;
    m(5, i) = xy.dot(omega) / volume;
  }
  return m;
}

} // namespace duet
