// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch_functions.hpp>
#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>

#include <cmath>
#include <concepts>

/// \file
/// sin x and cos x of one argument, of which a derivative always needs both.
///
/// g++ merges the two calls by itself. clang keeps them apart, since each may write errno. Told
/// that nobody looks at that, it makes one call of the two, and of all sines and cosines of one x.

namespace duet::detail {

template <class T>
struct sine_cosine {
  T sine;
  T cosine;
};

#if defined(__clang__) && defined(__GLIBC__)
extern "C" {
[[gnu::const]] double duet_sin(double) noexcept __asm__("sin");
[[gnu::const]] double duet_cos(double) noexcept __asm__("cos");
[[gnu::const]] float duet_sinf(float) noexcept __asm__("sinf");
[[gnu::const]] float duet_cosf(float) noexcept __asm__("cosf");
}
#endif

template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE sine_cosine<T> sine_and_cosine_of(const T& x) {
#if defined(__clang__) && defined(__GLIBC__)
  if constexpr (std::same_as<T, double>) {
    return {duet_sin(x), duet_cos(x)};
  } else if constexpr (std::same_as<T, float>) {
    return {duet_sinf(x), duet_cosf(x)};
  }
#endif
  if constexpr (lane_traits<T>::is_batch) {
    const auto both = sine_cosine_of_batch(x);
    return {both.sine, both.cosine};
  } else {
    using std::cos;
    using std::sin;
    return {T(sin(x)), T(cos(x))};
  }
}

/// The same of an x whose innermost value has the sine and the cosine y already.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE sine_cosine<T>
sine_and_cosine_from(const sine_cosine<real_type_t<T>>& y, const T& x) {
  if constexpr (Infinitesimal<T>) {
    return lift(sine_and_cosine_from(y, x.value()), x);
  } else {
    return y;
  }
}

} // namespace duet::detail
