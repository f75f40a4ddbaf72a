// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/core/compiler/vector.hpp>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

/// \file
/// Sine and cosine of all lanes of a compiler vector of doubles at once, or of several doubles,
/// within one unit of the last place.

namespace duet::detail {

/// sin and cos of one argument: of a number, a batch or the lanes of a vector.
template <class T>
struct sine_cosine {
  T sine;
  T cosine;
};

/// Limit from which, and for infinities and NaN, the C library is used: n below would have too many
/// bits.
inline constexpr double vector_sine_limit = 8e5;

/// A `vector_of<double, W>`.
template <class V>
concept VectorOfDoubles = requires(V v) {
  requires std::same_as < std::remove_cvref_t<decltype(v[0])>,
  double > ;
  v = blended_packets(v < v, v, -v);
};

/// Replaces the lanes that are too large by results of the C library.
template <VectorOfDoubles V>
DUET_OUT_OF_LINE DUET_COLD inline void replace_sines_of_large(const V& x, sine_cosine<V>& y) {
  for (std::size_t i = 0; i < sizeof(V) / sizeof(double); ++i) {
    if (!(std::abs(x[i]) < vector_sine_limit)) {
      y.sine[i] = std::sin(x[i]);
      y.cosine[i] = std::cos(x[i]);
    }
  }
}

/// Sines and cosines of r + tail, |r| ≤ π/4, the tail being the round-off of r.
template <VectorOfDoubles V>
[[nodiscard]] DUET_ALWAYS_INLINE sine_cosine<V> vector_sine_and_cosine_of_reduced(const V& r,
                                                                                  const V& tail) {
  // Minimax polynomials on |r| ≤ π/4, relative errors 3.5e-18 and 5e-20.
  const V z = r * r, z2 = z * z, cube = z * r;
  const V s =
      (0x1.111111110f8a5p-7 - z * 0x1.a01a019c15e6dp-13) +
      z2 * ((0x1.71de357ae42b6p-19 - z * 0x1.ae5e686c75808p-26) + z2 * 0x1.5d93942c9fa1ap-33);
  const V c = (0x1.555555555554cp-5 - z * 0x1.6c16c16c1521ep-10) +
              z2 * ((0x1.a01a019cbf387p-16 - z * 0x1.27e4f8128eacfp-22) +
                    z2 * (0x1.1ee9f1327a1fap-29 - z * 0x1.8fb11e2c1d83cp-37));
  const V half = 0.5 * z;
  const V rounded = 1.0 - half;
  return {r - ((z * (0.5 * tail - cube * s) - tail) + cube * 0x1.5555555555549p-3),
          rounded + (((1.0 - rounded) - half) + (z2 * c - r * tail))};
}

/// Sines and cosines of a vector with all lanes below `vector_sine_limit`; other lanes are
/// undefined.
template <VectorOfDoubles V>
[[nodiscard]] DUET_ALWAYS_INLINE sine_cosine<V> vector_sine_and_cosine_of_moderate(const V& x) {
  // x = n π/2 + r + tail with |r| ≤ π/4. π/2 in three parts of 33 bits, whose products with n are
  // exact, and a rest: also next to a multiple of π/2, where the first parts cancel, r is exact.
  constexpr double round = 0x1.8p52; // leaves n in the lowest bits
  const V shifted = x * 0x1.45f306dc9c883p-1 + round;
  const V n = shifted - round;
  const V w1 = n * 0x1.921fb544p+0, w2 = n * 0x1.0b4611a6p-34, w3 = n * 0x1.3198a2ep-69;
  const V r1 = x - w1;
  const V r2 = r1 - w2;
  const V r3 = r2 - w3;
  // Negative, or −0 would lose its sign.
  const V lost = n * 0x1.b839a252049c1p-104 - (((r1 - r2) - w2) + ((r2 - r3) - w3));
  const V r = r3 - lost;
  const V tail = (r3 - r) - lost;

  const auto [sine, cosine] = vector_sine_and_cosine_of_reduced(r, tail);

  // The quadrant: odd ones swap; the second bit of n is the sign of the sine, that of n + 1 the
  // cosine's.
  // Without comparing integers, which SSE2 cannot do in 64 bits: g++ would branch, lane by lane.
  using bits = decltype(x < x);
  const bits quadrant = with_bits_of<bits>(shifted);
  const bits sine_bits = with_bits_of<bits>(sine), cosine_bits = with_bits_of<bits>(cosine);
  const bits swapped = (sine_bits ^ cosine_bits) & -(quadrant & 1);
  const bits sine_sign = (quadrant << 62) & (bits{} + (1LL << 63));
  const bits cosine_sign = ((quadrant + 1) << 62) & (bits{} + (1LL << 63));
  return {with_bits_of<V>(sine_bits ^ swapped ^ sine_sign),
          with_bits_of<V>(cosine_bits ^ swapped ^ cosine_sign)};
}

template <VectorOfDoubles V>
[[nodiscard]] DUET_ALWAYS_INLINE bool are_all_below(const V& x, double limit) {
  const auto below = x < limit;
  auto all = below[0];
  for (std::size_t i = 1; i < sizeof(V) / sizeof(double); ++i) {
    all &= below[i];
  }
  return all != 0;
}

/// sin x and cos x, lane by lane, accurate to one unit in the last place.
template <VectorOfDoubles V>
[[nodiscard]] DUET_ALWAYS_INLINE sine_cosine<V> vector_sine_and_cosine(const V& x) {
#ifdef __FAST_MATH__ // would drop the terms that the reduction compensates
  sine_cosine<V> y{};
  for (std::size_t i = 0; i < sizeof(V) / sizeof(double); ++i) {
    y.sine[i] = std::sin(x[i]);
    y.cosine[i] = std::cos(x[i]);
  }
#else
  using bits = decltype(x < x);
  const V size = with_bits_of<V>(with_bits_of<bits>(x) & (bits{} + ~(1LL << 63)));
  if (are_all_below(size, 0x1.921fb54442d18p-1)) { // π/4: nothing to reduce
    // Compilers drop a subtracted 0, but not −0, and then fuse other products with sums than above:
    // a lane would depend on its neighbours in the last bit.
    return vector_sine_and_cosine_of_reduced(x, -V{});
  }
  sine_cosine<V> y = vector_sine_and_cosine_of_moderate(x);
  if (!are_all_below(size, vector_sine_limit)) [[unlikely]] {
    replace_sines_of_large(x, y);
  }
#endif
  return y;
}

/// True if the sines and cosines are computed in vectors: for two doubles and more.
template <class... T>
inline constexpr bool takes_sines_at_once = sizeof...(T) > 1 && (std::same_as<T, double> && ...);

/// Sines and cosines of Count numbers, in vectors of four, which eight would not make faster.
template <std::size_t Count>
class sines_at_once {
public:
  template <class... T>
  DUET_ALWAYS_INLINE explicit sines_at_once(const T&... x) {
    const std::array<double, lanes* vectors> all = {x...};
    take(all, std::make_index_sequence<vectors>{});
  }
  [[nodiscard]] DUET_ALWAYS_INLINE double sine(int i) const {
    return values_[std::size_t(i) / lanes].sine[i % lanes];
  }
  [[nodiscard]] DUET_ALWAYS_INLINE double cosine(int i) const {
    return values_[std::size_t(i) / lanes].cosine[i % lanes];
  }

private:
  static constexpr int lanes = DUET_VECTOR_BYTES < 32 ? 2 : 4;
  static constexpr std::size_t vectors = (Count + lanes - 1) / lanes;
  /// Maximum number of vectors computed inline: more code would exceed the instructions that
  /// processors keep decoded.
  static constexpr std::size_t max_inline = 8;
  using packet = vector_of<double, lanes>;

  template <std::size_t... K>
  DUET_ALWAYS_INLINE void take(const std::array<double, lanes * vectors>& x,
                               std::index_sequence<K...>) {
    if constexpr (vectors > max_inline) {
      for (std::size_t k = 0; k < vectors; ++k) {
        values_[k] = vector_sine_and_cosine(packet_of(x, k));
      }
    } else {
      ((values_[K] = vector_sine_and_cosine(packet_of(x, K))), ...);
    }
  }
  DUET_ALWAYS_INLINE static packet packet_of(const std::array<double, lanes * vectors>& x,
                                             std::size_t k) {
    // One by one: a wide load right after narrow stores waits for them (a third of a gradient).
    if constexpr (lanes == 2) {
      return packet{x[2 * k], x[2 * k + 1]};
    } else {
      return packet{x[4 * k], x[4 * k + 1], x[4 * k + 2], x[4 * k + 3]};
    }
  }

  sine_cosine<packet> values_[vectors];
};

} // namespace duet::detail
