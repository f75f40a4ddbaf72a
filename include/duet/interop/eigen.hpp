// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <Eigen/Geometry>

/// \file
/// Conversion to and from the rotations of Eigen, which share duet's conventions: Hamilton product,
/// active.

namespace duet {

/// q as Eigen's quaternion. Note that Eigen's constructor takes w first but stores x, y, z, w.
template <class T>
[[nodiscard]] Eigen::Quaternion<T> to_eigen(const quaternion<T>& q) {
  return Eigen::Quaternion<T>(q.w(), q.x(), q.y(), q.z());
}

/// Quaternion of Eigen, or one mapped to memory in the order x, y, z, w, as duet's.
template <class Derived>
[[nodiscard]] quaternion<typename Derived::Scalar>
from_eigen(const Eigen::QuaternionBase<Derived>& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

/// The rotation given by an axis of unit length and an angle in radians.
template <class T>
[[nodiscard]] quaternion<T> from_eigen(const Eigen::AngleAxis<T>& rotation) {
  return from_eigen(Eigen::Quaternion<T>(rotation));
}

/// The isometry x ↦ R x + t of a pose of unit norm.
template <class T>
[[nodiscard]] Eigen::Transform<T, 3, Eigen::Isometry> to_eigen(const dual_quaternion<T>& a) {
  Eigen::Transform<T, 3, Eigen::Isometry> result;
  result.matrix() = transform_matrix(a);
  return result;
}

/// The pose of an isometry x ↦ R x + t.
///
/// \throws invalid_input if the linear part is not a rotation
template <class T>
[[nodiscard]] dual_quaternion<T>
from_eigen(const Eigen::Transform<T, 3, Eigen::Isometry>& isometry) {
  return from_transform_matrix(Eigen::Matrix<T, 4, 4>(isometry.matrix()));
}

} // namespace duet
