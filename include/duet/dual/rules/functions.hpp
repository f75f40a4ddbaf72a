// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual/rules/elementary.hpp>
#include <duet/dual/rules/of_many.hpp>

#include <cmath>
#include <concepts>
#include <type_traits>

/// \file
/// The functions of `<cmath>`, and `midpoint`, over dual and Taylor numbers, the smooth ones over
/// batches lane by lane too. Values are those of the standard library; derivatives of smooth
/// functions are in elementary.hpp and of_many.hpp. Complex numbers have the functions of
/// `<complex>` that are in complex.hpp's list.
///
/// Arguments are passed by value if Boost.Math declares f(T): with const D& neither would be more
/// specialised.

namespace duet {

/// The function of `<cmath>` with its derivatives, or over complex numbers that of `<complex>`.
template <Infinitesimal D>
[[nodiscard]] DUET_ALWAYS_INLINE D sqrt(const D& x) {
  return detail::lift(rule::sqrt{}, x);
}
template <detail::Lifted D>
[[nodiscard]] DUET_ALWAYS_INLINE D exp(const D& x) {
  return detail::lift(rule::exp{}, x);
}
template <detail::Lifted D>
[[nodiscard]] DUET_ALWAYS_INLINE D log(const D& x) {
  return detail::lift(rule::log{}, x);
}
template <Infinitesimal D>
[[nodiscard]] DUET_ALWAYS_INLINE D sin(const D& x) {
  return detail::lift(rule::sin{}, x);
}
template <Infinitesimal D>
[[nodiscard]] DUET_ALWAYS_INLINE D cos(const D& x) {
  return detail::lift(rule::cos{}, x);
}
[[nodiscard]] auto tan(const detail::Lifted auto& x) { return detail::lift(rule::tan{}, x); }
[[nodiscard]] auto sinh(const detail::Lifted auto& x) { return detail::lift(rule::sinh{}, x); }
[[nodiscard]] auto cosh(const detail::Lifted auto& x) { return detail::lift(rule::cosh{}, x); }
[[nodiscard]] auto tanh(const detail::Lifted auto& x) { return detail::lift(rule::tanh{}, x); }

/// The function of `<cmath>` with its derivatives.
[[nodiscard]] auto asin(const detail::LiftedAnalytic auto& x) {
  return detail::lift(rule::asin{}, x);
}
[[nodiscard]] auto acos(const detail::LiftedAnalytic auto& x) {
  return detail::lift(rule::acos{}, x);
}
[[nodiscard]] auto atan(const detail::LiftedAnalytic auto& x) {
  return detail::lift(rule::atan{}, x);
}
[[nodiscard]] auto cbrt(detail::LiftedReal auto x) { return detail::lift(rule::cbrt{}, x); }
[[nodiscard]] auto exp2(detail::LiftedReal auto x) { return detail::lift(rule::exp2{}, x); }
[[nodiscard]] auto expm1(detail::LiftedReal auto x) { return detail::lift(rule::expm1{}, x); }
[[nodiscard]] auto log1p(detail::LiftedReal auto x) { return detail::lift(rule::log1p{}, x); }
[[nodiscard]] auto asinh(detail::LiftedAnalytic auto x) { return detail::lift(rule::asinh{}, x); }
[[nodiscard]] auto acosh(detail::LiftedAnalytic auto x) { return detail::lift(rule::acosh{}, x); }
[[nodiscard]] auto atanh(detail::LiftedAnalytic auto x) { return detail::lift(rule::atanh{}, x); }
[[nodiscard]] auto erf(detail::LiftedReal auto x) { return detail::lift(rule::erf{}, x); }
[[nodiscard]] auto erfc(detail::LiftedReal auto x) { return detail::lift(rule::erfc{}, x); }
[[nodiscard]] auto tgamma(detail::LiftedReal auto x) { return detail::lift(rule::tgamma{}, x); }
[[nodiscard]] auto lgamma(detail::LiftedReal auto x) { return detail::lift(rule::lgamma{}, x); }
[[nodiscard]] auto log2(const detail::LiftedReal auto& x) { return detail::lift(rule::log2{}, x); }
[[nodiscard]] auto log10(const detail::LiftedAnalytic auto& x) {
  return detail::lift(rule::log10{}, x);
}

namespace detail {

/// A constant exponent or base as stored in rules: arithmetic types become reals of the precision
/// of D.
template <class D, class U>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto as_constant(const U& x) {
  if constexpr (Arithmetic<U>) {
    return static_cast<constant_t<D>>(x);
  } else {
    return x;
  }
}

/// Applies a rule of several arguments in their common nesting.
template <class Rule, class... A>
[[nodiscard]] auto lift_promoted(const Rule& rule, const A&... a) {
  using common = std::common_type_t<A...>;
  return lift(rule, static_cast<const common&>(a)...);
}

} // namespace detail

/// Power x^p. A constant exponent or base has no slope, so `pow(x, 0)`, `pow(0, p)` and
/// `pow(−2, 2)` are regular.
template <class A, class B>
  requires(detail::MixedScalars<A, B> || detail::MixedReals<A, B>)
[[nodiscard]] auto pow(const A& x, const B& p) {
  const auto by_rules = [&] {
    if constexpr (ConstantOf<B, A>) {
      const auto exponent = detail::as_constant<A>(p);
      return detail::lift(rule::power<std::remove_const_t<decltype(exponent)>>{exponent}, x);
    } else if constexpr (ConstantOf<A, B>) {
      const auto base = detail::as_constant<B>(x);
      return detail::lift(rule::exponential<std::remove_const_t<decltype(base)>>{base}, p);
    } else {
      return detail::lift_promoted(rule::pow{}, x, p);
    }
  };
  using number = real_type_t<promote_t<A, B>>;
  if constexpr (Real<number> || std::integral<detail::constant_t<number>>) {
    return by_rules();
  } else {
    return detail::with_innermost(
        by_rules(), detail::complex_power_of_constants<number>(innermost(x), innermost(p)));
  }
}

/// Angle of the point (x, y), in (−π, π] radians.
template <class A, detail::MixedReals<A> B>
[[nodiscard]] auto atan2(const A& y, const B& x) {
  return detail::lift_promoted(rule::atan2{}, y, x);
}

/// √(x² + y²) or √(x² + y² + z²) without overflow.
template <class A, class B>
  requires detail::MixedReals<A, B>
[[nodiscard]] auto hypot(A x, B y) { return detail::lift_promoted(rule::hypot{}, x, y); }
template <class A, class B, class C>
  requires detail::MixedReals<A, promote_t<B, C>>
[[nodiscard]] auto hypot(const A& x, const B& y, const C& z) {
  return detail::lift_promoted(rule::hypot{}, x, y, z);
}

/// x y + z, the value rounded once.
template <class A, class B, class C>
  requires detail::MixedReals<A, promote_t<B, C>>
[[nodiscard]] auto fma(const A& x, const B& y, const C& z) {
  return detail::lift_promoted(rule::fma{}, x, y, z);
}

/// Remainder of x/y, with the sign of x.
template <class A, detail::MixedReals<A> B>
[[nodiscard]] auto fmod(const A& x, const B& y) {
  return detail::lift_promoted(rule::fmod{}, x, y);
}

/// Remainder of x/y, nearest to 0.
template <class A, detail::MixedReals<A> B>
[[nodiscard]] auto remainder(const A& x, const B& y) {
  return detail::lift_promoted(rule::remainder{}, x, y);
}

/// remainder(x, y), and the low bits of the quotient.
template <class A, detail::MixedReals<A> B>
[[nodiscard]] auto remquo(const A& x, const B& y, int* quotient) {
  using std::remquo;
  using real = real_type_t<promote_t<A, B>>;
  static_cast<void>(remquo(real(innermost(x)), real(innermost(y)), quotient));
  return remainder(x, y);
}

/// a + t (b − a), exact at t = 0 and t = 1.
template <class A, class B, class C>
  requires detail::MixedReals<A, promote_t<B, C>>
[[nodiscard]] auto lerp(const A& a, const B& b, const C& t) {
  return detail::lift_promoted(rule::lerp{}, a, b, t);
}

/// (a + b)/2 without overflow, as that of `<numeric>`.
template <class A, detail::MixedReals<A> B>
[[nodiscard]] auto midpoint(const A& a, const B& b) {
  return detail::lift_promoted(rule::midpoint{}, a, b);
}

} // namespace duet

// Functions that are linear, constant or selected piecewise; those that decompose numbers; and
// classification. All branch on the innermost value.

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
