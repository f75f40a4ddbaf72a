// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/core/compiler/bit_cast.hpp>
#include <duet/core/compiler/lane_array.hpp>

#include <type_traits>

/// \file
/// Vectors of numbers that the compiler computes with lane by lane, in the target's registers; in
/// plain C++20 arrays.

namespace duet::detail {

#ifdef DUET_PORTABLE
template <class T, int W>
struct vector_type {
  using type = lane_array<T, W>;
};
#else
template <class T, int W>
struct vector_type {
  typedef T type __attribute__((vector_size(W * sizeof(T))));
};
#endif

/// W numbers of type T, float or double, with its operators, also between a vector and a number.
/// Comparisons give a vector of integers of that size, with all bits of a lane set or no bit.
template <class T, int W>
using vector_of = typename vector_type<T, W>::type;

/// a in the lanes that are set in the mask, b elsewhere.
template <class Mask, class V>
[[nodiscard]] DUET_ALWAYS_INLINE V blended_packets(const Mask& m, const V& a, const V& b) {
  if constexpr (std::is_class_v<V>) {
    return V::map([](auto choice, const auto& x, const auto& y) { return choice ? x : y; }, m, a,
                  b);
  } else {
    return m ? a : b;
  }
}

/// The bits of a vector of numbers as integers, and back.
template <class To, class From>
[[nodiscard]] DUET_ALWAYS_INLINE To with_bits_of(const From& x) {
#ifdef DUET_PORTABLE
  return detail::bit_cast<To>(x);
#else
  return To(x);
#endif
}

/// Some lanes of a, which are 0 to W − 1, and of b, W to 2 W − 1.
template <int... I, class V>
[[nodiscard]] DUET_ALWAYS_INLINE V lanes_taken(const V& a, const V& b) {
#ifdef DUET_PORTABLE
  constexpr int width = int(sizeof...(I));
  return V{(I < width ? a[I % width] : b[I % width])...};
#else
  return __builtin_shufflevector(a, b, I...);
#endif
}

/// x, or 0 if the factor is 0: without the branch that g++ generates for a conditional expression.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE T unless_zero(T factor, T x) {
#ifndef DUET_PORTABLE
  if constexpr (sizeof(T) <= sizeof(double)) {
    using packet = vector_of<T, int(16 / sizeof(T))>;
    const packet mask = {factor, factor}, numbers = {x, x};
    return (mask != T(0) ? numbers : packet{})[0];
  }
#endif
  return factor == T(0) ? T(0) : x;
}

} // namespace duet::detail
