// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/lanes.hpp>
#include <duet/core/compiler/refused.hpp>
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
/// radian counts as much as a translation by `length`, a characteristic length such as the size of
/// the body.

namespace duet {

/// Squared distance of two poses, d² = |t_B − t_A|² + length² φ², φ ∈ [0, π] the angle between the
/// rotations. Independent of the fixed frame, but not of the body frame, whose origin is compared.
/// Smooth if φ < π.
///
/// \param length  characteristic length, in the unit of the translations, at least 0
/// \throws invalid_input if the length is negative or not finite
template <class A, Promotable<A> B>
[[nodiscard]] promote_t<A, B> squared_distance(const dual_quaternion<A>& a,
                                               const dual_quaternion<B>& b, double length) {
  using T = promote_t<A, B>;
  detail::require(length >= 0 && length - length == 0, "duet: distance: length is ", length,
                  ", not a number from 0 up");
  const vector3<T> move = translation(b) - translation(a);
  return move.dot(move) +
         real_type_t<T>(length * length) * squared_distance(rotation(a), rotation(b));
}

namespace detail {

/// Distance of poses in units of length 2^e: squares of the largest and the smallest numbers are
/// out of range.
template <class T>
[[nodiscard]] DUET_COLD T distance_of_extreme(const dual_quaternion<T>& a,
                                              const dual_quaternion<T>& b, double length) {
  using std::abs;
  using std::ldexp;
  using std::max;
  using std::sqrt;
  using R = real_type_t<T>;
  const vector3<T> move = translation(b) - translation(a);
  const vector3<T> turn = rotation_vector_between(rotation(a), rotation(b));
  R largest(0);
  T sum(R(0));
  for (int i = 0; i < 3; ++i) {
    largest = max(largest, R(abs(innermost(move[i]))));
    largest = max(largest, R(abs(R(R(length) * innermost(turn[i])))));
  }
  if (!(largest > 0 && largest <= std::numeric_limits<R>::max())) {
    return sqrt(squared_distance(a, b, length)); // zero, infinite or not a number
  }
  // 2^−e must be a number too.
  const int e = max(binary_exponent(largest), 4 - std::numeric_limits<R>::max_exponent);
  for (int i = 0; i < 3; ++i) {
    const T x = ldexp(move[i], -e);
    const T y = ldexp(T(R(length) * turn[i]), -e);
    sum = sum + x * x + y * y;
  }
  return ldexp(T(sqrt(sum)), e);
}

} // namespace detail

/// Distance of two poses, in units of length: d, the root of `squared_distance`, a metric. Not
/// differentiable at d = 0.
template <class A, Promotable<A> B>
[[nodiscard]] promote_t<A, B> distance(const dual_quaternion<A>& a, const dual_quaternion<B>& b,
                                       double length) {
  using std::sqrt;
  using T = promote_t<A, B>;
  const T square = squared_distance(a, b, length);
  return select(
      detail::is_moderate(innermost(square)), [&] { return T(sqrt(square)); },
      [&] {
        return detail::by_lane(
            [=](const auto& p, const auto& q) { return detail::distance_of_extreme(p, q, length); },
            dual_quaternion<T>(a), dual_quaternion<T>(b));
      });
}

/// Rejected: without a characteristic length a rotation has no weight.
template <class A, class B>
DUET_REFUSED("how far does a turn by one radian count? distance(a, b, length)")
promote_t<A, B> distance(const dual_quaternion<A>&, const dual_quaternion<B>&);
template <class A, class B>
DUET_REFUSED("how far does a turn by one radian count? squared_distance(a, b, length)")
promote_t<A, B> squared_distance(const dual_quaternion<A>&, const dual_quaternion<B>&);

} // namespace duet
