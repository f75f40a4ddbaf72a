// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>

#include <type_traits>

/// \file
/// Zero and ±1 as types, so that products with them vanish at compile time. (A compiler may not
/// leave out 0·x by itself: x could be infinite.)

namespace duet::detail {

struct known_zero {};
template <int Sign>
struct known_unit {};

template <class X>
inline constexpr int sign_if_unit = 0;
template <int Sign>
inline constexpr int sign_if_unit<known_unit<Sign>> = Sign;

template <class X>
inline constexpr bool is_known_zero = std::is_same_v<X, known_zero>;
template <class X>
concept Known = is_known_zero<X> || sign_if_unit<X>
!= 0;
/// What a component may be multiplied by.
template <class X>
concept Factor = Known<X> || Scalar<X> || Arithmetic<X>;

template <class A, class B>
  requires((Known<A> || Known<B>)&&Factor<A>&& Factor<B>)
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator*(const A& a, const B& b) {
  if constexpr (is_known_zero<A> || is_known_zero<B>) {
    return known_zero{};
  } else if constexpr (Known<A> && Known<B>) {
    return known_unit<sign_if_unit<A> * sign_if_unit<B>>{};
  } else if constexpr (sign_if_unit<A> == 1) {
    return b;
  } else if constexpr (sign_if_unit<B> == 1) {
    return a;
  } else if constexpr (sign_if_unit<A> == -1) {
    return B(-b);
  } else {
    return A(-a);
  }
}

template <Known A>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator-(const A&) {
  if constexpr (is_known_zero<A>) {
    return known_zero{};
  } else {
    return known_unit<-sign_if_unit<A>>{};
  }
}

template <class A, class B>
  requires((Known<A> || Known<B>)&&Factor<A>&& Factor<B>)
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator+(const A& a, const B& b) {
  if constexpr (is_known_zero<A>) {
    return b;
  } else if constexpr (is_known_zero<B>) {
    return a;
  } else if constexpr (Known<A>) {
    static_assert(!Known<B>);
    return B(b + sign_if_unit<A>);
  } else {
    return A(a + sign_if_unit<B>);
  }
}
template <class A, class B>
  requires((Known<A> || Known<B>)&&Factor<A>&& Factor<B>)
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator-(const A& a, const B& b) {
  if constexpr (is_known_zero<B>) {
    return a;
  } else if constexpr (is_known_zero<A>) {
    return std::decay_t<decltype(-b)>(-b);
  } else if constexpr (Known<A>) {
    static_assert(!Known<B>);
    return B(sign_if_unit<A> - b);
  } else {
    return A(a - sign_if_unit<B>);
  }
}

/// The constant that a stateless callable returns, as a type where that is 0 or ±1.
template <class Get>
[[nodiscard]] constexpr auto known(Get get) {
  constexpr auto value = Get{}();
  if constexpr (value == 0) {
    return known_zero{};
  } else if constexpr (value == 1) {
    return known_unit<1>{};
  } else if constexpr (value == -1) {
    return known_unit<-1>{};
  } else {
    return get();
  }
}

/// Any of them as a number.
template <class S, class X>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr S number(const X& x) {
  if constexpr (is_known_zero<X>) {
    return S(0);
  } else if constexpr (Known<X>) {
    return S(sign_if_unit<X>);
  } else {
    return S(x);
  }
}

} // namespace duet::detail
