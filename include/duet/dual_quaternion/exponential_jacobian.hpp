// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>

/// \file
/// Jacobians of the exponential map of rigid motion: those of rotations over dual numbers, written
/// out as matrices of columns [v; ω].

namespace duet {

namespace detail {

/// The linear map of dual vectors with the matrix A + εB, as a matrix of columns [v; ω]: [A B; 0
/// A].
template <class T>
[[nodiscard]] matrix6<T> unfolded(const matrix3<screw_dual<T>>& m) {
  matrix6<T> result = matrix6<T>::Zero();
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      result(i, j) = m(i, j).value();
      result(i + 3, j + 3) = m(i, j).value();
      result(i, j + 3) = m(i, j).epsilon();
    }
  }
  return result;
}

} // namespace detail

/// Left Jacobian J_l with V^s = J_l(x) ẋ for the pose exp(½x), x = [v; ω] constant twist times
/// time.
template <class T>
[[nodiscard]] matrix6<detail::differentiable_t<T>> left_jacobian(const vector6<T>& x) {
  return detail::unfolded(left_jacobian(dual_vector_of(x)));
}
/// Right Jacobian J_r with V^b = J_r(x) ẋ: J_r(x) = J_l(−x).
template <class T>
[[nodiscard]] matrix6<detail::differentiable_t<T>> right_jacobian(const vector6<T>& x) {
  return detail::unfolded(right_jacobian(dual_vector_of(x)));
}
/// Inverse left Jacobian J_l⁻¹ with ẋ = J_l⁻¹(x) V^s; infinite if the angle is a full turn.
template <class T>
[[nodiscard]] matrix6<detail::differentiable_t<T>> left_jacobian_inverse(const vector6<T>& x) {
  return detail::unfolded(left_jacobian_inverse(dual_vector_of(x)));
}
/// Inverse right Jacobian J_r⁻¹ with ẋ = J_r⁻¹(x) V^b; infinite if the angle is a full turn.
template <class T>
[[nodiscard]] matrix6<detail::differentiable_t<T>> right_jacobian_inverse(const vector6<T>& x) {
  return detail::unfolded(right_jacobian_inverse(dual_vector_of(x)));
}

} // namespace duet
