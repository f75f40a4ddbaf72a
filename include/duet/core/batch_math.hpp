// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch.hpp>
#include <duet/core/batch_lanes.hpp>
#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/vector_sine_cosine.hpp>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <numeric>
#include <type_traits>

/// \file
/// The functions of `<cmath>` over batches. sqrt, sin, cos, abs and copysign take all lanes in one
/// step, others call the C library for each lane.

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

template <class T, int W>
struct sine_cosine_batches {
  batch<T, W> sine;
  batch<T, W> cosine;
};

/// By the C library.
template <class T, int W>
[[nodiscard, gnu::noinline]] sine_cosine_batches<T, W> sine_cosine_of_lanes(batch<T, W> x) {
  return {each_lane([](T a) { return std::sin(a); }, x),
          each_lane([](T a) { return std::cos(a); }, x)};
}

/// By the kernel of vector_sine_cosine.hpp, which all lanes must be small enough for.
template <class T, int W>
[[nodiscard]] DUET_ALWAYS_INLINE sine_cosine_batches<T, W>
sine_cosine_of_small(const batch<T, W>& x) {
  using storage = packets<T, W>;
  std::array<vector_sine_cosine_result<typename storage::packet>, std::size_t(storage::count)> both;
  storage::for_each(
      [&](int p) DUET_INLINE_LAMBDA { both[std::size_t(p)] = vector_sine_cosine(x.packet_at(p)); });
  return {batch<T, W>::from_packets([&](int p)
                                        DUET_INLINE_LAMBDA { return both[std::size_t(p)].sine; }),
          batch<T, W>::from_packets(
              [&](int p) DUET_INLINE_LAMBDA { return both[std::size_t(p)].cosine; })};
}

/// Where some lanes are large, infinite or not a number.
template <class T, int W>
[[nodiscard, gnu::noinline, gnu::cold]] sine_cosine_batches<T, W>
sine_cosine_of_mixed(const batch<T, W> x, const lane_mask<T, W> is_small) {
  const auto small = sine_cosine_of_small(blended(is_small, x, batch<T, W>(0)));
  const auto large = sine_cosine_of_lanes(x);
  return {blended(is_small, small.sine, large.sine), blended(is_small, small.cosine, large.cosine)};
}

/// sin x and cos x.
template <class T, int W>
[[nodiscard]] DUET_ALWAYS_INLINE sine_cosine_batches<T, W>
sine_cosine_of_batch(const batch<T, W>& x) {
  if constexpr (std::same_as<T, double> && packets<T, W>::is_vector) {
    const auto is_small = x * x < vector_sine_cosine_limit * vector_sine_cosine_limit;
    if (all(is_small)) [[likely]] {
      return sine_cosine_of_small(x);
    }
    return sine_cosine_of_mixed(x, is_small);
  } else {
    return sine_cosine_of_lanes(x);
  }
}

template <class P>
[[nodiscard]] DUET_ALWAYS_INLINE P root_of_packet(const P& x) {
#if defined(__AVX512F__)
  if constexpr (std::same_as<P, typename packet_type<double, 8>::packet>) {
    return P(_mm512_maskz_sqrt_pd(__mmask8(-1), x));
  }
#endif
#if defined(__AVX__)
  if constexpr (std::same_as<P, typename packet_type<double, 4>::packet>) {
    return P(_mm256_sqrt_pd(x));
  } else if constexpr (std::same_as<P, typename packet_type<float, 8>::packet>) {
    return P(_mm256_sqrt_ps(x));
  }
#endif
#if defined(__SSE2__)
  if constexpr (std::same_as<P, typename packet_type<double, 2>::packet>) {
    return P(_mm_sqrt_pd(x));
  } else if constexpr (std::same_as<P, typename packet_type<float, 4>::packet>) {
    return P(_mm_sqrt_ps(x));
  }
#endif
  P result = x;
  for (int i = 0; i < int(sizeof(P) / sizeof(x[0])); ++i) {
    result[i] = std::sqrt(x[i]);
  }
  return result;
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
[[nodiscard]] DUET_ALWAYS_INLINE batch<T, W> abs(const batch<T, W>& x) {
  return batch<T, W>::from_packets(
      [&](int p) DUET_INLINE_LAMBDA { return detail::absolute_packet(x.packet_at(p)); });
}
template <class T, int W>
[[nodiscard]] DUET_ALWAYS_INLINE batch<T, W> fabs(const batch<T, W>& x) {
  return abs(x);
}
template <class T, int W>
[[nodiscard]] batch<T, W> copysign(const batch<T, W>& x,
                                   const std::type_identity_t<batch<T, W>>& y) {
  return detail::each_lane([](T a, T b) { return std::copysign(a, b); }, x, y);
}
/// The larger, as `std::max`.
template <class T, int W>
[[nodiscard]] DUET_ALWAYS_INLINE batch<T, W> max(const batch<T, W>& a, const batch<T, W>& b) {
  return blended(a < b, b, a);
}
template <class T, int W>
[[nodiscard]] DUET_ALWAYS_INLINE batch<T, W> min(const batch<T, W>& a, const batch<T, W>& b) {
  return blended(b < a, b, a);
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
