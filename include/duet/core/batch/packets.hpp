// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/core/compiler/instructions.hpp>
#include <duet/core/compiler/lane_array.hpp>
#include <duet/core/compiler/vector.hpp>

#include <concepts>
#include <utility>

/// \file
/// Storage of batches: vectors of the target's width, or arrays.

namespace duet::detail {

template <class T>
inline constexpr int native_lanes = 1;
template <>
inline constexpr int native_lanes<float> = DUET_BATCH_BYTES / int(sizeof(float));
template <>
inline constexpr int native_lanes<double> = DUET_BATCH_BYTES / int(sizeof(double));

/// One packet of W lanes of T.
template <class T, int W>
struct packet_type {
  using type = lane_array<T, W>;
};
template <class T, int W>
  requires(W > 1 && (std::same_as<T, float> || std::same_as<T, double>))
struct packet_type<T, W> {
  using type = vector_of<T, W>;
};

/// Storage of W lanes of T: `count` packets of `width` lanes.
template <class T, int W>
struct packets {
  static constexpr int width = native_lanes<T> > 1 && W > native_lanes<T> ? native_lanes<T> : W;
  static constexpr int count = W / width;
  using packet = typename packet_type<T, width>::type;
  using mask = decltype(packet{} == packet{});

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

} // namespace duet::detail
