// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/end_conditions.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

/// \file
/// End conditions of rotation-vector splines as equations.

namespace duet::detail {

/// Vector equation at an end: the derivative of w of this order has a given value (joint 0), or is
/// equal on both sides of the joint-th inner knot, counted from the end.
struct end_equation {
  std::size_t joint, derivative;
};

/// End conditions of a rotation-vector spline of order k: k/2 − 1 equations at each end, the same
/// at both ends except for the given values; no equations if periodic. The highest derivative of w
/// on a segment is the (k−2)-th.
template <class T, int Order>
struct rotation_vector_ends {
  static constexpr std::size_t rates_per_end = std::size_t(Order) / 2 - 1;
  static constexpr std::size_t highest = std::size_t(Order) - 2;

  bool is_cyclic;
  std::array<end_equation, rates_per_end> equations;
  /// Values of the equations with joint 0: halved rates in body axes, at the start and at the end.
  std::array<std::array<vector3<T>, rates_per_end>, 2> values;

  rotation_vector_ends(const curve_ends<T>& ends, const quaternion<T>& first,
                       const quaternion<T>& last)
      : is_cyclic(ends.kind == end_condition_kind::periodic), equations(equations_of(ends.kind)) {
    for (std::size_t k = 0; k < rates_per_end; ++k) {
      for (const std::size_t end : {0U, 1U}) {
        // The third derivative, if prescribed, is zero: no snap.
        const auto& rates = equations[k].derivative == 0 ? ends.velocity : ends.acceleration;
        values[end][k] = equations[k].derivative < 2
                             ? rotate(conj(end == 0 ? first : last), rates[end])
                             : vector3<T>(vector3<T>::Constant(T(real_type_t<T>(0))));
      }
    }
  }

  /// Highest joint; equations reach one knot further.
  [[nodiscard]] std::size_t reach() const { return reach(equations); }
  /// Minimum number of samples; fewer leave an equation without its knots, or make two equations
  /// equal.
  [[nodiscard]] static std::size_t min_samples(end_condition_kind kind) {
    return kind == end_condition_kind::periodic ? 3 : 2 + 2 * reach(equations_of(kind));
  }

private:
  [[nodiscard]] static std::array<end_equation, rates_per_end>
  equations_of(end_condition_kind kind) {
    // The cubic uses the first column. Natural ends have no snap: a curve reflected at such an end
    // is smooth.
    std::array<end_equation, 2> both{};
    switch (kind) {
    case end_condition_kind::natural:
      both = {{{0, 1}, {0, 3}}};
      break;
    case end_condition_kind::velocity:
      both = {{{0, 0}, {1, highest}}};
      break;
    case end_condition_kind::acceleration:
      both = {{{0, 1}, {1, highest}}};
      break;
    case end_condition_kind::velocity_and_acceleration:
      both = {{{0, 0}, {0, 1}}};
      break;
    case end_condition_kind::not_a_knot:
      both = {{{1, highest}, {2, highest}}};
      break;
    case end_condition_kind::periodic:
      break;
    }
    std::array<end_equation, rates_per_end> result;
    std::copy_n(both.begin(), rates_per_end, result.begin());
    return result;
  }
  [[nodiscard]] static std::size_t reach(const std::array<end_equation, rates_per_end>& equations) {
    std::size_t result = 0;
    for (const end_equation& e : equations) {
      result = std::max(result, e.joint);
    }
    return result;
  }
};

} // namespace duet::detail
