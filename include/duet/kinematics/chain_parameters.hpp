// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <limits>

/// \file
/// Chains from Denavit–Hartenberg parameters, in the standard and the modified convention, and from
/// joint screws, as products of exponentials.

namespace duet {

namespace detail {

/// First member of an aggregate, which rejects a list of values without names.
struct fields_by_name {
  constexpr fields_by_name() = default;
  template <class X>
  constexpr fields_by_name(const X&) {
    static_assert(!std::same_as<X, X>,
                  "duet: dh_row: name the parameters, whose order differs from book to book: "
                  "{.a = 0, .d = .333, .alpha = 0}");
  }
};

} // namespace detail

/// One row of Denavit–Hartenberg parameters by name: `{.d = .333, .alpha = pi / 2}`; unnamed
/// parameters are zero. Lengths in units of length, angles in radians. The coordinate is added to
/// θ, or to d for a prismatic joint.
template <class T = double>
struct dh_row {
  detail::fields_by_name by_name = {};    ///< rejects values without names
  T a = T(0);                             ///< length of the link, in units of length
  T d = T(0);                             ///< offset along the joint's axis, in units of length
  T alpha = T(0);                         ///< twist angle of the link, radians
  T theta = T(0);                         ///< angle at which the coordinate is zero, radians
  joint_limits<T> limits = {};            ///< limits of the coordinate
  joint_kind kind = joint_kind::revolute; ///< type of joint
};

namespace detail {

/// T_x(a) R_x(α) T_z(d) R_z(θ), with exact products of the sine and cosine of a right angle.
template <class T>
[[nodiscard]] constexpr placement<T> between_axes(const dh_row<T>& link, const dh_row<T>& joint) {
  const auto [sine, cosine] = sine_and_cosine_of_constant(link.alpha);
  return {rotation_about_axis(0, link.alpha) * rotation_about_axis(2, joint.theta),
          {link.a, -sine * joint.d, cosine * joint.d}};
}

template <class T>
constexpr void require_row(const dh_row<T>& row, std::size_t i) {
  const T max_number(1e6);
  for (const T& x : {row.a, row.d, row.alpha, row.theta}) {
    if (!(x <= max_number && -x <= max_number)) {
      bad_joint(i, message("the parameter ", x, " is not a number up to 1e6"));
    }
  }
  const T full_turn(6.2832);
  for (const T& x : {row.alpha, row.theta}) {
    if (!(x <= full_turn && -x <= full_turn)) {
      bad_joint(i, message("the angle ", x, " exceeds a full turn (expected radians)"));
    }
  }
}

} // namespace detail

/// The chain of Denavit–Hartenberg transformations A_i = R_z(θ_i) T_z(d_i) T_x(a_i) R_x(α_i), the
/// standard convention: the axis of joint i is the z axis of the previous frame, and link i ends
/// with frame i.
///
/// \throws invalid_input as `serial_chain`
template <class T, std::size_t N>
[[nodiscard]] constexpr serial_chain<int(N), T> from_dh(const std::array<dh_row<T>, N>& rows,
                                                        const placement<T>& tool = {}) {
  std::array<joint<T>, N> joints{};
  std::array<placement<T>, N> link_frames{};
  dh_row<T> before{};
  for (std::size_t i = 0; i < N; ++i) {
    detail::require_row(rows[i], i);
    joints[i].kind = rows[i].kind;
    joints[i].origin = detail::between_axes(before, rows[i]);
    joints[i].limits = rows[i].limits;
    link_frames[i] = {detail::rotation_about_axis(0, rows[i].alpha), {rows[i].a, T(0), T(0)}};
    before = rows[i];
  }
  return serial_chain<int(N), T>(joints, link_frames[N - 1] * tool, link_frames);
}

/// The chain of Denavit–Hartenberg transformations R_x(α_i) T_x(a_i) R_z(θ_i) T_z(d_i), the
/// modified convention (Craig): frame i lies on the axis of joint i, and a and α of a row are those
/// of the link before the joint.
///
/// \throws invalid_input as `serial_chain`
template <class T, std::size_t N>
[[nodiscard]] constexpr serial_chain<int(N), T>
from_modified_dh(const std::array<dh_row<T>, N>& rows, const placement<T>& tool = {}) {
  std::array<joint<T>, N> joints{};
  for (std::size_t i = 0; i < N; ++i) {
    detail::require_row(rows[i], i);
    joints[i].kind = rows[i].kind;
    joints[i].origin = detail::between_axes(rows[i], rows[i]);
    joints[i].limits = rows[i].limits;
  }
  return serial_chain<int(N), T>(joints, tool);
}

/// The axis of a joint as a screw l + ε(m + pitch l) in the base frame at θ = 0: unit direction l,
/// moment m = point × l. A prismatic joint along n has l = 0 and n instead of m.
template <class T = double>
struct joint_screw {
  std::array<T, 3> direction;  ///< l, a unit vector, or zero for a prismatic joint
  std::array<T, 3> moment;     ///< m + pitch l, in units of length
  joint_limits<T> limits = {}; ///< limits of the coordinate

  constexpr joint_screw(const std::array<T, 3>& l, const std::array<T, 3>& m,
                        const joint_limits<T>& given_limits = {})
      : direction(l), moment(m), limits(given_limits) {}
  joint_screw(const dual_vector<T>& s, const joint_limits<T>& given_limits = {})
      : direction{s[0].value(), s[1].value(), s[2].value()}, moment{s[0].epsilon(), s[1].epsilon(),
                                                                    s[2].epsilon()},
        limits(given_limits) {}
};

/// The chain with forward kinematics by the product of exponentials, exp(½θ_1 S_1) … exp(½θ_n S_n)
/// M, with the joint screws S_i and the pose M of the tip at θ = 0. Link frames coincide with the
/// base frame at θ = 0.
///
/// \throws invalid_input as `serial_chain`
template <class T, std::size_t N>
[[nodiscard]] constexpr serial_chain<int(N), T>
from_screws(const std::array<joint_screw<T>, N>& screws, const placement<T>& tip = {}) {
  std::array<joint<T>, N> joints{};
  std::array<placement<T>, N> link_frames{};
  detail::three_vector<T> before{};
  for (std::size_t i = 0; i < N; ++i) {
    const auto l = detail::components(screws[i].direction);
    const auto m = detail::components(screws[i].moment);
    // The joint's frame: axes of the base at the point l × m, the point of the axis nearest to the
    // origin of the base.
    detail::three_vector<T> point{};
    if (dot(l, l) == 0) {
      joints[i].kind = joint_kind::prismatic;
      joints[i].axis = m;
    } else {
      joints[i].axis = l;
      point = cross(l, m);
      joints[i].pitch = dot(l, m);
      // Round-off of a moment is not a pitch.
      const T noise = 64 * std::numeric_limits<T>::epsilon();
      if (joints[i].pitch * joints[i].pitch > noise * noise * (1 + dot(m, m))) {
        joints[i].kind = joint_kind::helical;
      }
    }
    joints[i].origin.translation = point - before;
    joints[i].limits = screws[i].limits;
    link_frames[i].translation = T(-1) * point;
    before = point;
  }
  return serial_chain<int(N), T>(joints, link_frames[N - 1] * tip, link_frames);
}

} // namespace duet
