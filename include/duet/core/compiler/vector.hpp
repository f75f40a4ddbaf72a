// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/core/compiler/types.hpp>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

/// \file
/// Vectors of numbers that the compiler computes with lane by lane, in the target's registers; in
/// plain C++20 arrays.

namespace duet::detail {

/// Type of one lane of a comparison of T: all bits set, or no bit.
template <class T>
using lane_answer =
    std::conditional_t<sizeof(T) == sizeof(std::int64_t), std::int64_t, std::int32_t>;

/// W elements with the operators of a compiler's vector, lane by lane: for types without vectors,
/// and for compilers without them.
template <class T, int W>
struct lane_array {
  T lanes[std::size_t(W)];

  constexpr const T& operator[](std::integral auto i) const { return lanes[i]; }
  constexpr T& operator[](std::integral auto i) { return lanes[i]; }

  /// Lane i is f(rows[i]...).
  template <class F, class... Rows>
  static auto map(F&& f, const Rows&... rows) {
    lane_array<decltype(f(rows[0]...)), W> result;
    for (int i = 0; i < W; ++i) {
      result[i] = f(rows[i]...);
    }
    return result;
  }
  static lane_array filled(T x) {
    lane_array result;
    for (T& lane : result.lanes) {
      lane = x;
    }
    return result;
  }

  friend lane_array operator-(const lane_array& a) {
    return map([](T x) { return T(-x); }, a);
  }
  friend lane_array operator~(const lane_array& a) {
    return map([](T x) { return T(~x); }, a);
  }

// Operators of two vectors, and of a vector and a number.
#define DUET_LANE_BY_LANE(op, value)                                                               \
  friend auto operator op(const lane_array& a, const lane_array& b) {                              \
    return map([](T x, T y) { return value; }, a, b);                                              \
  }                                                                                                \
  friend auto operator op(const lane_array& a, T b) { return a op filled(b); }                     \
  friend auto operator op(T a, const lane_array& b) { return filled(a) op b; }
  DUET_LANE_BY_LANE(+, T(x + y))
  DUET_LANE_BY_LANE(-, T(x - y))
  DUET_LANE_BY_LANE(*, T(x* y))
  DUET_LANE_BY_LANE(/, T(x / y))
  DUET_LANE_BY_LANE(&, T(x& y))
  DUET_LANE_BY_LANE(|, T(x | y))
  DUET_LANE_BY_LANE(^, T(x ^ y))
  DUET_LANE_BY_LANE(<<, T(x << y))
  DUET_LANE_BY_LANE(==, lane_answer<T>(x == y ? -1 : 0))
  DUET_LANE_BY_LANE(!=, lane_answer<T>(x != y ? -1 : 0))
  DUET_LANE_BY_LANE(<, lane_answer<T>(x < y ? -1 : 0))
  DUET_LANE_BY_LANE(<=, lane_answer<T>(x <= y ? -1 : 0))
#undef DUET_LANE_BY_LANE
};

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
