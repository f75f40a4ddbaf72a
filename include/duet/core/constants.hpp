// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>

#include <concepts>
#include <numbers>

/// \file
/// Mathematical constants in the precision of any real type, Boost.Multiprecision included.

namespace duet::constant {

/// π
template <Real T>
[[nodiscard]] T pi() {
  if constexpr (std::floating_point<lane_type_t<T>>) {
    return std::numbers::pi_v<lane_type_t<T>>;
  } else {
    return T(4 * atan(T(1)));
  }
}

/// The natural logarithm of 2.
template <Real T>
[[nodiscard]] T ln2() {
  if constexpr (std::floating_point<lane_type_t<T>>) {
    return std::numbers::ln2_v<lane_type_t<T>>;
  } else {
    return T(log(T(2)));
  }
}

/// The natural logarithm of 10.
template <Real T>
[[nodiscard]] T ln10() {
  if constexpr (std::floating_point<lane_type_t<T>>) {
    return std::numbers::ln10_v<lane_type_t<T>>;
  } else {
    return T(log(T(10)));
  }
}

/// 2/√π
template <Real T>
[[nodiscard]] T two_over_sqrt_pi() {
  if constexpr (std::floating_point<lane_type_t<T>>) {
    return 2 * std::numbers::inv_sqrtpi_v<lane_type_t<T>>;
  } else {
    return T(2 / sqrt(pi<T>()));
  }
}

} // namespace duet::constant
