// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>

/// \file
/// Zero and ±1 as types, so that products with them vanish at compile time. (A compiler may not
/// drop 0·x by itself: x could be infinite.)

namespace duet::detail {

template <int N>
struct static_number {
  static_assert(-1 <= N && N <= 1);
};
using known_zero = static_number<0>;
using known_one = static_number<1>;

template <class X>
concept Number = Scalar<X> || Arithmetic<X>;

template <int N, int M>
[[nodiscard]] constexpr auto operator*(static_number<N>, static_number<M>) {
  return static_number<N * M>{};
}
template <int N, Number B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator*(static_number<N> zero, const B& b) {
  if constexpr (N == 0) {
    return zero;
  } else if constexpr (N > 0) {
    return b;
  } else {
    return B(-b);
  }
}
template <Number A, int N>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator*(const A& a, static_number<N> n) {
  return n * a;
}

template <int N>
[[nodiscard]] constexpr auto operator-(static_number<N>) {
  return static_number<-N>{};
}

template <int N, int M>
[[nodiscard]] constexpr auto operator+(static_number<N>, static_number<M>) {
  return static_number<N + M>{};
}
template <Number A, int N>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator+(const A& a, static_number<N>) {
  if constexpr (N == 0) {
    return a;
  } else {
    return A(a + N);
  }
}
template <int N, Number B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator+(static_number<N> n, const B& b) {
  return b + n;
}

template <class A, int N>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator-(const A& a, static_number<N> n) {
  return a + -n;
}
template <int N, Number B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator-(static_number<N>, const B& b) {
  if constexpr (N == 0) {
    return B(-b);
  } else {
    return B(N - b);
  }
}

/// The constant returned by a stateless callable, as a type if it is 0 or ±1.
template <class Get>
[[nodiscard]] constexpr auto known(Get get) {
  constexpr auto value = Get{}();
  if constexpr (value == 0 || value == 1 || value == -1) {
    return static_number<int(value)>{};
  } else {
    return get();
  }
}

/// Conversion of any of them to a number.
template <class S, class X>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr S number(const X& x) {
  return S(x);
}
template <class S, int N>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr S number(static_number<N>) {
  return S(N);
}

} // namespace duet::detail
