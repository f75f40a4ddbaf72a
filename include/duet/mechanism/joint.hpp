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
#include <concepts>
#include <limits>
#include <numbers>

/// \file
/// What a mechanism is built from: constant displacements and joints, as tables that the compiler
/// can compute.

namespace duet {

namespace detail {

// Arithmetic of the constants in a table, which the compiler can do: the functions of the standard
// library are not `constexpr`.

/// How far from 1 the squared norm of an axis or of a constant rotation may be, as they are written
/// with few digits.
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

/// A unit vector of which what is 0 or ±1 but for rounding is so: the products of its components
/// are then left out where the table is known to the compiler.
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

/// sin and cos of a constant angle. Multiples of a quarter turn are exact, although π/2 of the
/// table is a rounded number: it means a right angle.
template <class T>
[[nodiscard]] constexpr table_angle<T> sine_and_cosine_of_constant(const T& angle) {
  T quarter{};
  if constexpr (std::floating_point<T>) {
    quarter = std::numbers::pi_v<T> / 2;
  } else {
    quarter = constant::pi<T>() / 2;
  }
  const T turns = angle / quarter;
  const auto quarters = static_cast<long long>(turns + (turns < 0 ? T(-0.5) : T(0.5)));
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
[[nodiscard]] constexpr quaternion<T> turn_about(int axis, const T& angle) {
  const table_angle<T> half = sine_and_cosine_of_constant(T(angle / 2));
  const T zero(0);
  return {half.cosine, axis == 0 ? half.sine : zero, axis == 1 ? half.sine : zero,
          axis == 2 ? half.sine : zero};
}

/// The unit quaternion that one of few digits stands for.
/// \throws invalid_input for what is none
template <class T>
[[nodiscard]] constexpr quaternion<T> unit_rotation(const quaternion<T>& q) {
  const T square = norm2(q);
  if (!is_nearly_one(square)) {
    raise(invalid_input(
        message("duet: placement: its rotation ", q, " is no unit quaternion: normalized(q)")));
  }
  // A rotation that is a unit but for rounding stays what it is to the last bit.
  const T rounding = 8 * std::numeric_limits<T>::epsilon();
  return square - 1 <= rounding && 1 - square <= rounding ? q : q * inverse_root_near_one(square);
}

} // namespace detail

/// A constant displacement x ↦ R x + t in a table. To compute with it, make it a pose.
template <class T = double>
struct placement {
  quaternion<T> rotation{T(1)};   ///< R, by a unit quaternion
  std::array<T, 3> translation{}; ///< t, in units of length

  constexpr placement() = default;
  /// \param r  a unit quaternion, or one written with three digits or more, which is normalised
  /// \throws invalid_input for any other
  constexpr placement(const quaternion<T>& r, const std::array<T, 3>& t)
      : rotation(detail::unit_rotation(r)), translation(t) {}
  placement(const dual_quaternion<T>& a) : rotation(detail::unit_rotation(duet::rotation(a))) {
    const vector3<T> t = duet::translation(a);
    translation = {t[0], t[1], t[2]};
  }

  /// The displacement as a pose.
  [[nodiscard]] dual_quaternion<T> pose() const {
    return detail::pose_of_unit(rotation, detail::components(translation).eigen());
  }
  /// First b, then a, in fixed axes.
  [[nodiscard]] friend constexpr placement operator*(const placement& a, const placement& b) {
    using detail::components, detail::displacement;
    const auto both = displacement{a.rotation, components(a.translation)} *
                      displacement{b.rotation, components(b.translation)};
    return {both.rotation, both.translation};
  }
};

/// How a joint moves.
enum class joint_kind {
  revolute,   ///< turns about its axis, between limits
  continuous, ///< turns about its axis, as often as it likes
  prismatic,  ///< slides along its axis
  helical,    ///< turns about its axis and slides along it by `pitch` per radian
  fixed,      ///< does not move
  planar,     ///< slides across its axis and turns about it: x, y, angle. In trees only
  spherical,  ///< turns about its origin: a rotation vector. In trees only
  floating    ///< moves as it likes: x, y, z, then a rotation vector. In trees only
};

/// Limits of the coordinate θ of a joint: radians, or units of length for a prismatic one.
template <class T = double>
struct joint_limits {
  T lower = -std::numeric_limits<T>::infinity();   ///< the least θ
  T upper = std::numeric_limits<T>::infinity();    ///< the largest θ
  T velocity = std::numeric_limits<T>::infinity(); ///< the largest |θ̇|, per unit of time
};

/// One joint of a chain. Its own frame stands, at θ = 0, at `origin` in the frame of the joint
/// before; its axis goes through the frame's origin along the unit vector `axis` in that frame.
template <class T = double>
struct joint {
  joint_kind kind = joint_kind::revolute;     ///< how it moves
  placement<T> origin = {};                   ///< of its frame in that of the joint before
  std::array<T, 3> axis = {T(0), T(0), T(1)}; ///< a unit vector
  joint_limits<T> limits = {};                ///< of its coordinate
  T pitch = T(0);                             ///< of a helical joint, in units of length per radian

  /// How many coordinates it has.
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
  /// Does it turn about its axis?
  [[nodiscard]] constexpr bool turns() const {
    return kind == joint_kind::revolute || kind == joint_kind::continuous ||
           kind == joint_kind::helical;
  }
  /// Does it slide along its axis?
  [[nodiscard]] constexpr bool slides() const {
    return kind == joint_kind::prismatic || kind == joint_kind::helical;
  }
  /// How far it slides along its axis per unit of its coordinate.
  [[nodiscard]] constexpr T travel() const {
    return kind == joint_kind::helical ? pitch : T(slides() ? 1 : 0);
  }
  /// The limits that hold: of a continuous joint that of its velocity alone.
  [[nodiscard]] constexpr joint_limits<T> range() const {
    return kind == joint_kind::continuous ? joint_limits<T>{.velocity = limits.velocity} : limits;
  }
};

/// A frame fixed to a link of a chain. Link 0 is the base, link i what the i-th joint moves; the
/// offset is from the frame of that joint.
template <class T = double>
struct attached_frame {
  int link = 0;             ///< number of the link
  placement<T> offset = {}; ///< from the frame of the joint that moves the link

  /// The frame at the point x of this one, of the same axes.
  [[nodiscard]] constexpr attached_frame at_point(const std::array<T, 3>& x) const {
    return {link, offset * placement<T>{quaternion<T>(T(1)), x}};
  }
};

} // namespace duet
