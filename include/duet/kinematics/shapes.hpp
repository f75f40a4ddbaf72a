// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <Eigen/Core>

/// \file
/// Collision shapes of arms and obstacles.

namespace duet {

/// Sphere: all points at a distance of at most `radius` from `centre`.
template <class T = double>
struct sphere {
  vector3<T> centre = detail::zero_initialized<vector3<T>>(); ///< centre, in units of length
  T radius = T(0);                                            ///< radius, in units of length
};

/// Capsule: all points at a distance of at most `radius` from the segment between two points, which
/// may coincide.
template <class T = double>
struct capsule {
  vector3<T> from; ///< one end of the segment, in units of length
  vector3<T> to;   ///< other end of the segment
  T radius;        ///< radius, in units of length

  constexpr capsule(const vector3<T>& a, const vector3<T>& b, const T& r)
      : from(a), to(b), radius(r) {}
  constexpr capsule(const sphere<T>& s) : capsule(s.centre, s.centre, s.radius) {}
};

/// Box: all points whose coordinates in the frame `pose` are, each, between ± `half_extents`.
template <class T = double>
struct box {
  dual_quaternion<T> pose{
      dual<T, 1, screw_tag>(T(1))}; ///< pose of its centre, axes along its edges
  vector3<T> half_extents =
      detail::zero_initialized<vector3<T>>(); ///< half extents along its axes, in units of length
};

/// Half-space: all points with normal·x ≤ offset; the unit normal points out of the solid. The
/// default is the ground z ≤ 0.
template <class T = double>
struct half_space {
  vector3<T> normal = vector3<T>::UnitZ(); ///< unit vector, out of the solid
  T offset = T(0);                         ///< offset along the normal, in units of length
};

/// Capsule moved by a pose.
template <class T, class U>
[[nodiscard]] capsule<promote_t<T, U>> transformed(const dual_quaternion<T>& a,
                                                   const capsule<U>& c) {
  return {transform_point(a, c.from), transform_point(a, c.to), promote_t<T, U>(c.radius)};
}

namespace detail {

template <class T>
[[nodiscard]] bool all_finite(const vector3<T>& x) {
  return innermost(x[0] - x[0]) == 0 && innermost(x[1] - x[1]) == 0 && innermost(x[2] - x[2]) == 0;
}

/// \throws invalid_input unless 0 ≤ x < ∞
template <class T, class... Name>
void require_extent(const T& x, const Name&... name) {
  require(innermost(x) >= 0 && innermost(x - x) == 0, "duet: ", name..., " is ", innermost(x),
          " (expected a non-negative number)");
}

} // namespace detail

/// Checks whether a shape is valid: finite, without negative sizes, with unit quaternions and
/// normals. For those who extend duet.
///
/// \param name  name of the shape in messages, in pieces that are concatenated
/// \throws invalid_input
template <class T, class... Name>
void require_shape(const sphere<T>& s, const Name&... name) {
  detail::require(detail::all_finite(s.centre), "duet: the centre of ", name..., " is not finite");
  detail::require_extent(s.radius, "the radius of ", name...);
}
template <class T, class... Name>
void require_shape(const capsule<T>& c, const Name&... name) {
  detail::require(detail::all_finite(c.from) && detail::all_finite(c.to), "duet: an end of ",
                  name..., " is not finite");
  detail::require_extent(c.radius, "the radius of ", name...);
}
template <class T, class... Name>
void require_shape(const box<T>& b, const Name&... name) {
  detail::require(is_unit(b.pose, 1e-6), "duet: the pose of ", name...,
                  " is not a unit dual quaternion");
  for (Eigen::Index i = 0; i < 3; ++i) {
    detail::require_extent(b.half_extents[i], "half extent ", i, " of ", name...);
  }
}
template <class T, class... Name>
void require_shape(const half_space<T>& h, const Name&... name) {
  detail::require(innermost(h.offset - h.offset) == 0, "duet: the offset of ", name...,
                  " is not finite");
  const auto square = innermost(h.normal.squaredNorm());
  detail::require(square - 1 <= 1e-6 && 1 - square <= 1e-6, "duet: the normal of ", name...,
                  " is not a unit vector");
}

} // namespace duet
