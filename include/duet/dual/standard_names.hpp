// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/refused.hpp>
#include <duet/core/scalar_traits.hpp>

#include <cmath>

/// \file
/// `std::sin(x)` of a dual or a formula x, and its like: qualified names find the standard
/// library's functions alone, which know none. Compilers would list these; they say what to write
/// instead.
///
/// (The standard keeps its namespace to itself. These are called by no program that compiles, and
/// wherever another function fits, it is more specialised than a parameter pack.)

namespace duet::detail {

template <class X>
concept UnknownToStd = RealInfinitesimal<X> || is_symbolic<X>;

} // namespace duet::detail

#define DUET_REFUSES_STD(function)                                                                 \
  template <class... X>                                                                            \
    requires(duet::detail::UnknownToStd<X> || ...)                                                 \
  DUET_REFUSED("std::" #function                                                                   \
               " does not know numbers with derivatives nor formulas: write " #function            \
               "(x), after `using std::" #function ";` where x may be a double")                   \
  double function(const X&...);
#define DUET_REFUSES_SPECIAL(function)                                                             \
  template <class... X>                                                                            \
    requires(duet::detail::UnknownToStd<X> || ...)                                                 \
  DUET_REFUSED("std::" #function " does not know numbers with derivatives nor formulas: of such "  \
               "numbers there is " #function " of <duet/interop/special_functions.hpp>, without "  \
               "`std::`, of formulas there is none")                                               \
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
#undef DUET_REFUSES_SPECIAL
