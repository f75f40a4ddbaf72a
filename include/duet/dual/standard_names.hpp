// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/refused.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/algebra.hpp>

#include <cmath>
#include <type_traits>
#include <utility>

/// \file
/// `std::sin(x)` of a dual or a formula x, and its like: qualified names find only the standard
/// library's functions, which do not take duals. These overloads replace the compiler's list of
/// candidates by a message that says what to write instead.
///
/// `std::max`, `std::min` and `std::clamp` of a dual and a constant, which need one type in the
/// standard library, work. (A program that would compile without these overloads calls none of
/// them: wherever another function fits, it is more specialised than a parameter pack.)

namespace duet::detail {

template <class X>
concept UnknownToStd = RealInfinitesimal<X> || is_symbolic<X>;

/// Sums in the type A of their initial value would lose the derivatives of their terms.
template <class A, class Iterator>
concept LosesDerivatives = Arithmetic<A> && requires(const Iterator& i) {
  requires RealInfinitesimal<std::remove_cvref_t<decltype(*i)>>;
};

} // namespace duet::detail

#define DUET_REFUSES_STD(function)                                                                 \
  template <class... X>                                                                            \
    requires(duet::detail::UnknownToStd<X> || ...)                                                 \
  DUET_REFUSED("std::" #function                                                                   \
               " does not accept numbers with derivatives or formulas: write " #function           \
               "(x), after `using std::" #function ";` if x may be a double")                      \
  double function(const X&...);
#define DUET_REFUSED_SUM                                                                           \
  DUET_REFUSED("accumulate, reduce and inner_product of std add up in the type of their initial "  \
               "value: if x is one of the numbers, write decltype(x)(0) instead of 0.0")
#define DUET_REFUSES_SPECIAL(function)                                                             \
  template <class... X>                                                                            \
    requires(duet::detail::UnknownToStd<X> || ...)                                                 \
  DUET_REFUSED("std::" #function                                                                   \
               " does not accept numbers with derivatives or formulas: for such "                  \
               "numbers use " #function " of <duet/interop/special_functions.hpp>, without "       \
               "`std::`; formulas do not have the function")                                       \
  double function(const X&...);

namespace std {

DUET_REFUSES_STD(abs)
DUET_REFUSES_STD(acos)
DUET_REFUSES_STD(acosh)
DUET_REFUSES_STD(asin)
DUET_REFUSES_STD(asinh)
DUET_REFUSES_STD(atan)
DUET_REFUSES_STD(atan2)
DUET_REFUSES_STD(atanh)
DUET_REFUSES_STD(cbrt)
DUET_REFUSES_STD(ceil)
DUET_REFUSES_STD(copysign)
DUET_REFUSES_STD(cos)
DUET_REFUSES_STD(cosh)
DUET_REFUSES_STD(erf)
DUET_REFUSES_STD(erfc)
DUET_REFUSES_STD(exp)
DUET_REFUSES_STD(exp2)
DUET_REFUSES_STD(expm1)
DUET_REFUSES_STD(fabs)
DUET_REFUSES_STD(floor)
DUET_REFUSES_STD(fma)
DUET_REFUSES_STD(fmax)
DUET_REFUSES_STD(fmin)
DUET_REFUSES_STD(fmod)
DUET_REFUSES_STD(hypot)
DUET_REFUSES_STD(isfinite)
DUET_REFUSES_STD(isinf)
DUET_REFUSES_STD(isnan)
DUET_REFUSES_STD(lerp)
DUET_REFUSES_STD(lgamma)
DUET_REFUSES_STD(log)
DUET_REFUSES_STD(log10)
DUET_REFUSES_STD(log1p)
DUET_REFUSES_STD(log2)
DUET_REFUSES_STD(pow)
DUET_REFUSES_STD(round)
DUET_REFUSES_STD(sin)
DUET_REFUSES_STD(sinh)
DUET_REFUSES_STD(sqrt)
DUET_REFUSES_STD(tan)
DUET_REFUSES_STD(tanh)
DUET_REFUSES_STD(tgamma)
DUET_REFUSES_STD(trunc)

template <class Iterator, class A>
  requires duet::detail::LosesDerivatives<A, Iterator> DUET_REFUSED_SUM A accumulate(Iterator,
                                                                                     Iterator, A);
template <class Iterator, class A, class Add>
  requires duet::detail::LosesDerivatives<A, Iterator>
      DUET_REFUSED_SUM A accumulate(Iterator, Iterator, A, Add);
template <class Iterator, class A>
  requires duet::detail::LosesDerivatives<A, Iterator> DUET_REFUSED_SUM A reduce(Iterator, Iterator,
                                                                                 A);
template <class Iterator, class A, class Add>
  requires duet::detail::LosesDerivatives<A, Iterator> DUET_REFUSED_SUM A reduce(Iterator, Iterator,
                                                                                 A, Add);
template <class Iterator, class Other, class A>
  requires duet::detail::LosesDerivatives<A, Iterator>
      DUET_REFUSED_SUM A inner_product(Iterator, Iterator, Other, A);

/// The larger of a dual and a constant, or of duals of two nestings; a if they are equal.
template <class A, duet::detail::OrderedScalars<A> B>
  requires(!std::is_same_v<A, B>)
[[nodiscard]] constexpr duet::promote_t<A, B> max(const A& a, const B& b) {
  using T = duet::promote_t<A, B>;
  return duet::select(
      a < b, [&] { return T(b); }, [&] { return T(a); });
}
/// The smaller of a dual and a constant, or of duals of two nestings; a if they are equal.
template <class A, duet::detail::OrderedScalars<A> B>
  requires(!std::is_same_v<A, B>)
[[nodiscard]] constexpr duet::promote_t<A, B> min(const A& a, const B& b) {
  using T = duet::promote_t<A, B>;
  return duet::select(
      b < a, [&] { return T(b); }, [&] { return T(a); });
}
/// x clamped to `low` if x < low, and to `high` if high < x, of duals and constants.
template <class X, class Low, class High>
  requires((duet::RealInfinitesimal<X> || duet::RealInfinitesimal<Low> ||
            duet::RealInfinitesimal<High>)&&!(std::is_same_v<X, Low> && std::is_same_v<X, High>))
[[nodiscard]] constexpr duet::promote_t<duet::promote_t<X, Low>, High>
clamp(const X& x, const Low& low, const High& high) {
  using T = duet::promote_t<duet::promote_t<X, Low>, High>;
  return duet::select(
      x < low, [&] { return T(low); },
      [&] {
        return duet::select(
            high < x, [&] { return T(high); }, [&] { return T(x); });
      });
}

DUET_REFUSES_SPECIAL(assoc_laguerre)
DUET_REFUSES_SPECIAL(assoc_legendre)
DUET_REFUSES_SPECIAL(beta)
DUET_REFUSES_SPECIAL(comp_ellint_1)
DUET_REFUSES_SPECIAL(comp_ellint_2)
DUET_REFUSES_SPECIAL(comp_ellint_3)
DUET_REFUSES_SPECIAL(cyl_bessel_i)
DUET_REFUSES_SPECIAL(cyl_bessel_j)
DUET_REFUSES_SPECIAL(cyl_bessel_k)
DUET_REFUSES_SPECIAL(cyl_neumann)
DUET_REFUSES_SPECIAL(ellint_1)
DUET_REFUSES_SPECIAL(ellint_2)
DUET_REFUSES_SPECIAL(ellint_3)
DUET_REFUSES_SPECIAL(expint)
DUET_REFUSES_SPECIAL(hermite)
DUET_REFUSES_SPECIAL(laguerre)
DUET_REFUSES_SPECIAL(legendre)
DUET_REFUSES_SPECIAL(riemann_zeta)
DUET_REFUSES_SPECIAL(sph_bessel)
DUET_REFUSES_SPECIAL(sph_legendre)
DUET_REFUSES_SPECIAL(sph_neumann)

} // namespace std

#undef DUET_REFUSES_STD
#undef DUET_REFUSED_SUM
#undef DUET_REFUSES_SPECIAL
