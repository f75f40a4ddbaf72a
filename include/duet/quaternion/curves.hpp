// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <array>
#include <cstddef>
#include <vector>

/// \file
/// Curves by repeated SLERP alone: squad and Bézier curves, of rotations and of poses.

namespace duet {

/// Inner control point of `squad` at q between two neighbours:
/// s = q exp(−¼(log(q* next) + log(q* previous))). Signs must be aligned. At an end, without a
/// neighbour, use q itself.
///
/// \throws invalid_input if one of the quaternions is zero
/// \return `quaternion<T>`
template <class A, Promotable<A> B, Promotable<A> C>
[[nodiscard]] auto squad_control(const quaternion<A>& previous, const quaternion<B>& q,
                                 const quaternion<C>& next) {
  using T = promote_t<promote_t<A, B>, C>;
  const vector3<T> to_next = detail::log_vector(quaternion<T>(conj(q) * next), "squad_control");
  const vector3<T> to_previous =
      detail::log_vector(quaternion<T>(conj(q) * previous), "squad_control");
  return q * duet::exp(vector3<T>((to_next + to_previous) / T(-4)));
}

/// Shoemake's spherical and quadrangle interpolation from a to b with control points p and q:
/// slerp(slerp(a, b, τ), slerp(p, q, τ), 2τ(1 − τ)). Signs must be aligned, and are not changed.
///
/// With control points by `squad_control` and equal parameter steps, segments join with continuous
/// angular velocity, but not with continuous angular acceleration.
///
/// \return `quaternion<T>`
template <class A, class P, class Q, class B, class S>
[[nodiscard]] auto squad(const quaternion<A>& a, const quaternion<P>& p, const quaternion<Q>& q,
                         const quaternion<B>& b, const S& tau) {
  return slerp(slerp(a, b, tau, slerp_arc::as_given), slerp(p, q, tau, slerp_arc::as_given),
               2 * tau * (1 - tau), slerp_arc::as_given);
}

namespace detail {

/// De Casteljau's algorithm with SLERP, overwriting its points.
template <class Points, class S>
[[nodiscard]] auto de_casteljau(Points q, const S& tau) {
  if (q.empty()) {
    raise(invalid_input("duet: bezier: there are no control points"));
  }
  for (std::size_t n = q.size(); n > 1; --n) {
    for (std::size_t i = 0; i + 1 < n; ++i) {
      q[i] = slerp(q[i], q[i + 1], tau);
    }
  }
  return q[0];
}

} // namespace detail

/// Bézier curve of n + 1 control points at τ ∈ [0, 1] by de Casteljau's algorithm with SLERP, each
/// along the shorter arc. It starts at the first point with n times the velocity of SLERP to the
/// second, and ends in the same way. Does not allocate memory.
template <class T, std::size_t N, ScalarFor<T> S>
[[nodiscard]] quaternion<promote_t<T, S>> bezier(const std::array<quaternion<T>, N>& points,
                                                 const S& tau) {
  static_assert(N > 0, "duet: bezier: there are no control points");
  std::array<quaternion<promote_t<T, S>>, N> q;
  for (std::size_t i = 0; i < N; ++i) {
    q[i] = quaternion<promote_t<T, S>>(points[i]);
  }
  return detail::de_casteljau(q, tau);
}
/// Bézier curve of a number of control points known at run time, at τ ∈ [0, 1]; copies them to the
/// heap.
///
/// \throws invalid_input if there are no points
template <class T, ScalarFor<T> S>
[[nodiscard]] quaternion<promote_t<T, S>> bezier(const std::vector<quaternion<T>>& points,
                                                 const S& tau) {
  return detail::de_casteljau(
      std::vector<quaternion<promote_t<T, S>>>(points.begin(), points.end()), tau);
}

} // namespace duet
