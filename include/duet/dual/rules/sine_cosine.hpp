// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/functions.hpp>
#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/rules/pure_functions.hpp>

#include <cmath>

/// \file
/// sin x and cos x of one argument, of which a derivative always needs both.

namespace duet::detail {

template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE sine_cosine<T> sine_and_cosine_of(const T& x) {
  if constexpr (lane_traits<T>::is_batch) {
    return sine_cosine_of_batch(x);
  } else {
    return {pure_sin(x), pure_cos(x)};
  }
}

template <class T>
[[nodiscard]] sine_cosine<T> hyperbolic_sine_and_cosine_of(const T& x) {
  using std::cosh;
  using std::sinh;
  return {sinh(x), cosh(x)};
}

/// Sine and cosine of an x whose innermost value has the sine and the cosine y already.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE sine_cosine<T>
sine_and_cosine_from(const sine_cosine<real_type_t<T>>& y, const T& x) {
  if constexpr (Infinitesimal<T>) {
    return T::template lift_pair<-1>(sine_and_cosine_from(y, x.value()), x);
  } else {
    return y;
  }
}

} // namespace duet::detail
