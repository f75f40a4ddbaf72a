// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/math.hpp>
#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/rules/elementary.hpp>

#include <cmath>

/// \file
/// Lifts the rule of a function to the function over infinitesimal numbers, and sin x together with
/// cos x, as each derivative needs both.

namespace duet::rule {

struct sinh;
struct cosh;

} // namespace duet::rule

namespace duet::detail {

template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE sine_cosine<T> sine_and_cosine_of(const T& x) {
  if constexpr (lane_traits<T>::is_batch) {
    return sine_cosine_of_batch(x);
  } else {
    return {pure_sin(x), pure_cos(x)};
  }
}

template <class T>
[[nodiscard]] sine_cosine<T> hyperbolic_sine_and_cosine_of(const T& x) {
  using std::cosh;
  using std::sinh;
  return {sinh(x), cosh(x)};
}

/// Sine and cosine of x, given those of its innermost value as y.
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE sine_cosine<T>
sine_and_cosine_from(const sine_cosine<real_type_t<T>>& y, const T& x) {
  if constexpr (Infinitesimal<T>) {
    return T::template lift_pair<-1>(sine_and_cosine_from(y, x.value()), x);
  } else {
    return y;
  }
}

template <class Rule, Infinitesimal D, class... Rest>
[[nodiscard]] DUET_ALWAYS_INLINE D lift(const Rule& rule, const D& x, const Rest&... rest) {
  return D::lift(rule, x, rest...);
}
/// Lane by lane.
template <class Rule, class T, int W, class... Rest>
[[nodiscard]] batch<T, W> lift(const Rule& rule, const batch<T, W>& x, const Rest&... rest) {
  return each_lane([&](const auto&... lane) { return rule.value(lane...); }, x, rest...);
}

// Applied separately, the rules of sine and cosine would each evaluate both.

template <Infinitesimal D>
[[nodiscard]] DUET_ALWAYS_INLINE D lift(const rule::sin&, const D& x) {
  return D::template lift_pair<-1>(sine_and_cosine_of(x.value()), x).sine;
}
template <Infinitesimal D>
[[nodiscard]] DUET_ALWAYS_INLINE D lift(const rule::cos&, const D& x) {
  return D::template lift_pair<-1>(sine_and_cosine_of(x.value()), x).cosine;
}
template <Infinitesimal D>
[[nodiscard]] D lift(const rule::sinh&, const D& x) {
  return D::template lift_pair<1>(hyperbolic_sine_and_cosine_of(x.value()), x).sine;
}
template <Infinitesimal D>
[[nodiscard]] D lift(const rule::cosh&, const D& x) {
  return D::template lift_pair<1>(hyperbolic_sine_and_cosine_of(x.value()), x).cosine;
}

} // namespace duet::detail
