// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/batch/vector_sine_cosine.hpp>
#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <type_traits>

/// \file
/// Functions of batches. Square root, sine and cosine, absolute value and extremes take all lanes
/// in one step; rounding, scaling and classification are the C library's, lane by lane. (The smooth
/// functions are those of every lifted number, see dual/rules/functions.hpp.)

namespace duet {
namespace detail {

/// f of every lane.
template <class F, class T, int W, class... Rest>
[[nodiscard]] batch<T, W> each_lane(const F& f, const batch<T, W>& x, const Rest&... rest) {
  batch<T, W> result;
  for (int i = 0; i < W; ++i) {
    result.set(i, static_cast<T>(f(x[i], lane(rest, i)...)));
  }
  return result;
}

/// Sine and cosine by the C library, lane by lane.
template <class T, int W>
[[nodiscard]] DUET_OUT_OF_LINE sine_cosine<batch<T, W>> sine_cosine_of_lanes(batch<T, W> x) {
  return {each_lane([](T a) { return std::sin(a); }, x),
          each_lane([](T a) { return std::cos(a); }, x)};
}

/// Sine and cosine by the kernel of vector_sine_cosine.hpp, for which all lanes must be small
/// enough.
template <class T, int W>
[[nodiscard]] DUET_ALWAYS_INLINE sine_cosine<batch<T, W>>
sine_cosine_of_small(const batch<T, W>& x) {
  using storage = packets<T, W>;
  std::array<sine_cosine<typename storage::packet>, std::size_t(storage::count)> both;
  storage::for_each([&](int p) DUET_INLINE_LAMBDA {
    both[std::size_t(p)] = vector_sine_and_cosine_of_moderate(x.packet_at(p));
  });
  return {batch<T, W>::from_packets([&](int p)
                                        DUET_INLINE_LAMBDA { return both[std::size_t(p)].sine; }),
          batch<T, W>::from_packets(
              [&](int p) DUET_INLINE_LAMBDA { return both[std::size_t(p)].cosine; })};
}

/// Sine and cosine if some lanes are large, infinite or not a number.
template <class T, int W>
[[nodiscard]] DUET_OUT_OF_LINE DUET_COLD sine_cosine<batch<T, W>>
sine_cosine_of_mixed(const batch<T, W> x, const lane_mask<T, W> is_small) {
  const auto little = sine_cosine_of_small(blended(is_small, x, batch<T, W>(0)));
  const auto large = sine_cosine_of_lanes(x);
  return {blended(is_small, little.sine, large.sine),
          blended(is_small, little.cosine, large.cosine)};
}

/// sin x and cos x.
template <class T, int W>
[[nodiscard]] DUET_ALWAYS_INLINE sine_cosine<batch<T, W>>
sine_cosine_of_batch(const batch<T, W>& x) {
  if constexpr (std::same_as<T, double> && packets<T, W>::width > 1) {
    const auto is_small = x * x < vector_sine_limit * vector_sine_limit;
    if (all(is_small)) [[likely]] {
      return sine_cosine_of_small(x);
    }
    return sine_cosine_of_mixed(x, is_small);
  } else {
    return sine_cosine_of_lanes(x);
  }
}

/// x without its sign bit.
template <class P>
[[nodiscard]] DUET_ALWAYS_INLINE P absolute_packet(const P& x) {
  if constexpr (std::is_class_v<P>) {
    return P::map([](const auto& a) { return std::abs(a); }, x);
  } else {
    using bits = decltype(x == x);
    const P negative_zero = -P{};
    bits sign, value;
    std::memcpy(&sign, &negative_zero, sizeof(P));
    std::memcpy(&value, &x, sizeof(P));
    value &= ~sign;
    P result;
    std::memcpy(&result, &value, sizeof(P));
    return result;
  }
}

} // namespace detail

/// The function of `<cmath>`, lane by lane.
template <class T, int W>
[[nodiscard]] DUET_ALWAYS_INLINE batch<T, W> sqrt(const batch<T, W>& x) {
  return batch<T, W>::from_packets(
      [&](int p) DUET_INLINE_LAMBDA { return detail::root_of_packet(x.packet_at(p)); });
}
template <class T, int W>
[[nodiscard]] DUET_ALWAYS_INLINE batch<T, W> sin(const batch<T, W>& x) {
  return detail::sine_cosine_of_batch(x).sine;
}
template <class T, int W>
[[nodiscard]] DUET_ALWAYS_INLINE batch<T, W> cos(const batch<T, W>& x) {
  return detail::sine_cosine_of_batch(x).cosine;
}

/// Absolute value of the number in each lane.
template <class T, int W>
[[nodiscard]] DUET_ALWAYS_INLINE batch<T, W> abs(const batch<T, W>& x) {
  return batch<T, W>::from_packets(
      [&](int p) DUET_INLINE_LAMBDA { return detail::absolute_packet(x.packet_at(p)); });
}
template <class T, int W>
[[nodiscard]] DUET_ALWAYS_INLINE batch<T, W> fabs(const batch<T, W>& x) {
  return abs(x);
}
/// The larger number in each lane, as `std::max`.
template <class T, int W>
[[nodiscard]] DUET_ALWAYS_INLINE batch<T, W> max(const batch<T, W>& a, const batch<T, W>& b) {
  return blended(a < b, b, a);
}
/// The smaller number in each lane, as `std::min`.
template <class T, int W>
[[nodiscard]] DUET_ALWAYS_INLINE batch<T, W> min(const batch<T, W>& a, const batch<T, W>& b) {
  return blended(b < a, b, a);
}

namespace detail {

template <class F, class T, int W>
[[nodiscard]] lane_mask<T, W> test_lanes(const F& f, const batch<T, W>& x) {
  lane_mask<T, W> result;
  for (int i = 0; i < W; ++i) {
    result.set(i, f(x[i]));
  }
  return result;
}

} // namespace detail

/// The function of `<cmath>`, lane by lane.
template <class T, int W>
[[nodiscard]] batch<T, W> floor(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::floor(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> ceil(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::ceil(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> trunc(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::trunc(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> round(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::round(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> rint(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::rint(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> nearbyint(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::nearbyint(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> logb(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::logb(a); }, x);
}

/// The function of `<cmath>`, lane by lane.
template <class T, int W>
[[nodiscard]] batch<T, W> nextafter(const batch<T, W>& x,
                                    const std::type_identity_t<batch<T, W>>& y) {
  return detail::each_lane([](T a, T b) { return std::nextafter(a, b); }, x, y);
}
template <class T, int W>
[[nodiscard]] batch<T, W> ldexp(const batch<T, W>& x, int exponent) {
  return detail::each_lane([exponent](T a) { return std::ldexp(a, exponent); }, x);
}

/// Classification by `<cmath>` of the number in each lane.
template <class T, int W>
[[nodiscard]] lane_mask<T, W> signbit(const batch<T, W>& x) {
  return detail::test_lanes([](T a) { return std::signbit(a); }, x);
}
template <class T, int W>
[[nodiscard]] lane_mask<T, W> isfinite(const batch<T, W>& x) {
  return detail::test_lanes([](T a) { return std::isfinite(a); }, x);
}
template <class T, int W>
[[nodiscard]] lane_mask<T, W> isinf(const batch<T, W>& x) {
  return detail::test_lanes([](T a) { return std::isinf(a); }, x);
}
template <class T, int W>
[[nodiscard]] lane_mask<T, W> isnan(const batch<T, W>& x) {
  return detail::test_lanes([](T a) { return std::isnan(a); }, x);
}
template <class T, int W>
[[nodiscard]] lane_mask<T, W> isnormal(const batch<T, W>& x) {
  return detail::test_lanes([](T a) { return std::isnormal(a); }, x);
}

} // namespace duet
