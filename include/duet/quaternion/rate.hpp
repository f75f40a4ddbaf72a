// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <Eigen/Core>

/// \file
/// Rates of unit quaternions, angular velocities (N6–N8) and accelerations. ω in rad per unit of
/// the parameter.

namespace duet {

namespace detail {

/// m q for a rotation m, or its rate, about spatial axes; q m about body axes.
template <class Frame, class M, class Q>
[[nodiscard]] DUET_ALWAYS_INLINE auto composed_in(Frame frame, const M& m, const Q& q) {
  if constexpr (is_spatial(frame)) {
    return m * q;
  } else {
    return q * m;
  }
}

} // namespace detail

/// N7: the angular velocity ω^s = vec(2 q̇ q*) in spatial axes, ω^b = vec(2 q* q̇) in body axes; q of
/// unit norm.
template <class A, Promotable<A> B, class Frame>
[[nodiscard]] DUET_ALWAYS_INLINE vector3<promote_t<A, B>>
angular_velocity(const quaternion<A>& q, const quaternion<B>& q_dot, Frame frame_of_result) {
  const auto half = detail::composed_in(frame_of_result, q_dot, conj(q));
  return {2 * half.x(), 2 * half.y(), 2 * half.z()};
}

/// Rejected: without a frame the axes are ambiguous.
template <class A, class B>
DUET_REFUSED("the frame is missing: angular_velocity(q, q_dot, frame::spatial) or frame::body")
vector3<promote_t<A, B>> angular_velocity(const quaternion<A>&, const quaternion<B>&);

/// N7: the rate q̇ of a rotation with a given angular velocity, q̇ = ½ ω^s q = ½ q ω^b
template <class A, Promotable<A> B, class Frame>
[[nodiscard]] DUET_ALWAYS_INLINE quaternion<promote_t<A, B>>
quaternion_rate(const quaternion<A>& q, const vector3<B>& omega, Frame frame_of_omega) {
  using S = detail::as_real_of<B, promote_t<A, B>>;
  const quaternion<S> half(S(0), S(omega[0]) / 2, S(omega[1]) / 2, S(omega[2]) / 2);
  return detail::composed_in(frame_of_omega, half, q);
}

/// Rejected: without a frame the axes are ambiguous.
template <class A, class B>
DUET_REFUSED("the frame is missing: quaternion_rate(q, omega, frame::spatial) or frame::body")
quaternion<promote_t<A, B>> quaternion_rate(const quaternion<A>&, const vector3<B>&);

/// Angular acceleration, the rate ω̇ of the angular velocity of N7: vec(2 q̈ q*) in spatial axes,
/// vec(2 q* q̈) in body axes; q of unit norm. (q̇ does not enter, as q̇ q̇* is real.)
template <class A, Promotable<A> B, Promotable<A> C, class Frame>
[[nodiscard]] vector3<promote_t<promote_t<A, B>, C>>
angular_acceleration(const quaternion<A>& q, const quaternion<B>& /*q_dot*/,
                     const quaternion<C>& q_ddot, Frame frame_of_result) {
  return angular_velocity(q, q_ddot, frame_of_result);
}

/// Rejected: without a frame the axes are ambiguous.
template <class A, class B, class C>
DUET_REFUSED(
    "the frame is missing: angular_acceleration(q, q_dot, q_ddot, frame::spatial) or frame::body")
vector3<promote_t<A, B>> angular_acceleration(const quaternion<A>&, const quaternion<B>&,
                                              const quaternion<C>&);

/// q̈ = (½ ω̇ − ¼ |ω|²) q in spatial axes, q (½ ω̇ − ¼ |ω|²) in body axes, for q of constant unit
/// norm.
template <class A, Promotable<A> B, Promotable<A> C, class Frame>
[[nodiscard]] quaternion<promote_t<promote_t<A, B>, C>>
quaternion_acceleration(const quaternion<A>& q, const vector3<B>& omega, const vector3<C>& alpha,
                        Frame frame_of_omega) {
  using T = promote_t<promote_t<A, B>, C>;
  const T square(omega[0] * omega[0] + omega[1] * omega[1] + omega[2] * omega[2]);
  const quaternion<T> half(T(-square / 4), T(alpha[0]) / 2, T(alpha[1]) / 2, T(alpha[2]) / 2);
  return detail::composed_in(frame_of_omega, half, q);
}

/// Rejected: without a frame the axes are ambiguous.
template <class A, class B, class C>
DUET_REFUSED(
    "the frame is missing: quaternion_acceleration(q, omega, alpha, frame::spatial) or frame::body")
quaternion<promote_t<A, B>> quaternion_acceleration(const quaternion<A>&, const vector3<B>&,
                                                    const vector3<C>&);

/// N8: the 3×4 matrix with ω = 2 M q̇ in the order (w, x, y, z): E(q) for spatial, G(q) for body
/// axes. E Gᵀ = R.
template <class T, class Frame>
[[nodiscard]] Eigen::Matrix<T, 3, 4> quaternion_rate_matrix(const quaternion<T>& q,
                                                            Frame frame_of_omega) {
  Eigen::Matrix<T, 3, 4> m;
  if constexpr (detail::is_spatial(frame_of_omega)) {
    m << -q.x(), q.w(), -q.z(), q.y(), //
        -q.y(), q.z(), q.w(), -q.x(),  //
        -q.z(), -q.y(), q.x(), q.w();
  } else {
    m << -q.x(), q.w(), q.z(), -q.y(), //
        -q.y(), -q.z(), q.w(), q.x(),  //
        -q.z(), q.y(), -q.x(), q.w();
  }
  return m;
}

/// Rejected: without a frame the axes are ambiguous.
template <class A>
DUET_REFUSED("the frame is missing: quaternion_rate_matrix(q, frame::spatial) or frame::body")
Eigen::Matrix<A, 3, 4> quaternion_rate_matrix(const quaternion<A>&);

DUET_REFUSES_FOREIGN(angular_velocity, vector3<double>)
DUET_REFUSES_FOREIGN(quaternion_rate, quaternion<double>)

} // namespace duet
