// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/rules/lift.hpp>

#include <array>
#include <limits>

/// \file
/// Values at points where a direction is undetermined: the axis of a full turn, the rotation
/// between opposite vectors.

namespace duet::detail {

template <class R>
struct undetermined_rule {
  R chosen;

  template <class T>
  T value(const T&, const T&, const T&) const {
    return T(chosen);
  }
  template <class T>
  std::array<T, 3> slopes(const T&, const T&, const T&, const T&) const {
    const T nan(std::numeric_limits<real_type_t<T>>::quiet_NaN());
    return {nan, nan, nan};
  }
};

/// `chosen`, to which the values at neighbouring x, y, z do not tend: its derivatives are NaN,
/// except with respect to variables that x, y and z do not depend on.
template <class T>
[[nodiscard]] T undetermined(const real_type_t<T>& chosen, const T& x, const T& y, const T& z) {
  if constexpr (Infinitesimal<T>) {
    return lift(undetermined_rule<real_type_t<T>>{chosen}, x, y, z);
  } else {
    return chosen;
  }
}

} // namespace duet::detail
