// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/batch/lanes.hpp>
#include <duet/core/batch/math.hpp>
#include <duet/core/scalar_traits.hpp>

#include <cmath>
#include <type_traits>

/// \file
/// Rounding, scaling and classification of batches: the C library, lane by lane. (The smooth
/// functions are those of every lifted number, see dual/rules/functions.hpp.)

namespace duet {
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

template <class T, int W>
[[nodiscard]] batch<T, W> nextafter(const batch<T, W>& x,
                                    const std::type_identity_t<batch<T, W>>& y) {
  return detail::each_lane([](T a, T b) { return std::nextafter(a, b); }, x, y);
}
template <class T, int W>
[[nodiscard]] batch<T, W> ldexp(const batch<T, W>& x, int exponent) {
  return detail::each_lane([exponent](T a) { return std::ldexp(a, exponent); }, x);
}

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
