// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/lanes.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/complex_of_level.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/parts.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual/rules/functions.hpp>
#include <duet/dual/rules/piecewise.hpp>
#include <duet/dual/taylor.hpp>

#include <cmath>
#include <complex>
#include <concepts>
#include <limits>
#include <type_traits>

/// \file
/// Complex numbers and derivatives, in both nestings.
///
/// A dual or Taylor number over the complex numbers, `dual<std::complex<double>>`, carries f′(z) of
/// an analytic function: algebra, ==, pow, streams and `exp`, `log`, `log10`, `sqrt`, `sin`, `cos`,
/// `tan`, `asin`, `acos`, `atan` and the hyperbolic ones, on the branches of `<complex>`. There is
/// no order, and no `abs`, `arg`, `conj`, `real`, `imag`, which have no complex derivative.
///
/// The other nesting, `std::complex<dual<double>>`, is a complex number whose parts have
/// derivatives. Analytic functions of it are those of the first nesting, a + εb of complex a and b:
/// f(a + εb) = f(a) + ε f′(a) b. `std::complex` is specialised here, and its functions are
/// overloaded, for those of the standard library branch on values or, as a quotient by |z|²,
/// overflow.
///
/// If f′ is infinite, at least one part of the derivative is infinite; zero partials stay zero.

namespace duet::detail {

/// Power of D over complex or real numbers, or of constants. An operand whose infinitesimal parts
/// are all zero counts as a constant.
template <class X, class P>
[[nodiscard]] auto power_of_levels(const X& x, const P& p) {
  using std::pow;
  using result = decltype(pow(x, p));
  if constexpr (Infinitesimal<X> && Infinitesimal<P>) {
    if (is_constant(p)) {
      return result(pow(x, innermost(p)));
    }
    if (is_constant(x)) {
      return result(pow(innermost(x), p));
    }
  }
  return pow(x, p);
}

/// x as an operand of a level over complex numbers.
template <class X>
[[nodiscard]] auto operand_of_level(const X& x) {
  if constexpr (requires { x.real(); }) {
    return level_of_complex(x);
  } else {
    return x;
  }
}

/// The power of two numbers, at least one of them complex over numbers with derivatives.
template <class X, class P>
[[nodiscard]] auto complex_power(const X& x, const P& p) {
  return by_lane(
      [](const auto& y, const auto& q) {
        return complex_of_level(power_of_levels(operand_of_level(y), operand_of_level(q)));
      },
      x, p);
}

} // namespace duet::detail

// The functions of <complex>. The standard reserves its namespace, but std::sqrt(z) finds nothing
// elsewhere. Each is declared as one of the standard library's is, and preferred to it as the more
// constrained. (`norm`, `conj`, `real`, `imag` and `polar` of one type are right as the standard
// library has them.)

#define DUET_ANALYTIC(function)                                                                    \
  template <duet::Infinitesimal D>                                                                 \
  [[nodiscard]] complex<D> function(const complex<D>& z) {                                         \
    return duet::detail::analytic([](const auto& w) { return function(w); }, z);                   \
  }
#define DUET_ANALYTIC_OF_BUILT_IN(function)                                                        \
  template <duet::Infinitesimal D>                                                                 \
  [[nodiscard]] complex<D> function(const complex<D>& z) {                                         \
    if constexpr (std::floating_point<duet::lane_type_t<D>>) {                                     \
      return duet::detail::analytic([](const auto& w) { return function(w); }, z);                 \
    } else {                                                                                       \
      static_assert(std::floating_point<duet::lane_type_t<D>>,                                     \
                    "duet: " #function " of a complex number needs float, double or long double, " \
                    "the only types for which the standard library has it");                       \
    }                                                                                              \
  }

namespace std {

DUET_ANALYTIC(exp)
DUET_ANALYTIC(log)
DUET_ANALYTIC(sqrt)
DUET_ANALYTIC(sin)
DUET_ANALYTIC(cos)
DUET_ANALYTIC(tan)
DUET_ANALYTIC(sinh)
DUET_ANALYTIC(cosh)
DUET_ANALYTIC(tanh)
DUET_ANALYTIC_OF_BUILT_IN(log10)
DUET_ANALYTIC_OF_BUILT_IN(asin)
DUET_ANALYTIC_OF_BUILT_IN(acos)
DUET_ANALYTIC_OF_BUILT_IN(atan)
DUET_ANALYTIC_OF_BUILT_IN(asinh)
DUET_ANALYTIC_OF_BUILT_IN(acosh)
DUET_ANALYTIC_OF_BUILT_IN(atanh)

template <duet::Infinitesimal D>
[[nodiscard]] complex<D> pow(const complex<D>& z, const complex<D>& p) {
  return duet::detail::complex_power(z, p);
}
template <duet::Infinitesimal D>
[[nodiscard]] complex<D> pow(const complex<D>& z, const D& p) {
  return duet::detail::complex_power(z, p);
}
template <duet::Infinitesimal D>
[[nodiscard]] complex<D> pow(const D& x, const complex<D>& p) {
  return duet::detail::complex_power(x, p);
}
template <duet::Infinitesimal D>
[[nodiscard]] complex<D> pow(const complex<D>& z, int p) {
  return duet::detail::complex_power(z, p);
}
template <class A, class B>
  requires duet::detail::OtherReal<B, A>
[[nodiscard]] auto pow(const complex<A>& z, const complex<B>& p) {
  return duet::detail::complex_power(z, p);
}
template <class A, class B>
  requires duet::Infinitesimal<A> && duet::detail::OtherReal<B, A>
[[nodiscard]] auto pow(const complex<A>& z, const B& p) {
  return duet::detail::complex_power(z, p);
}
template <class A, class B>
  requires duet::Infinitesimal<B> && duet::detail::OtherReal<A, B>
[[nodiscard]] auto pow(const A& x, const complex<B>& p) {
  return duet::detail::complex_power(x, p);
}

/// |z|, without overflow.
template <duet::Infinitesimal D>
[[nodiscard]] D abs(const complex<D>& z) {
  return hypot(z.real(), z.imag());
}

/// Argument (angle) of z, in (−π, π] radians.
template <duet::Infinitesimal D>
[[nodiscard]] D arg(const complex<D>& z) {
  return atan2(z.imag(), z.real());
}

/// z, or +∞ for every infinite z, with the sign of the imaginary part.
template <duet::Infinitesimal D>
[[nodiscard]] complex<D> proj(const complex<D>& z) {
  return duet::detail::by_lane(
      [](const auto& w) {
        using number = typename remove_cvref_t<decltype(w)>::value_type;
        if (isinf(w.real()) || isinf(w.imag())) {
          return complex<number>(numeric_limits<number>::infinity(), copysign(number(0), w.imag()));
        }
        return w;
      },
      z);
}

/// r e^{iφ} for r and φ of two types.
template <class A, duet::detail::OtherReal<A> B>
[[nodiscard]] auto polar(const A& r, const B& angle) {
  using common = duet::promote_t<A, B>;
  return polar(common(r), common(angle));
}

} // namespace std

#undef DUET_ANALYTIC
#undef DUET_ANALYTIC_OF_BUILT_IN
