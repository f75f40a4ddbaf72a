// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/constants.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>

/// \file
/// Constant displacements, joints and their limits, and frames on links, as tables that the
/// compiler can evaluate.

namespace duet {

namespace detail {

// Arithmetic of the constants in a table. The functions of the standard library are not
// `constexpr`, so the compiler could not evaluate them.

/// True if the squared norm of an axis or of a constant rotation, which is written with few digits,
/// differs from 1 by at most 2·10⁻³.
template <class T>
[[nodiscard]] constexpr bool is_nearly_one(const T& square) {
  return square - 1 <= 2e-3 && 1 - square <= 2e-3;
}

/// 1/√s for s near 1, by Newton's method.
template <class T>
[[nodiscard]] constexpr T inverse_root_near_one(const T& s) {
  T x(1);
  for (int i = 0; i < 8; ++i) {
    x = x * (3 - s * x * x) / 2;
  }
  return x;
}

/// A unit vector whose components within round-off of 0 or ±1 are replaced by those numbers.
/// Products with zero components are then omitted if the table is known to the compiler.
template <class T>
[[nodiscard]] constexpr three_vector<T> cleaned_direction(three_vector<T> n) {
  const T tolerance = 8 * std::numeric_limits<T>::epsilon();
  for (T* x : {&n.x, &n.y, &n.z}) {
    for (const int value : {-1, 0, 1}) {
      if (*x - value <= tolerance && value - *x <= tolerance) {
        *x = T(value);
      }
    }
  }
  return n;
}

template <class T>
struct table_angle {
  T sine, cosine;
};

/// Sine and cosine of a constant angle. Multiples of a right angle are exact, although π/2 in the
/// table is a rounded number: it stands for a right angle.
template <class T>
[[nodiscard]] constexpr table_angle<T> sine_and_cosine_of_constant(const T& angle) {
  T quarter{};
  if constexpr (std::floating_point<T>) {
    quarter = std::numbers::pi_v<T> / 2;
  } else {
    quarter = constant::pi<T>() / 2;
  }
  const T quarter_turns = angle / quarter;
  if (!(quarter_turns < 1e9 && quarter_turns > -1e9)) { // too many to count, or NaN
    using std::cos;
    using std::sin;
    return {sin(angle), cos(angle)};
  }
  const auto quarters =
      static_cast<long long>(quarter_turns + (quarter_turns < 0 ? T(-0.5) : T(0.5)));
  const T rest = angle - T(quarters) * quarter;
  T cosine(1), sine(rest), term(rest);
  T even(1);
  for (int k = 1; k < 60; ++k) {
    even = even * -rest * rest / ((2 * k - 1) * (2 * k));
    term = term * -rest * rest / ((2 * k) * (2 * k + 1));
    if (cosine + even == cosine && sine + term == sine) {
      break;
    }
    cosine = cosine + even;
    sine = sine + term;
  }
  switch ((quarters % 4 + 4) % 4) {
  case 0:
    return {sine, cosine};
  case 1:
    return {cosine, -sine};
  case 2:
    return {-sine, -cosine};
  default:
    return {-cosine, sine};
  }
}

/// Rotation about the axis 0 = x, 1 = y, 2 = z.
template <class T>
[[nodiscard]] constexpr quaternion<T> rotation_about_axis(int axis, const T& angle) {
  const table_angle<T> half = sine_and_cosine_of_constant(T(angle / 2));
  const T zero(0);
  return {half.cosine, axis == 0 ? half.sine : zero, axis == 1 ? half.sine : zero,
          axis == 2 ? half.sine : zero};
}

/// The unit quaternion that a quaternion of few digits stands for.
///
/// \throws invalid_input if the quaternion is not nearly a unit quaternion
template <class T>
[[nodiscard]] constexpr quaternion<T> unit_rotation(const quaternion<T>& q) {
  const T square = squared_norm(q);
  if (!is_nearly_one(square)) {
    raise(invalid_input(
        message("duet: placement: the rotation ", q, " is not a unit quaternion: normalized(q)")));
  }
  // A rotation whose norm is 1 to within round-off is kept to the last bit.
  const T rounding = 8 * std::numeric_limits<T>::epsilon();
  return square - 1 <= rounding && 1 - square <= rounding ? q : q * inverse_root_near_one(square);
}

/// The shortest rotation that takes z to the unit vector n: (1 + n·z, z × n), normalised; for −z
/// the half turn about x.
[[nodiscard]] inline quaternion<double> rotation_from_z(const three_vector<double>& n) {
  const double w = n.z > 0 ? 1 + n.z : (n.x * n.x + n.y * n.y) / (1 - n.z); // both are 1 + n·z
  const double length = std::sqrt(2 * w);
  return w > 0 ? quaternion<double>(w / length, -n.y / length, n.x / length, 0)
               : quaternion<double>(0, 1, 0, 0);
}

} // namespace detail

/// A constant displacement x ↦ R x + t in a table. For computations convert it to a pose
/// with `pose()`.
template <class T = double>
struct placement {
  quaternion<T> rotation{T(1)};   ///< R as a unit quaternion; default: identity
  std::array<T, 3> translation{}; ///< t in units of length; default: zero

  constexpr placement() = default;
  /// \param r  a unit quaternion, or one written with three digits or more, which is normalised
  /// \throws invalid_input for any other quaternion
  constexpr placement(const quaternion<T>& r, const std::array<T, 3>& t)
      : rotation(detail::unit_rotation(r)), translation(t) {}
  placement(const dual_quaternion<T>& a) : rotation(detail::unit_rotation(duet::rotation(a))) {
    const vector3<T> t = duet::translation(a);
    translation = {t[0], t[1], t[2]};
  }

  /// The displacement as a pose (unit dual quaternion).
  [[nodiscard]] dual_quaternion<T> pose() const {
    return detail::pose_of_unit(rotation, detail::components(translation).eigen());
  }
  /// The product: first b, then a, relative to fixed axes.
  [[nodiscard]] friend constexpr placement operator*(const placement& a, const placement& b) {
    using detail::components, detail::displacement;
    const auto both = displacement{a.rotation, components(a.translation)} *
                      displacement{b.rotation, components(b.translation)};
    return {both.rotation, both.translation};
  }
};

/// Types of joint, as in URDF, and helical ones.
enum class joint_kind {
  revolute,   ///< rotation about its axis, between limits
  continuous, ///< rotation about its axis, without limits
  prismatic,  ///< translation along its axis
  helical, ///< screw motion: rotation about its axis and translation along it by `pitch` per radian
  fixed,   ///< no motion, no coordinate
  planar,  ///< translation perpendicular to its axis and rotation about it: x, y, angle. Trees only
  spherical, ///< rotation about its origin, a rotation vector. Trees only
  floating   ///< six degrees of freedom: x, y, z, then a rotation vector. Trees only
};

/// Limits of the coordinate θ of a joint: radians, or units of length for a prismatic joint. By
/// default infinite.
template <class T = double>
struct joint_limits {
  T lower = -std::numeric_limits<T>::infinity();   ///< lower bound of θ
  T upper = std::numeric_limits<T>::infinity();    ///< upper bound of θ
  T velocity = std::numeric_limits<T>::infinity(); ///< upper bound of |θ̇|, per unit of time
};

/// One joint of a chain. At θ = 0 its frame is at `origin` relative to the frame of the
/// previous joint. Its axis passes through the origin of its frame along the unit vector `axis`
/// in that frame.
template <class T = double>
struct joint {
  joint_kind kind = joint_kind::revolute; ///< type of joint
  placement<T> origin = {}; ///< pose of its frame at θ = 0 in the frame of the previous joint
  std::array<T, 3> axis = {T(0), T(0), T(1)}; ///< unit vector along the axis in that frame
  joint_limits<T> limits = {};                ///< limits of its coordinate
  T pitch = T(0); ///< travel of a helical joint, in units of length per radian

  /// Number of coordinates of the joint: 0, 1, 3 or 6.
  [[nodiscard]] constexpr int coordinates() const {
    switch (kind) {
    case joint_kind::fixed:
      return 0;
    case joint_kind::planar:
    case joint_kind::spherical:
      return 3;
    case joint_kind::floating:
      return 6;
    default:
      return 1;
    }
  }
  /// True if the joint rotates about its axis: revolute, continuous or helical.
  [[nodiscard]] constexpr bool is_rotational() const {
    return kind == joint_kind::revolute || kind == joint_kind::continuous ||
           kind == joint_kind::helical;
  }
  /// True if the joint translates along its axis: prismatic or helical.
  [[nodiscard]] constexpr bool is_translational() const {
    return kind == joint_kind::prismatic || kind == joint_kind::helical;
  }
  /// Translation along the axis per unit of the coordinate: `pitch` of a helical joint, 1 of a
  /// prismatic one, otherwise 0.
  [[nodiscard]] constexpr T translation_per_unit() const {
    return kind == joint_kind::helical ? pitch : T(is_translational() ? 1 : 0);
  }
  /// Effective limits: for a continuous joint only the velocity limit, otherwise `limits`.
  [[nodiscard]] constexpr joint_limits<T> effective_limits() const {
    return kind == joint_kind::continuous ? joint_limits<T>{.velocity = limits.velocity} : limits;
  }
};

/// A frame fixed to a link of a chain. Link 0 is the base; link i is moved by the i-th joint. The
/// offset is relative to the frame of that joint.
template <class T = double>
struct attached_frame {
  int link = 0;             ///< number of the link, 0 for the base
  placement<T> offset = {}; ///< pose of the frame in that of the joint that moves the link

  /// The frame at the point x (in units of length) of this frame, with the same axes.
  [[nodiscard]] constexpr attached_frame at_point(const std::array<T, 3>& x) const {
    return {link, offset * placement<T>{quaternion<T>(T(1)), x}};
  }
};

} // namespace duet
