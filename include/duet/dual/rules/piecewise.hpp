// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/algebra.hpp>
#include <duet/dual/parts.hpp>
#include <duet/dual/promotion.hpp>

#include <cmath>
#include <concepts>
#include <type_traits>

/// \file
/// The functions of `<cmath>` that are linear, constant or selected piecewise, over dual and Taylor
/// numbers; those that decompose numbers; and classification. All branch on the innermost value.
///
/// Arguments are passed by value if Boost.Math declares f(T): with const D& neither would be more
/// specialised.

namespace duet {

/// Classification of the innermost value, as in `<cmath>`.
[[nodiscard]] auto signbit(RealInfinitesimal auto x) {
  using std::signbit;
  const auto is_negative = signbit(innermost(x));
  if constexpr (std::integral<std::remove_cvref_t<decltype(is_negative)>>) {
    return bool(is_negative != 0); // of Boost.Multiprecision an int
  } else {
    return is_negative;
  }
}
[[nodiscard]] auto isfinite(RealInfinitesimal auto x) {
  using std::isfinite;
  return isfinite(innermost(x));
}
[[nodiscard]] auto isinf(RealInfinitesimal auto x) {
  using std::isinf;
  return isinf(innermost(x));
}
[[nodiscard]] auto isnan(RealInfinitesimal auto x) {
  using std::isnan;
  return isnan(innermost(x));
}
[[nodiscard]] auto isnormal(RealInfinitesimal auto x) {
  using std::isnormal;
  return isnormal(innermost(x));
}
[[nodiscard]] int fpclassify(RealInfinitesimal auto x) {
  using std::fpclassify;
  return fpclassify(innermost(x));
}

/// The quiet comparisons of `<cmath>`: no exception if either is NaN.
template <class A, detail::MixedReals<A> B>
[[nodiscard]] auto isunordered(const A& a, const B& b) {
  using std::isnan;
  return isnan(innermost(a)) || isnan(innermost(b));
}
template <class A, class B>
  requires detail::MixedReals<A, B>
[[nodiscard]] auto isless(const A& a, const B& b) { return !isunordered(a, b) && a < b; }
template <class A, class B>
  requires detail::MixedReals<A, B>
[[nodiscard]] auto islessequal(const A& a, const B& b) { return !isunordered(a, b) && a <= b; }
template <class A, class B>
  requires detail::MixedReals<A, B>
[[nodiscard]] auto isgreater(const A& a, const B& b) { return !isunordered(a, b) && a > b; }
template <class A, class B>
  requires detail::MixedReals<A, B>
[[nodiscard]] auto isgreaterequal(const A& a, const B& b) { return !isunordered(a, b) && a >= b; }
template <class A, class B>
  requires detail::MixedReals<A, B>
[[nodiscard]] auto islessgreater(const A& a, const B& b) { return !isunordered(a, b) && a != b; }

/// |x|; at 0 the derivative from the side of the sign bit.
template <RealInfinitesimal D>
[[nodiscard]] D abs(const D& x) {
  return select(
      signbit(x), [&] { return D(-x); }, [&] { return x; });
}
/// |x|, as `abs`.
[[nodiscard]] auto fabs(const RealInfinitesimal auto& x) { return abs(x); }

/// |magnitude| with the sign of `sign`, of which only the sign bit is used.
template <class A, detail::MixedReals<A> B>
[[nodiscard]] auto copysign(const A& magnitude, const B& sign) {
  using std::signbit;
  using common = promote_t<A, B>;
  const common x(magnitude);
  return select(
      signbit(innermost(magnitude)) == signbit(innermost(sign)), [&] { return x; },
      [&] { return common(-x); });
}

/// The larger of two; if one is NaN the other, as in `<cmath>`.
template <class A, detail::MixedReals<A> B>
[[nodiscard]] auto fmax(const A& a, const B& b) {
  using std::isnan;
  using common = promote_t<A, B>;
  using real = real_type_t<common>;
  return select(
      isnan(innermost(a)) || detail::quiet_less(real(innermost(a)), real(innermost(b))),
      [&] { return common(b); }, [&] { return common(a); });
}
/// The smaller of two; if one is NaN the other, as in `<cmath>`.
template <class A, detail::MixedReals<A> B>
[[nodiscard]] auto fmin(const A& a, const B& b) {
  using std::isnan;
  using common = promote_t<A, B>;
  using real = real_type_t<common>;
  return select(
      isnan(innermost(a)) || detail::quiet_less(real(innermost(b)), real(innermost(a))),
      [&] { return common(b); }, [&] { return common(a); });
}

/// max(a − b, 0); NaN if either is.
template <class A, detail::MixedReals<A> B>
[[nodiscard]] auto fdim(const A& a, const B& b) {
  using common = promote_t<A, B>;
  using real = real_type_t<common>;
  return select(
      detail::quiet_less_equal(real(innermost(a)), real(innermost(b))), [&] { return common(0); },
      [&] { return common(a - b); });
}

/// Rounding functions of `<cmath>`: their derivatives are zero wherever they exist.
template <RealInfinitesimal D>
[[nodiscard]] D floor(const D& x) {
  using std::floor;
  return D(real_type_t<D>(floor(innermost(x))));
}
template <RealInfinitesimal D>
[[nodiscard]] D ceil(const D& x) {
  using std::ceil;
  return D(real_type_t<D>(ceil(innermost(x))));
}
template <RealInfinitesimal D>
[[nodiscard]] D trunc(const D& x) {
  using std::trunc;
  return D(real_type_t<D>(trunc(innermost(x))));
}
template <RealInfinitesimal D>
[[nodiscard]] D round(const D& x) {
  using std::round;
  return D(real_type_t<D>(round(innermost(x))));
}
template <RealInfinitesimal D>
[[nodiscard]] D rint(const D& x) {
  using std::rint;
  return D(real_type_t<D>(rint(innermost(x))));
}
template <RealInfinitesimal D>
[[nodiscard]] D nearbyint(const D& x) {
  using std::nearbyint;
  return D(real_type_t<D>(nearbyint(innermost(x))));
}
[[nodiscard]] long lround(const RealInfinitesimal auto& x) {
  using std::lround;
  return lround(innermost(x));
}
[[nodiscard]] long long llround(const RealInfinitesimal auto& x) {
  using std::llround;
  return llround(innermost(x));
}
[[nodiscard]] long lrint(const RealInfinitesimal auto& x) {
  using std::lrint;
  return lrint(innermost(x));
}
[[nodiscard]] long long llrint(const RealInfinitesimal auto& x) {
  using std::llrint;
  return llrint(innermost(x));
}

/// x = integer + fraction; the fraction keeps the derivatives.
template <RealInfinitesimal D>
[[nodiscard]] D modf(const D& x, D* integer) {
  using std::modf;
  real_type_t<D> integer_part;
  const real_type_t<D> fraction = modf(innermost(x), &integer_part);
  *integer = D(integer_part);
  return detail::with_innermost(x, fraction);
}

/// The exponent of the innermost value.
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
