// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/quaternion/quaternion.hpp>

#include <cstddef>

/// \file
/// Orders in which quaternions are stored as four numbers.

namespace duet {

/// Order of the four numbers of a quaternion in memory.
enum class quaternion_order {
  wxyz, ///< scalar part first: duet, Ceres' QuaternionManifold, MuJoCo
  xyzw  ///< scalar part last: Eigen's coefficients, ROS, SciPy
};

/// Quaternion from four numbers in memory.
template <class T>
[[nodiscard]] constexpr quaternion<T> load_quaternion(const T* numbers, quaternion_order order) {
  const bool is_w_first = order == quaternion_order::wxyz;
  const T* vector = numbers + (is_w_first ? 1 : 0);
  return {numbers[is_w_first ? 0 : 3], vector[0], vector[1], vector[2]};
}

/// Writes a quaternion as four numbers.
template <class T>
constexpr void store_quaternion(const quaternion<T>& q, T* numbers, quaternion_order order) {
  const bool is_w_first = order == quaternion_order::wxyz;
  T* vector = numbers + (is_w_first ? 1 : 0);
  numbers[is_w_first ? 0 : 3] = q.w();
  vector[0] = q.x();
  vector[1] = q.y();
  vector[2] = q.z();
}

} // namespace duet
