// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/promotion.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>

/// \file
/// Distances between rotations.

namespace duet {

namespace detail {

/// The rotation vector of conj(a) b along the shorter arc, without cancellation if a and b are
/// near.
template <class A, class B>
[[nodiscard]] vector3<promote_t<A, B>> rotation_vector_between(const quaternion<A>& a,
                                                               const quaternion<B>& b) {
  using T = promote_t<A, B>;
  const T cosine = dot(a, b);
  const vector3<T> half = half_arc(a, b, cosine, innermost(cosine) < 0, "distance");
  return {2 * half[0], 2 * half[1], 2 * half[2]};
}

} // namespace detail

/// Squared angle between two rotations, φ² = |2 log(a* b)|², φ ∈ [0, π] in radians, for a and b of
/// unit norm. It is the same for b and −b, and in every frame. Smooth if φ < π, also at a = b; at
/// φ = π both arcs have the same length, and derivatives are those of the arc given by the sign of
/// b.
///
/// \throws invalid_input if a or b is zero
template <class A, Promotable<A> B>
  requires(!detail::contains_tag<promote_t<A, B>, screw_tag>())
[[nodiscard]] promote_t<A, B> squared_distance(const quaternion<A>& a, const quaternion<B>& b) {
  const auto r = detail::rotation_vector_between(a, b);
  return r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
}

/// Distance between two rotations, the angle φ ∈ [0, π] between them in radians: the root of
/// `squared_distance`, a metric. Not differentiable at φ = 0.
///
/// \throws invalid_input if a or b is zero
template <class A, Promotable<A> B>
  requires(!detail::contains_tag<promote_t<A, B>, screw_tag>())
[[nodiscard]] promote_t<A, B> distance(const quaternion<A>& a, const quaternion<B>& b) {
  using T = promote_t<A, B>;
  return norm(quaternion<T>(T(0), detail::rotation_vector_between(a, b)));
}

DUET_REFUSES_FOREIGN(squared_distance, double)
DUET_REFUSES_FOREIGN(distance, double)

} // namespace duet
