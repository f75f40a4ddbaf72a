// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/curve_ends.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

/// \file
/// What each end condition asks of a rotation-vector spline.

namespace duet::detail {

/// One vector equation at an end: the derivative of w with this number has a given value (joint 0),
/// or is the same on both sides of the joint-th inner knot, counted from the end.
struct end_equation {
  std::size_t joint, derivative;
};

/// What an end condition asks of a rotation-vector spline of order k: k/2 − 1 equations at each
/// end, the same at both but for the values given; nothing of a periodic one. The last derivative
/// of w that the pieces have is the (k−2)-th.
template <class T, int Order>
struct rotation_vector_ends {
  static constexpr std::size_t own = std::size_t(Order) / 2 - 1;
  static constexpr std::size_t highest = std::size_t(Order) - 2;

  bool is_cyclic;
  std::array<end_equation, own> equations;
  /// Values of the equations with joint 0: halved rates in body axes, at the start and at the end.
  std::array<std::array<vector3<T>, own>, 2> given;

  rotation_vector_ends(const curve_ends<T>& ends, const quaternion<T>& first,
                       const quaternion<T>& last)
      : is_cyclic(ends.kind == end_kind::periodic), equations(equations_of(ends.kind)) {
    for (std::size_t k = 0; k < own; ++k) {
      for (const std::size_t end : {0U, 1U}) {
        // A third derivative that is given is none: no snap.
        const auto& rates = equations[k].derivative == 0 ? ends.velocity : ends.acceleration;
        given[end][k] = equations[k].derivative < 2
                            ? rotate(conj(end == 0 ? first : last), rates[end])
                            : vector3<T>(vector3<T>::Constant(T(real_type_t<T>(0))));
      }
    }
  }

  /// The highest joint: equations reach one knot further.
  [[nodiscard]] std::size_t reach() const { return reach(equations); }
  /// Fewer rows leave an equation without its knots, or make it the same as another.
  [[nodiscard]] static std::size_t least_rows(end_kind kind) {
    return kind == end_kind::periodic ? 3 : 2 + 2 * reach(equations_of(kind));
  }

private:
  [[nodiscard]] static std::array<end_equation, own> equations_of(end_kind kind) {
    // Of the cubic the first column; no snap of natural ends: reflected there, the curve is smooth.
    std::array<end_equation, 2> both{};
    switch (kind) {
    case end_kind::natural:
      both = {{{0, 1}, {0, 3}}};
      break;
    case end_kind::velocity:
      both = {{{0, 0}, {1, highest}}};
      break;
    case end_kind::acceleration:
      both = {{{0, 1}, {1, highest}}};
      break;
    case end_kind::velocity_and_acceleration:
      both = {{{0, 0}, {0, 1}}};
      break;
    case end_kind::not_a_knot:
      both = {{{1, highest}, {2, highest}}};
      break;
    case end_kind::periodic:
      break;
    }
    std::array<end_equation, own> result;
    std::copy_n(both.begin(), own, result.begin());
    return result;
  }
  [[nodiscard]] static std::size_t reach(const std::array<end_equation, own>& equations) {
    std::size_t result = 0;
    for (const end_equation& e : equations) {
      result = std::max(result, e.joint);
    }
    return result;
  }
};

} // namespace duet::detail
