// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

// The whole of it costs a compiler a third of what Eigen/Core does.
#if defined(__AVX__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

/// \file
/// What batches are made of: the compilers' vectors of the width that the target has, or arrays.

namespace duet::detail {

template <class T>
inline constexpr int native_lanes = 1;
template <>
inline constexpr int native_lanes<float> = DUET_BATCH_BYTES / int(sizeof(float));
template <>
inline constexpr int native_lanes<double> = DUET_BATCH_BYTES / int(sizeof(double));

/// As many elements as a vector, with the same operators, for types that there are no vectors of.
template <class T, int W>
struct array_packet {
  std::array<T, std::size_t(W)> elements;

  template <class... U>
  array_packet(const U&... x) : elements{x...} {}
  const T& operator[](int i) const { return elements[std::size_t(i)]; }
  T& operator[](int i) { return elements[std::size_t(i)]; }

  template <class F, class... Rows>
  static auto map(F&& f, const Rows&... rows) {
    array_packet<decltype(f(rows[0]...)), W> result;
    for (int i = 0; i < W; ++i) {
      result[i] = f(rows[i]...);
    }
    return result;
  }
  friend array_packet operator-(const array_packet& a) {
    return map([](T x) { return -x; }, a);
  }
  friend array_packet operator+(const array_packet& a, const array_packet& b) {
    return map([](T x, T y) { return x + y; }, a, b);
  }
  friend array_packet operator-(const array_packet& a, const array_packet& b) {
    return map([](T x, T y) { return x - y; }, a, b);
  }
  friend array_packet operator*(const array_packet& a, const array_packet& b) {
    return map([](T x, T y) { return x * y; }, a, b);
  }
  friend array_packet operator/(const array_packet& a, const array_packet& b) {
    return map([](T x, T y) { return x / y; }, a, b);
  }
  friend auto operator==(const array_packet& a, const array_packet& b) {
    return map([](T x, T y) { return x == y ? -1 : 0; }, a, b);
  }
  friend auto operator!=(const array_packet& a, const array_packet& b) {
    return map([](T x, T y) { return x != y ? -1 : 0; }, a, b);
  }
  friend auto operator<(const array_packet& a, const array_packet& b) {
    return map([](T x, T y) { return x < y ? -1 : 0; }, a, b);
  }
  friend auto operator<=(const array_packet& a, const array_packet& b) {
    return map([](T x, T y) { return x <= y ? -1 : 0; }, a, b);
  }
  friend array_packet operator~(const array_packet& a) {
    return map([](T x) { return ~x; }, a);
  }
  friend array_packet operator&(const array_packet& a, const array_packet& b) {
    return map([](T x, T y) { return x & y; }, a, b);
  }
  friend array_packet operator|(const array_packet& a, const array_packet& b) {
    return map([](T x, T y) { return x | y; }, a, b);
  }
  friend array_packet operator^(const array_packet& a, const array_packet& b) {
    return map([](T x, T y) { return x ^ y; }, a, b);
  }
};

/// One packet, of W lanes of T, and its masks: all bits of a lane are set, or none.
template <class T, int W>
struct packet_type {
  using packet = array_packet<T, W>;
  using mask = array_packet<int, W>;
};
#if defined(__GNUC__)
template <class T, int W>
  requires(W > 1 && (std::same_as<T, float> || std::same_as<T, double>))
struct packet_type<T, W> {
  typedef T packet __attribute__((vector_size(W * sizeof(T))));
  using mask = decltype(packet{} == packet{});
};
#endif

/// How W lanes of T are kept: in `count` packets of `width` lanes.
template <class T, int W>
struct packets {
  static constexpr int width = native_lanes<T> > 1 && W > native_lanes<T> ? native_lanes<T> : W;
  static constexpr int count = W / width;
  using packet = typename packet_type<T, width>::packet;
  using mask = typename packet_type<T, width>::mask;
  static constexpr bool is_vector = !std::is_class_v<packet>;

  template <class F>
  DUET_ALWAYS_INLINE static void for_each(F&& f) {
    [&]<int... P>(std::integer_sequence<int, P...>) DUET_INLINE_LAMBDA { (f(P), ...); }
    (std::make_integer_sequence<int, count>{});
  }
  [[nodiscard]] DUET_ALWAYS_INLINE static packet broadcast(T x) {
    return [&]<int... I>(std::integer_sequence<int, I...>) DUET_INLINE_LAMBDA {
      return packet{((void)I, x)...};
    }
    (std::make_integer_sequence<int, width>{});
  }
};

/// Is any lane of a mask set?
template <class Mask>
[[nodiscard]] DUET_ALWAYS_INLINE bool any_lane(const Mask& m) {
#if defined(__AVX512F__)
  if constexpr (sizeof(m) == 64 && !std::is_class_v<Mask>) {
    return _mm512_test_epi64_mask(__m512i(m), __m512i(m)) != 0;
  } else
#endif
#if defined(__AVX__)
      if constexpr (sizeof(m) == 32 && !std::is_class_v<Mask>) {
    return !_mm256_testz_si256(__m256i(m), __m256i(m));
  } else
#endif
#if defined(__SSE2__)
      if constexpr (sizeof(m) == 16 && !std::is_class_v<Mask>) {
    return _mm_movemask_epi8(__m128i(m)) != 0;
  } else
#endif
  {
    constexpr int width = int(sizeof(m) / sizeof(m[0]));
    auto bits = m[0];
    for (int i = 1; i < width; ++i) {
      bits = bits | m[i];
    }
    return bits != 0;
  }
}

/// a where the mask is set, b elsewhere.
template <class Mask, class P>
[[nodiscard]] DUET_ALWAYS_INLINE P blended_packets(const Mask& m, const P& a, const P& b) {
  if constexpr (std::is_class_v<P>) {
    return P::map([](int choice, const auto& x, const auto& y) { return choice ? x : y; }, m, a, b);
  } else {
    return m ? a : b;
  }
}

} // namespace duet::detail
