// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

/// \file
/// Vectors in plain C++20.

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

} // namespace duet::detail
