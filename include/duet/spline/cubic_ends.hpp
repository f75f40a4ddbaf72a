// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/end_conditions.hpp>
#include <duet/spline/half_rate.hpp>
#include <duet/spline/knots.hpp>

#include <array>
#include <cstddef>
#include <vector>

/// \file
/// What each end condition asks of the cumulative cubic.

namespace duet::detail {

enum class end_kind { velocity, acceleration, not_a_knot, periodic };

/// An end condition as data, so that its equations are compiled once for all of them.
template <class T>
struct cubic_ends {
  end_kind kind = end_kind::acceleration;
  /// Velocities or accelerations at the start and at the end, halved, in spatial axes.
  std::array<vector3<T>, 2> rates;

  cubic_ends() { rates.fill(vector3<T>::Constant(T(real_type_t<T>(0)))); }
  explicit cubic_ends(const natural&) : cubic_ends() {}
  template <class V>
  explicit cubic_ends(const clamped<V>& ends)
      : kind(end_kind::velocity), rates{half_rate<T>(ends.start), half_rate<T>(ends.end)} {}
  template <class V>
  explicit cubic_ends(const end_acceleration<V>& ends)
      : rates{half_rate<T>(ends.start), half_rate<T>(ends.end)} {}
  explicit cubic_ends(const not_a_knot&) : cubic_ends() { kind = end_kind::not_a_knot; }
  explicit cubic_ends(const periodic&) : cubic_ends() { kind = end_kind::periodic; }

  [[nodiscard]] bool has_rates() const {
    return kind == end_kind::velocity || kind == end_kind::acceleration;
  }
  /// Fewer leave equations without their unknowns.
  [[nodiscard]] std::size_t least_rows() const {
    return kind == end_kind::not_a_knot ? 4 : kind == end_kind::periodic ? 3 : 2;
  }
  /// The knots of the cubic through data at u_0 … u_n.
  template <class R>
  [[nodiscard]] std::vector<R> knots(std::vector<R> u) const {
    if (kind == end_kind::periodic) {
      return periodic_knots(u, 4);
    }
    if (kind == end_kind::not_a_knot) {
      u.erase(u.end() - 2);
      u.erase(u.begin() + 1);
    }
    return clamped_knots(u, 4);
  }

  [[nodiscard]] cubic_ends<real_type_t<T>> real_part() const {
    cubic_ends<real_type_t<T>> result;
    result.kind = kind;
    for (std::size_t end = 0; end < 2; ++end) {
      for (int a = 0; a < 3; ++a) {
        result.rates[end][a] = innermost(rates[end][a]);
      }
    }
    return result;
  }
};

} // namespace duet::detail
