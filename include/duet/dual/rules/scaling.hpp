// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/parts.hpp>
#include <duet/dual/rules/piecewise.hpp>

#include <cmath>

/// \file
/// The functions of `<cmath>` that take numbers apart: integer and fraction, significand and
/// exponent, neighbours.

namespace duet {

/// x = integer + fraction; the fraction keeps the derivatives.
template <RealInfinitesimal D>
[[nodiscard]] D modf(const D& x, D* integer) {
  using std::modf;
  real_type_t<D> whole;
  const real_type_t<D> fraction = modf(innermost(x), &whole);
  *integer = D(whole);
  return detail::with_innermost(x, fraction);
}

template <RealInfinitesimal D>
[[nodiscard]] int ilogb(const D& x) {
  using std::ilogb;
  return ilogb(innermost(x));
}
template <RealInfinitesimal D>
[[nodiscard]] D logb(const D& x) {
  using std::logb;
  return D(real_type_t<D>(logb(innermost(x))));
}

/// x · 2^exponent, each part rounded once.
template <RealInfinitesimal D>
[[nodiscard]] D ldexp(const D& x, int exponent) {
  return detail::map_reals(x, [&](const real_type_t<D>& part) {
    using std::ldexp;
    return real_type_t<D>(ldexp(part, exponent));
  });
}
template <RealInfinitesimal D>
[[nodiscard]] D scalbn(const D& x, int exponent) {
  return ldexp(x, exponent);
}
template <RealInfinitesimal D>
[[nodiscard]] D scalbln(const D& x, long exponent) {
  return detail::map_reals(x, [&](const real_type_t<D>& part) {
    using std::scalbln;
    return real_type_t<D>(scalbln(part, exponent));
  });
}
/// x = m · 2^exponent with |m| in [½, 1).
template <RealInfinitesimal D>
[[nodiscard]] D frexp(const D& x, int* exponent) {
  using std::frexp;
  const real_type_t<D> significand = frexp(innermost(x), exponent);
  return detail::with_innermost(ldexp(x, -*exponent), significand);
}

/// The neighbour of x towards `target`, with the derivatives of x.
template <RealInfinitesimal D>
[[nodiscard]] D nextafter(const D& x, const D& target) {
  using std::nextafter;
  return detail::with_innermost(x, real_type_t<D>(nextafter(innermost(x), innermost(target))));
}
template <RealInfinitesimal D>
[[nodiscard]] D nexttoward(const D& x, long double target) {
  using std::nexttoward;
  return detail::with_innermost(x, nexttoward(innermost(x), target));
}

} // namespace duet
