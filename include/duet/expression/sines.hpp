// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/vector_sine_cosine.hpp>

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
  typedef double packet __attribute__((vector_size(lanes * sizeof(double))));

  template <std::size_t... K>
  DUET_ALWAYS_INLINE void take(const std::array<double, lanes * vectors>& x,
                               std::index_sequence<K...>) {
    ((values_[K] = duet::detail::vector_sine_and_cosine(packet_of<K>(x))), ...);
  }
  template <std::size_t K>
  DUET_ALWAYS_INLINE static packet packet_of(const std::array<double, lanes * vectors>& x) {
    if constexpr (lanes == 2) {
      return packet{x[2 * K], x[2 * K + 1]};
    } else {
      return packet{x[4 * K], x[4 * K + 1], x[4 * K + 2], x[4 * K + 3]};
    }
  }

  duet::detail::vector_sines_and_cosines<packet> values_[vectors];
};

} // namespace duet::expression::detail
