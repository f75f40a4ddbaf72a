// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/rotation.hpp>

#include <cmath>
#include <sstream>

/// \file
/// How far poses are from each other.
///
/// There is no distance of poses without a choice: turning must be weighed against moving. Here a
/// turn by one radian is as far as a move by `length`, the size of the body, say.

namespace duet {

/// d² = |t_B − t_A|² + length² φ², φ ∈ [0, π] the angle between the rotations. Does not depend on
/// the fixed frame, but does on the body's, whose origin is compared. Smooth where φ < π.
/// \param length  of the same unit as the translations, at least 0
/// \throws invalid_input where the length is negative or not finite
template <class T>
[[nodiscard]] T squared_distance(const dual_quaternion<T>& a, const dual_quaternion<T>& b,
                                 double length) {
  if (!(length >= 0 && length - length == 0)) {
    std::ostringstream message;
    message << "duet: distance: length is " << length << ", not a number from 0 up";
    throw invalid_input(message.str());
  }
  const vector3<T> move = translation(b) - translation(a);
  const vector3<T> turn = rotation_vector(quaternion<T>(conj(rotation(a)) * rotation(b)));
  return move.dot(move) + real_type_t<T>(length * length) * turn.dot(turn);
}

/// d, the root of `squared_distance`: a metric of poses, in units of length. Its derivative at
/// d = 0 does not exist.
template <class T>
[[nodiscard]] T distance(const dual_quaternion<T>& a, const dual_quaternion<T>& b, double length) {
  using std::sqrt;
  return sqrt(squared_distance(a, b, length));
}

} // namespace duet
