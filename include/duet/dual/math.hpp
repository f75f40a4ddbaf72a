// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/complex.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual/rules/functions.hpp>
#include <duet/dual/taylor.hpp>

#include <cmath>
#include <istream>
#include <limits>
#include <math.h>
#include <ostream>
#include <sstream>
#include <type_traits>

/// \file
/// Functions, limits and streams of `double` for dual and Taylor numbers.
///
/// Limits are those of the innermost real, as constants. In streams a dual is `value[partial, …]`,
/// a Taylor number its coefficients `(x0 + x1 e + x2 e^2)`; input gives a constant. Digits, decimal
/// point and width are the stream's own; the width counts for the whole number, as for
/// `std::complex`.
///
/// With <math.h> the functions of `float` and `long double` are in the global namespace, too, not
/// only C's of `double`: in a formula over any scalar `sqrt(x)` is then right for all of them.

namespace duet {

/// Writes through a buffer of the same format, so that padding surrounds the whole text.
template <class Char, Infinitesimal D>
std::basic_ostream<Char>& operator<<(std::basic_ostream<Char>& out, const D& x) {
  std::basic_ostringstream<Char> text;
  text.copyfmt(out);
  text.width(0);
  text.exceptions(std::ios_base::goodbit);
  x.write(text);
  return out << text.str();
}

template <class Char, Infinitesimal D>
std::basic_istream<Char>& operator>>(std::basic_istream<Char>& in, D& x) {
  typename scalar_traits<D>::value_type value{};
  if (in >> value) {
    x = D(value);
  }
  return in;
}

} // namespace duet

template <duet::Infinitesimal D>
class std::numeric_limits<D> : public std::numeric_limits<duet::real_type_t<D>> {
  using real = std::numeric_limits<duet::real_type_t<D>>;

public:
  static constexpr D min() noexcept { return real::min(); }
  static constexpr D max() noexcept { return real::max(); }
  static constexpr D lowest() noexcept { return real::lowest(); }
  static constexpr D epsilon() noexcept { return real::epsilon(); }
  static constexpr D round_error() noexcept { return real::round_error(); }
  static constexpr D infinity() noexcept { return real::infinity(); }
  static constexpr D quiet_NaN() noexcept { return real::quiet_NaN(); }
  static constexpr D signaling_NaN() noexcept { return real::signaling_NaN(); }
  static constexpr D denorm_min() noexcept { return real::denorm_min(); }
};

// `std::sin(x)` of a dual or a formula x, and its like: qualified names find only the standard
// library's functions, which do not take duals. These overloads replace the compiler's list of
// candidates by a message that says what to write instead.
//
// `std::max`, `std::min` and `std::clamp` of a dual and a constant, which need one type in the
// standard library, work. (A program that would compile without these overloads calls none of
// them: wherever another function fits, it is more specialised than a parameter pack.)

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
