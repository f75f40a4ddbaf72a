// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/algebra.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual/rules/elementary.hpp>
#include <duet/dual/rules/lift.hpp>
#include <duet/dual/rules/of_many.hpp>
#include <duet/dual/rules/powers.hpp>
#include <duet/dual/rules/special.hpp>

#include <concepts>

/// \file
/// The smooth functions of `<cmath>`, and `midpoint`, over dual and Taylor numbers, and over
/// batches lane by lane. Values are those of the standard library; derivatives are in
/// elementary.hpp and its like. Complex numbers have those of `<complex>` that are in complex.hpp's
/// list.
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
