// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>

/// \file
/// Zero and ±1 as types, so that products with them vanish at compile time. (A compiler may not
/// leave out 0·x by itself: x could be infinite.)

namespace duet::detail {

template <int N>
struct known_number {
  static_assert(-1 <= N && N <= 1);
  static constexpr int value = N;
};
using known_zero = known_number<0>;
using known_one = known_number<1>;

template <class X>
inline constexpr bool is_known = false;
template <int N>
inline constexpr bool is_known<known_number<N>> = true;
template <class X>
concept Known = is_known<X>;

/// What a component may be multiplied by.
template <class X>
concept Factor = Known<X> || Scalar<X> || Arithmetic<X>;

template <class A, class B>
  requires((Known<A> || Known<B>)&&Factor<A>&& Factor<B>)
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator*(const A& a, const B& b) {
  if constexpr (!Known<A>) {
    return b * a;
  } else if constexpr (Known<B>) {
    return known_number<A::value * B::value>{};
  } else if constexpr (A::value == 0) {
    return a;
  } else if constexpr (A::value > 0) {
    return b;
  } else {
    return B(-b);
  }
}

template <Known A>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator-(const A&) {
  return known_number<-A::value>{};
}

template <class A, class B>
  requires((Known<A> || Known<B>)&&Factor<A>&& Factor<B>)
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator+(const A& a, const B& b) {
  if constexpr (!Known<A>) {
    return b + a;
  } else if constexpr (Known<B>) {
    return known_number<A::value + B::value>{};
  } else if constexpr (A::value == 0) {
    return b;
  } else {
    return B(b + A::value);
  }
}
template <class A, class B>
  requires((Known<A> || Known<B>)&&Factor<A>&& Factor<B>)
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator-(const A& a, const B& b) {
  if constexpr (Known<B>) {
    return a + -b;
  } else if constexpr (A::value == 0) {
    return B(-b);
  } else {
    return B(A::value - b);
  }
}

/// The constant that a stateless callable returns, as a type where that is 0 or ±1.
template <class Get>
[[nodiscard]] constexpr auto known(Get get) {
  constexpr auto value = Get{}();
  if constexpr (value == 0 || value == 1 || value == -1) {
    return known_number<int(value)>{};
  } else {
    return get();
  }
}

/// Any of them as a number.
template <class S, class X>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr S number(const X& x) {
  if constexpr (Known<X>) {
    return S(X::value);
  } else {
    return S(x);
  }
}

} // namespace duet::detail
