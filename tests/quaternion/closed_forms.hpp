// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <Eigen/Geometry>

/// \file
/// Derivatives of exp, log and powers in closed form, by the Jacobians of the rotation group, as
/// references for automatic differentiation.

namespace duet_test::closed_form {

using duet::quaternion, duet::stumpff, duet::vector3;

/// vec(e* ė) for e = exp(v): the right Jacobian at the rotation vector 2v, applied to v̇.
/// J(r) = 1 − (1 − cos r)/r² [r]× + (r − sin r)/r³ [r]×² with r = 2|v|.
template <class T>
[[nodiscard]] vector3<T> right_jacobian(const vector3<T>& v, const vector3<T>& v_dot) {
  const T s = 4 * v.squaredNorm();
  const vector3<T> once = 2 * v.cross(v_dot);
  return v_dot - stumpff<2>(s) * once + stumpff<3>(s) * vector3<T>(2 * v.cross(once));
}

/// Its inverse: v̇ from b = vec(q* q̇) and v = log q.
/// 1 + ½[r]× + (1/r² − (1 + cos r)/(2 r sin r)) [r]×²; the last factor is (c₂ − c₃)/(4 c₁) of |v|².
template <class T>
[[nodiscard]] vector3<T> inverse_right_jacobian(const vector3<T>& v, const vector3<T>& b) {
  const T s = v.squaredNorm();
  const T factor = (stumpff<2>(s) - stumpff<3>(s)) / stumpff<1>(s);
  const vector3<T> once = v.cross(b);
  return b + once + factor * vector3<T>(v.cross(once));
}

/// d exp(q): e^q (ẇ + J v̇)
template <class T>
[[nodiscard]] quaternion<T> exp_derivative(const quaternion<T>& q, const quaternion<T>& q_dot) {
  return exp(q) * quaternion<T>(q_dot.w(), right_jacobian(q.vec(), q_dot.vec()));
}

/// d log q from q⁻¹ q̇.
template <class T>
[[nodiscard]] quaternion<T> log_derivative(const quaternion<T>& q, const quaternion<T>& q_dot) {
  const quaternion<T> rate = inverse(q) * q_dot;
  return {rate.w(), inverse_right_jacobian(log(q).vec(), rate.vec())};
}

/// d q^ρ if q changes by q̇ and ρ by ρ̇.
template <class T>
[[nodiscard]] quaternion<T> pow_derivative(const quaternion<T>& q, const quaternion<T>& q_dot,
                                           const T& rho, const T& rho_dot) {
  const quaternion<T> l = log(q);
  const quaternion<T> l_dot = log_derivative(q, q_dot);
  const vector3<T> v = rho * l.vec();
  const vector3<T> v_dot = rho_dot * l.vec() + rho * l_dot.vec();
  return pow(q, rho) *
         quaternion<T>(T(rho_dot * l.w() + rho * l_dot.w()), right_jacobian(v, v_dot));
}

} // namespace duet_test::closed_form
