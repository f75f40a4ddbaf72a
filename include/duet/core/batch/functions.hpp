// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/batch/lanes.hpp>
#include <duet/core/batch/math.hpp>
#include <duet/core/scalar_traits.hpp>

#include <cmath>
#include <numeric>
#include <type_traits>

/// \file
/// The other functions of `<cmath>` over batches: the C library, lane by lane.

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

/// The batch that two arguments, at least one of them a batch, meet in.
template <class A, class B>
struct common_batch {};
template <class T, int W>
struct common_batch<batch<T, W>, batch<T, W>> {
  using type = batch<T, W>;
};
template <class T, int W, Arithmetic U>
struct common_batch<batch<T, W>, U> {
  using type = batch<T, W>;
};
template <class T, int W, Arithmetic U>
struct common_batch<U, batch<T, W>> {
  using type = batch<T, W>;
};
template <class A, class B>
using common_batch_t = typename common_batch<A, B>::type;

} // namespace detail

template <class T, int W>
[[nodiscard]] batch<T, W> cbrt(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::cbrt(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> exp(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::exp(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> exp2(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::exp2(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> expm1(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::expm1(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> log(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::log(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> log2(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::log2(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> log10(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::log10(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> log1p(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::log1p(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> tan(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::tan(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> asin(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::asin(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> acos(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::acos(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> atan(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::atan(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> sinh(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::sinh(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> cosh(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::cosh(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> tanh(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::tanh(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> asinh(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::asinh(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> acosh(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::acosh(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> atanh(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::atanh(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> erf(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::erf(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> erfc(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::erfc(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> tgamma(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::tgamma(a); }, x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> lgamma(const batch<T, W>& x) {
  return detail::each_lane([](T a) { return std::lgamma(a); }, x);
}
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

template <class A, class B>
[[nodiscard]] detail::common_batch_t<A, B> pow(const A& x, const B& p) {
  using T = typename detail::common_batch_t<A, B>::value_type;
  return detail::each_lane([](T a, T b) { return std::pow(a, b); }, detail::common_batch_t<A, B>(x),
                           p);
}
template <class T, int W>
[[nodiscard]] batch<T, W> atan2(const batch<T, W>& x, const std::type_identity_t<batch<T, W>>& y) {
  return detail::each_lane([](T a, T b) { return std::atan2(a, b); }, x, y);
}
template <class T, int W>
[[nodiscard]] batch<T, W> fmod(const batch<T, W>& x, const std::type_identity_t<batch<T, W>>& y) {
  return detail::each_lane([](T a, T b) { return std::fmod(a, b); }, x, y);
}
template <class T, int W>
[[nodiscard]] batch<T, W> remainder(const batch<T, W>& x,
                                    const std::type_identity_t<batch<T, W>>& y) {
  return detail::each_lane([](T a, T b) { return std::remainder(a, b); }, x, y);
}
template <class T, int W>
[[nodiscard]] batch<T, W> nextafter(const batch<T, W>& x,
                                    const std::type_identity_t<batch<T, W>>& y) {
  return detail::each_lane([](T a, T b) { return std::nextafter(a, b); }, x, y);
}
template <class T, int W, class... Rest>
[[nodiscard]] batch<T, W> hypot(const batch<T, W>& x, const batch<T, W>& y, const Rest&... z) {
  return detail::each_lane([](const auto&... a) { return std::hypot(a...); }, x, y, z...);
}
template <class T, int W>
[[nodiscard]] batch<T, W> fma(const batch<T, W>& x, const batch<T, W>& y, const batch<T, W>& z) {
  return detail::each_lane([](T a, T b, T c) { return std::fma(a, b, c); }, x, y, z);
}
template <class T, int W>
[[nodiscard]] batch<T, W> lerp(const batch<T, W>& a, const batch<T, W>& b, const batch<T, W>& t) {
  return detail::each_lane([](T x, T y, T z) { return std::lerp(x, y, z); }, a, b, t);
}
template <class T, int W>
[[nodiscard]] batch<T, W> midpoint(const batch<T, W>& a, const batch<T, W>& b) {
  return detail::each_lane([](T x, T y) { return std::midpoint(x, y); }, a, b);
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

template <class T, int W>
[[nodiscard]] batch<T, W> copysign(const batch<T, W>& x,
                                   const std::type_identity_t<batch<T, W>>& y) {
  return detail::each_lane([](T a, T b) { return std::copysign(a, b); }, x, y);
}
template <class T, int W>
[[nodiscard]] batch<T, W> fmax(const batch<T, W>& a, const std::type_identity_t<batch<T, W>>& b) {
  return detail::each_lane([](T x, T y) { return std::fmax(x, y); }, a, b);
}
template <class T, int W>
[[nodiscard]] batch<T, W> fmin(const batch<T, W>& a, const std::type_identity_t<batch<T, W>>& b) {
  return detail::each_lane([](T x, T y) { return std::fmin(x, y); }, a, b);
}
template <class T, int W>
[[nodiscard]] batch<T, W> fdim(const batch<T, W>& a, const std::type_identity_t<batch<T, W>>& b) {
  return detail::each_lane([](T x, T y) { return std::fdim(x, y); }, a, b);
}

} // namespace duet
