// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/end_conditions.hpp>
#include <duet/spline/half_rate.hpp>

#include <array>
#include <cstddef>

/// \file
/// End conditions as data, so that no equation is compiled for each of them.

namespace duet::detail {

enum class end_kind {
  natural,
  velocity,
  acceleration,
  velocity_and_acceleration,
  not_a_knot,
  periodic
};

/// What is asked of a curve at its ends, whatever kind of curve it is.
template <class T>
struct curve_ends {
  using rates = std::array<vector3<T>, 2>; ///< at the start and at the end

  end_kind kind;
  rates velocity, acceleration; ///< halved, in spatial axes; zero where none are given

  explicit curve_ends(end_kind k) : kind(k) {
    velocity.fill(vector3<T>::Constant(T(real_type_t<T>(0))));
    acceleration = velocity;
  }
  explicit curve_ends(const natural&) : curve_ends(end_kind::natural) {}
  template <class V>
  explicit curve_ends(const clamped<V>& ends) : curve_ends(end_kind::velocity) {
    velocity = {half_rate<T>(ends.start), half_rate<T>(ends.end)};
  }
  template <class V>
  explicit curve_ends(const end_acceleration<V>& ends) : curve_ends(end_kind::acceleration) {
    acceleration = {half_rate<T>(ends.start), half_rate<T>(ends.end)};
  }
  template <class V>
  explicit curve_ends(const fully_clamped<V>& ends) : curve_ends(ends.velocity) {
    kind = end_kind::velocity_and_acceleration;
    acceleration = curve_ends(ends.acceleration).acceleration;
  }
  explicit curve_ends(const not_a_knot&) : curve_ends(end_kind::not_a_knot) {}
  explicit curve_ends(const periodic&) : curve_ends(end_kind::periodic) {}

  [[nodiscard]] curve_ends<real_type_t<T>> real_part() const {
    curve_ends<real_type_t<T>> result(kind);
    for (std::size_t end = 0; end < 2; ++end) {
      for (int a = 0; a < 3; ++a) {
        result.velocity[end][a] = innermost(velocity[end][a]);
        result.acceleration[end][a] = innermost(acceleration[end][a]);
      }
    }
    return result;
  }
};

} // namespace duet::detail
