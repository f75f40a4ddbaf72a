// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/vector_sine_cosine.hpp>
#include <duet/core/config.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <utility>

/// \file
/// Several sines and cosines at once.

namespace duet::expression::detail {

/// Two doubles and more are taken in vectors.
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
  /// More of them would be more code than processors keep decoded.
  static constexpr std::size_t most_in_line = 8;
  typedef double packet __attribute__((vector_size(lanes * sizeof(double))));

  template <std::size_t... K>
  DUET_ALWAYS_INLINE void take(const std::array<double, lanes * vectors>& x,
                               std::index_sequence<K...>) {
    if constexpr (vectors > most_in_line) {
      for (std::size_t k = 0; k < vectors; ++k) {
        values_[k] = duet::detail::vector_sine_and_cosine(packet_of(x, k));
      }
    } else {
      ((values_[K] = duet::detail::vector_sine_and_cosine(packet_of(x, K))), ...);
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

  duet::detail::sine_cosine<packet> values_[vectors];
};

} // namespace duet::expression::detail
