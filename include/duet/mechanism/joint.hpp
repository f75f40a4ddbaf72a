// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/mechanism/table_arithmetic.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <array>
#include <limits>
#include <sstream>

/// \file
/// What a mechanism is built from: constant displacements and joints, as tables that the compiler
/// can compute.

namespace duet {

namespace detail {

template <class T>
[[noreturn]] void refuse_placement(const quaternion<T>& q) {
  std::ostringstream message;
  message << "duet: placement: its rotation " << q << " is no unit quaternion: normalized(q)";
  throw invalid_input(message.str());
}

/// The unit quaternion that one of few digits stands for.
/// \throws invalid_input for what is none
template <class T>
[[nodiscard]] constexpr quaternion<T> unit_rotation(const quaternion<T>& q) {
  const T square = norm2(q);
  if (!is_nearly_one(square)) {
    refuse_placement(q);
  }
  // A rotation that is a unit but for rounding stays what it is to the last bit.
  const T rounding = 8 * std::numeric_limits<T>::epsilon();
  return square - 1 <= rounding && 1 - square <= rounding ? q : q * inverse_root_near_one(square);
}

} // namespace detail

/// A constant displacement x ↦ R x + t in a table. To compute with it, make it a pose.
template <class T = double>
struct placement {
  quaternion<T> rotation{T(1)};
  std::array<T, 3> translation{};

  constexpr placement() = default;
  /// \param r  a unit quaternion, or one written with three digits or more, which is normalised
  /// \throws invalid_input for any other
  constexpr placement(const quaternion<T>& r, const std::array<T, 3>& t)
      : rotation(detail::unit_rotation(r)), translation(t) {}
  placement(const dual_quaternion<T>& a) : rotation(detail::unit_rotation(duet::rotation(a))) {
    const vector3<T> t = duet::translation(a);
    translation = {t[0], t[1], t[2]};
  }

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
  fixed       ///< does not move
};

/// Of the coordinate θ of a joint: radians, or units of length for a prismatic one; `velocity` is
/// the largest |θ̇|.
template <class T = double>
struct joint_limits {
  T lower = -std::numeric_limits<T>::infinity();
  T upper = std::numeric_limits<T>::infinity();
  T velocity = std::numeric_limits<T>::infinity();
};

/// One joint of a chain. Its own frame stands, at θ = 0, at `origin` in the frame of the joint
/// before; its axis goes through the frame's origin along the unit vector `axis` in that frame.
template <class T = double>
struct joint {
  joint_kind kind = joint_kind::revolute;
  placement<T> origin = {};
  std::array<T, 3> axis = {T(0), T(0), T(1)};
  joint_limits<T> limits = {};
  T pitch = T(0); ///< of a helical joint, in units of length per radian

  [[nodiscard]] constexpr bool turns() const {
    return kind == joint_kind::revolute || kind == joint_kind::continuous ||
           kind == joint_kind::helical;
  }
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
  int link = 0;
  placement<T> offset = {};

  /// The frame at the point x of this one, of the same axes.
  [[nodiscard]] constexpr attached_frame at_point(const std::array<T, 3>& x) const {
    return {link, offset * placement<T>{quaternion<T>(T(1)), x}};
  }
};

} // namespace duet
