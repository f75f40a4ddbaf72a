// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/math.hpp>
#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/rules/sine_cosine.hpp>

/// \file
/// From the rule of a function to the function over infinitesimal numbers.

namespace duet {
namespace rule {

struct sin;
struct cos;
struct sinh;
struct cosh;

} // namespace rule

namespace detail {

template <class Rule, Infinitesimal D, class... Rest>
[[nodiscard]] DUET_ALWAYS_INLINE D lift(const Rule& rule, const D& x, const Rest&... rest) {
  return D::lift(rule, x, rest...);
}
/// Lane by lane.
template <class Rule, class T, int W, class... Rest>
[[nodiscard]] batch<T, W> lift(const Rule& rule, const batch<T, W>& x, const Rest&... rest) {
  return each_lane([&](const auto&... lane) { return rule.value(lane...); }, x, rest...);
}

// One by one the rules of sine and cosine would evaluate both for each.

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

} // namespace detail
} // namespace duet
