// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

/// \file
/// Splitting batches into lanes and joining lanes to batches: for code with too many branches to
/// take all lanes in one step, and for tables. All functions reach the scalars inside any object by
/// `structure`, and infinitesimal numbers by their parts.

namespace duet {

/// x in lane i; an x without batches is the same in all lanes.
template <class X>
  requires(Structured<X> || std::is_enum_v<X>)
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto lane(const X& x, [[maybe_unused]] int i) {
  const auto of_part = [i](const auto& part) DUET_INLINE_LAMBDA { return lane(part, i); };
  if constexpr (lane_traits<X>::is_batch) {
    return x[i];
  } else if constexpr (Infinitesimal<X> && Batched<X>) {
    return x.zip(of_part);
  } else if constexpr (Scalar<X> || Arithmetic<X> || std::is_enum_v<X>) {
    return x;
  } else {
    return map_scalars(of_part, x);
  }
}

namespace detail {

/// The object over batches that has x… in its lanes.
template <class X, class... Rest>
[[nodiscard]] DUET_ALWAYS_INLINE auto joined(const X& x, const Rest&... rest) {
  const auto of_parts = [](const auto&... part) DUET_INLINE_LAMBDA { return joined(part...); };
  if constexpr (Arithmetic<X>) {
    const X lanes[] = {x, rest...};
    return batch<X, 1 + int(sizeof...(Rest))>::from_lanes(
        [&](int i) DUET_INLINE_LAMBDA { return lanes[i]; });
  } else if constexpr (Infinitesimal<X>) {
    return x.zip(of_parts, rest...);
  } else {
    return map_scalars(of_parts, x, rest...);
  }
}

} // namespace detail

/// The object over batches whose lane i of W is get(i).
template <std::size_t W, class Get>
[[nodiscard]] DUET_ALWAYS_INLINE auto from_lanes(const Get& get) {
  return [&]<std::size_t... I>(std::index_sequence<I...>) DUET_INLINE_LAMBDA {
    return detail::joined(get(I)...);
  }
  (std::make_index_sequence<W>{});
}

/// a in the lanes that are set in the mask, b in the others.
template <class T, int W, class X>
[[nodiscard]] DUET_ALWAYS_INLINE X blended(const lane_mask<T, W>& m, const X& a, const X& b) {
  const auto of_parts = [&](const auto& p, const auto& q)
                            DUET_INLINE_LAMBDA { return blended(m, p, q); };
  if constexpr (Infinitesimal<X>) {
    return a.zip(of_parts, b);
  } else {
    return map_scalars(of_parts, a, b);
  }
}

/// Number of lanes of the scalars in an object.
template <class X>
inline constexpr int lane_count = lane_traits<real_type_t<typename structure<X>::scalar>>::lanes;

namespace detail {

/// The first `count` numbers in memory, then repeats the last of them: surplus lanes at the end of
/// a range must not matter.
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
  return from_lanes<W>([&](std::size_t k)
                           DUET_INLINE_LAMBDA -> const auto& { return row[indices[k]]; });
}

/// f of the lanes of the arguments one after the other, the results joined again; each is that of
/// plain numbers. For arguments without lanes it is f itself.
template <class F, class... X>
[[nodiscard]] auto by_lane(const F& f, const X&... x) {
  constexpr int width = std::max({lane_count<X>...});
  if constexpr (width == 1) {
    return f(x...);
  } else {
    using result = std::decay_t<decltype(f(lane(x, 0)...))>;
    std::array<result, std::size_t(width)> results;
    for (int i = 0; i < width; ++i) {
      results[std::size_t(i)] = f(lane(x, i)...);
    }
    return from_lanes<std::size_t(width)>(
        [&](std::size_t i) DUET_INLINE_LAMBDA -> const result& { return results[i]; });
  }
}

} // namespace detail
} // namespace duet
