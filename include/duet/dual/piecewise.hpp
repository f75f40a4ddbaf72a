// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/algebra.hpp>
#include <duet/dual/promotion.hpp>

#include <cmath>

/// \file
/// The functions of `<cmath>` that are linear, constant or chosen piece by piece, over dual and
/// Taylor numbers; and classification. All decide by the innermost value.

namespace duet {

template <infinitesimal D>
[[nodiscard]] bool signbit(const D& x) {
  using std::signbit;
  return signbit(innermost(x));
}
template <infinitesimal D>
[[nodiscard]] bool isfinite(const D& x) {
  using std::isfinite;
  return isfinite(innermost(x));
}
template <infinitesimal D>
[[nodiscard]] bool isinf(const D& x) {
  using std::isinf;
  return isinf(innermost(x));
}
template <infinitesimal D>
[[nodiscard]] bool isnan(const D& x) {
  using std::isnan;
  return isnan(innermost(x));
}
template <infinitesimal D>
[[nodiscard]] bool isnormal(const D& x) {
  using std::isnormal;
  return isnormal(innermost(x));
}
template <infinitesimal D>
[[nodiscard]] int fpclassify(const D& x) {
  using std::fpclassify;
  return fpclassify(innermost(x));
}

/// |x|; at 0 the derivative from the side of the sign bit.
template <infinitesimal D>
[[nodiscard]] DUET_ALWAYS_INLINE D abs(const D& x) {
  return signbit(x) ? -x : x;
}
template <infinitesimal D>
[[nodiscard]] DUET_ALWAYS_INLINE D fabs(const D& x) {
  return abs(x);
}

/// |magnitude| with the sign of `sign`, which only its sign bit enters.
template <class A, class B>
  requires detail::mixed_scalars<A, B>
[[nodiscard]] DUET_ALWAYS_INLINE auto copysign(const A& magnitude, const B& sign) {
  using std::signbit;
  using common = promote_t<A, B>;
  const common x(magnitude);
  return signbit(innermost(magnitude)) == signbit(innermost(sign)) ? x : common(-x);
}

/// The larger; where one is NaN the other, as in `<cmath>`.
template <class A, class B>
  requires detail::mixed_scalars<A, B>
[[nodiscard]] DUET_ALWAYS_INLINE auto fmax(const A& a, const B& b) {
  using std::isnan;
  using common = promote_t<A, B>;
  return a < b || isnan(innermost(a)) ? common(b) : common(a);
}
template <class A, class B>
  requires detail::mixed_scalars<A, B>
[[nodiscard]] DUET_ALWAYS_INLINE auto fmin(const A& a, const B& b) {
  using std::isnan;
  using common = promote_t<A, B>;
  return b < a || isnan(innermost(a)) ? common(b) : common(a);
}

/// max(a − b, 0); NaN where either is.
template <class A, class B>
  requires detail::mixed_scalars<A, B>
[[nodiscard]] DUET_ALWAYS_INLINE auto fdim(const A& a, const B& b) {
  using common = promote_t<A, B>;
  return a <= b ? common(0) : common(a - b);
}

/// a + t (b − a), exact at t = 0 and t = 1.
template <class A, class B, class C>
  requires detail::mixed_scalars<A, promote_t<B, C>>
[[nodiscard]] DUET_ALWAYS_INLINE auto lerp(const A& a, const B& b, const C& t) {
  using common = promote_t<A, promote_t<B, C>>;
  return t < 0.5 ? common(a + t * (b - a)) : common(b - (1 - t) * (b - a));
}

// Rounding: flat wherever it is differentiable.

template <infinitesimal D>
[[nodiscard]] D floor(const D& x) {
  using std::floor;
  return D(floor(innermost(x)));
}
template <infinitesimal D>
[[nodiscard]] D ceil(const D& x) {
  using std::ceil;
  return D(ceil(innermost(x)));
}
template <infinitesimal D>
[[nodiscard]] D trunc(const D& x) {
  using std::trunc;
  return D(trunc(innermost(x)));
}
template <infinitesimal D>
[[nodiscard]] D round(const D& x) {
  using std::round;
  return D(round(innermost(x)));
}
template <infinitesimal D>
[[nodiscard]] D rint(const D& x) {
  using std::rint;
  return D(rint(innermost(x)));
}
template <infinitesimal D>
[[nodiscard]] D nearbyint(const D& x) {
  using std::nearbyint;
  return D(nearbyint(innermost(x)));
}
template <infinitesimal D>
[[nodiscard]] long lround(const D& x) {
  using std::lround;
  return lround(innermost(x));
}
template <infinitesimal D>
[[nodiscard]] long long llround(const D& x) {
  using std::llround;
  return llround(innermost(x));
}
template <infinitesimal D>
[[nodiscard]] long lrint(const D& x) {
  using std::lrint;
  return lrint(innermost(x));
}
template <infinitesimal D>
[[nodiscard]] long long llrint(const D& x) {
  using std::llrint;
  return llrint(innermost(x));
}

/// x = integer + fraction; the fraction keeps the derivatives.
template <infinitesimal D>
[[nodiscard]] D modf(const D& x, D* integer) {
  *integer = trunc(x);
  return x - *integer;
}

// Scaling by powers of the radix: linear.

template <infinitesimal D>
[[nodiscard]] int ilogb(const D& x) {
  using std::ilogb;
  return ilogb(innermost(x));
}
template <infinitesimal D>
[[nodiscard]] D logb(const D& x) {
  using std::logb;
  return D(logb(innermost(x)));
}

/// x · 2^exponent, in two steps so that the factor itself neither overflows nor vanishes.
template <infinitesimal D>
[[nodiscard]] D ldexp(const D& x, int exponent) {
  using std::ldexp;
  using real = real_type_t<D>;
  const int half = exponent / 2;
  return x * real(ldexp(real(1), half)) * real(ldexp(real(1), exponent - half));
}
template <infinitesimal D>
[[nodiscard]] D scalbn(const D& x, int exponent) {
  return ldexp(x, exponent);
}
/// x = m · 2^exponent with |m| in [½, 1).
template <infinitesimal D>
[[nodiscard]] D frexp(const D& x, int* exponent) {
  using std::frexp;
  static_cast<void>(frexp(innermost(x), exponent));
  return ldexp(x, -*exponent);
}

} // namespace duet
