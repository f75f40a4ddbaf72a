// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/distance.hpp>
#include <duet/quaternion/norm.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

/// \file
/// Distances between poses.
///
/// A distance between poses needs a weight of rotation against translation. Here a rotation by one
/// radian counts as much as a translation by the characteristic length, such as the
/// size of the body.

namespace duet {

/// Squared distance of two poses, d² = |t_B − t_A|² + ℓ² φ², ℓ the characteristic length, and φ,
/// from 0 to π, the angle between the rotations. Independent of the fixed frame, but not of the
/// body frame, whose origin is compared. Smooth if φ < π.
///
/// \param characteristic_length  translation that counts as much as a rotation by 1 rad, in the
///   unit of the translations, at least 0
/// \throws invalid_input if the characteristic length is negative or not finite
template <class A, Promotable<A> B>
[[nodiscard]] promote_t<A, B> squared_distance(const dual_quaternion<A>& a,
                                               const dual_quaternion<B>& b,
                                               double characteristic_length) {
  using T = promote_t<A, B>;
  detail::require(characteristic_length >= 0 && characteristic_length - characteristic_length == 0,
                  "duet: distance: characteristic_length is ", characteristic_length,
                  " (expected a finite number >= 0)");
  const vector3<T> offset = translation(b) - translation(a);
  return offset.dot(offset) + real_type_t<T>(characteristic_length * characteristic_length) *
                                  squared_distance(rotation(a), rotation(b));
}

namespace detail {

/// Distance of poses, computed in units of length 2^e, if squares of the numbers would overflow or
/// underflow.
template <class T>
[[nodiscard]] DUET_COLD T distance_of_extreme(const dual_quaternion<T>& a,
                                              const dual_quaternion<T>& b,
                                              double characteristic_length) {
  using std::abs;
  using std::ldexp;
  using std::max;
  using std::sqrt;
  using R = real_type_t<T>;
  const vector3<T> offset = translation(b) - translation(a);
  const vector3<T> r = rotation_vector_between(rotation(a), rotation(b));
  R largest(0);
  T sum(R(0));
  for (int i = 0; i < 3; ++i) {
    largest = max(largest, R(abs(innermost(offset[i]))));
    largest = max(largest, R(abs(R(R(characteristic_length) * innermost(r[i])))));
  }
  if (!(largest > 0 && largest <= std::numeric_limits<R>::max())) {
    return sqrt(squared_distance(a, b, characteristic_length)); // zero, infinite or not a number
  }
  // 2^−e must not overflow either.
  const int e = max(binary_exponent(largest), 4 - std::numeric_limits<R>::max_exponent);
  for (int i = 0; i < 3; ++i) {
    const T x = ldexp(offset[i], -e);
    const T y = ldexp(T(R(characteristic_length) * r[i]), -e);
    sum = sum + x * x + y * y;
  }
  return ldexp(T(sqrt(sum)), e);
}

} // namespace detail

/// Distance of two poses, in units of length: d, the root of `squared_distance`, a metric. Not
/// differentiable at d = 0.
template <class A, Promotable<A> B>
[[nodiscard]] promote_t<A, B> distance(const dual_quaternion<A>& a, const dual_quaternion<B>& b,
                                       double characteristic_length) {
  using std::sqrt;
  using T = promote_t<A, B>;
  const T square = squared_distance(a, b, characteristic_length);
  return select(
      detail::is_moderate(innermost(square)), [&] { return T(sqrt(square)); },
      [&] {
        return detail::by_lane(
            [=](const auto& p, const auto& q) {
              return detail::distance_of_extreme(p, q, characteristic_length);
            },
            dual_quaternion<T>(a), dual_quaternion<T>(b));
      });
}

/// Rejected: without a characteristic length a rotation has no weight.
template <class A, class B>
DUET_REFUSED("the characteristic length is missing: distance(a, b, characteristic_length)")
promote_t<A, B> distance(const dual_quaternion<A>&, const dual_quaternion<B>&);
template <class A, class B>
DUET_REFUSED("the characteristic length is missing: squared_distance(a, b, characteristic_length)")
promote_t<A, B> squared_distance(const dual_quaternion<A>&, const dual_quaternion<B>&);

} // namespace duet
