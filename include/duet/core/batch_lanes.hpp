// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch.hpp>
#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>

/// \file
/// Batches taken apart into lanes and put together again: for what has too many branches to take
/// all lanes in one step, and for tables. Every object that holds scalars has its own `lane`,
/// `joined_lanes` and `blended`.

namespace duet {

/// x as its lane i has it; what is no batch is the same in all.
template <class X>
  requires(Arithmetic<X> || std::is_enum_v<X>)
[[nodiscard]] DUET_ALWAYS_INLINE constexpr X lane(const X& x, int) { return x; }
template <class T, int W>
[[nodiscard]] DUET_ALWAYS_INLINE T lane(const batch<T, W>& x, int i) {
  return x[i];
}

/// A number of lanes as an argument.
template <int W>
struct lane_width {};

/// One batch of W numbers, the i-th of which is get(i), with `pattern` as an example of one.
template <int W, Arithmetic T, class Get>
[[nodiscard]] DUET_ALWAYS_INLINE batch<T, W> joined_lanes(lane_width<W>, const T&, const Get& get) {
  return batch<T, W>::from_lanes(get);
}

template <class X, std::size_t N>
[[nodiscard]] DUET_ALWAYS_INLINE auto lane(const std::array<X, N>& x, int i) {
  std::array<std::decay_t<decltype(lane(x[0], i))>, N> result;
  for (std::size_t k = 0; k < N; ++k) {
    result[k] = lane(x[k], i);
  }
  return result;
}
template <int W, class X, std::size_t N, class Get>
[[nodiscard]] DUET_ALWAYS_INLINE auto joined_lanes(lane_width<W>, const std::array<X, N>& pattern,
                                                   const Get& get) {
  const auto element = [&](std::size_t k) DUET_INLINE_LAMBDA {
    return joined_lanes(lane_width<W>{}, pattern[k],
                        [&](int i) DUET_INLINE_LAMBDA { return get(i)[k]; });
  };
  std::array<decltype(element(0)), N> result;
  for (std::size_t k = 0; k < N; ++k) {
    result[k] = element(k);
  }
  return result;
}
template <class T, int W, class X, std::size_t N>
[[nodiscard]] DUET_ALWAYS_INLINE std::array<X, N>
blended(const lane_mask<T, W>& m, const std::array<X, N>& a, const std::array<X, N>& b) {
  std::array<X, N> result;
  for (std::size_t i = 0; i < N; ++i) {
    result[i] = blended(m, a[i], b[i]);
  }
  return result;
}

/// How many lanes the scalars in an object have.
template <class X>
inline constexpr int lane_count = lane_traits<real_type_t<X>>::lanes;

namespace detail {

/// The first `count` numbers in memory, and the last of them again beyond: what lanes are left over
/// at the end of a range must not matter.
template <class B>
[[nodiscard]] DUET_ALWAYS_INLINE B load_some(const typename B::value_type* from,
                                             std::size_t count) {
  if (count == std::size_t(B::lanes)) [[likely]] {
    return B::load(from);
  }
  return B::from_lanes([&](int i) { return from[std::min(std::size_t(i), count - 1)]; });
}

/// Elements of a row, one for each lane.
template <std::size_t W, class Row>
[[nodiscard]] DUET_ALWAYS_INLINE auto gathered(const std::array<std::size_t, W>& indices,
                                               const Row& row) {
  return joined_lanes(
      lane_width<int(W)>{}, row[0], [&](int k) DUET_INLINE_LAMBDA -> const auto& {
        return row[indices[std::size_t(k)]];
      });
}

/// f of the lanes of the arguments one after the other, the results put together again; each is
/// that of plain numbers.
template <class F, class... X>
[[nodiscard]] auto by_lane(const F& f, const X&... x) {
  constexpr int width = std::max({lane_count<X>...});
  using result = std::decay_t<decltype(f(lane(x, 0)...))>;
  std::array<result, std::size_t(width)> results;
  for (int i = 0; i < width; ++i) {
    results[std::size_t(i)] = f(lane(x, i)...);
  }
  return joined_lanes(lane_width<width>{}, results[0],
                      [&](int i) -> const result& { return results[std::size_t(i)]; });
}

} // namespace detail
} // namespace duet
