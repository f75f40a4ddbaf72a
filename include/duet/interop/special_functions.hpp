// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/parts.hpp>
#include <duet/interop/special_function_rules.hpp>

#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <boost/math/special_functions/zeta.hpp>

#include <cmath>
#include <limits>
#include <type_traits>

/// \file
/// The special functions of `<cmath>` since C++17, over dual and Taylor numbers: values by
/// Boost.Math, except Legendre's, Hermite's and Laguerre's, by recurrences; derivatives of every
/// order by recurrences, infinite ones at the ends of domains included. Names, arguments and signs
/// are those of `<cmath>`. Orders, degrees, moduli and characteristics are plain numbers, see
/// docs/boost.md.
///
/// An opt-in header, as Boost's take seconds to compile.

namespace duet {

/// A dual or Taylor number over one real number, not a batch.
template <class D>
concept SpecialArgument = RealInfinitesimal<D> && !Batched<D>;

/// Bessel function of the first kind J_ν(x).
[[nodiscard]] auto cyl_bessel_j(Arithmetic auto nu, const SpecialArgument auto& x) {
  return detail::cylinder<detail::bessel::j>(double(nu)).value(x);
}
/// Bessel function of the second kind Y_ν(x).
[[nodiscard]] auto cyl_neumann(Arithmetic auto nu, const SpecialArgument auto& x) {
  return detail::cylinder<detail::bessel::y>(double(nu)).value(x);
}
/// Modified Bessel function of the first kind I_ν(x).
[[nodiscard]] auto cyl_bessel_i(Arithmetic auto nu, const SpecialArgument auto& x) {
  return detail::cylinder<detail::bessel::i>(double(nu)).value(x);
}
/// Modified Bessel function of the second kind K_ν(x).
[[nodiscard]] auto cyl_bessel_k(Arithmetic auto nu, const SpecialArgument auto& x) {
  return detail::cylinder<detail::bessel::k>(double(nu)).value(x);
}
/// Spherical Bessel function of the first kind j_n(x).
[[nodiscard]] auto sph_bessel(unsigned n, const SpecialArgument auto& x) {
  return detail::spherical_bessel_rule<false>(n).value(x);
}
/// Spherical Bessel function of the second kind y_n(x).
[[nodiscard]] auto sph_neumann(unsigned n, const SpecialArgument auto& x) {
  return detail::spherical_bessel_rule<true>(n).value(x);
}

/// Elliptic integral of the first kind F(φ, k), differentiable with respect to φ (radians).
[[nodiscard]] auto ellint_1(Arithmetic auto k, const SpecialArgument auto& phi) {
  return detail::elliptic<1>(double(k)).value(phi);
}
/// Elliptic integral of the second kind E(φ, k), differentiable with respect to φ (radians).
[[nodiscard]] auto ellint_2(Arithmetic auto k, const SpecialArgument auto& phi) {
  return detail::elliptic<2>(double(k)).value(phi);
}
/// Elliptic integral of the third kind Π(ν, φ, k), differentiable with respect to φ (radians).
template <Arithmetic K, Arithmetic N, SpecialArgument D>
[[nodiscard]] D ellint_3(K k, N nu, const D& phi) {
  return detail::elliptic<3>(double(k), double(nu)).value(phi);
}
/// Complete elliptic integral of the first kind K(k), differentiable with respect to the modulus.
[[nodiscard]] auto comp_ellint_1(const SpecialArgument auto& k) {
  const auto value = boost::math::ellint_1(innermost(k), detail::quiet_policy());
  return detail::with_innermost(detail::complete_elliptic(k)[0], value);
}
/// Complete elliptic integral of the second kind E(k), differentiable with respect to the modulus.
[[nodiscard]] auto comp_ellint_2(const SpecialArgument auto& k) {
  const auto value = boost::math::ellint_2(innermost(k), detail::quiet_policy());
  return detail::with_innermost(detail::complete_elliptic(k)[1], value);
}

/// Exponential integral Ei(x).
[[nodiscard]] auto expint(const SpecialArgument auto& x) {
  return detail::exponential_integral{}.value(x);
}
/// Riemann's zeta function ζ(s).
[[nodiscard]] auto riemann_zeta(const SpecialArgument auto& s) {
  using real = std::remove_cvref_t<decltype(innermost(s))>;
  const real value = innermost(s) == 1 ? std::numeric_limits<real>::infinity()
                                       : boost::math::zeta(innermost(s), detail::quiet_policy());
  return detail::with_innermost(detail::zeta_of(s), value);
}
/// Beta function B(x, y), differentiable with respect to both.
template <class A, class B>
  requires detail::MixedReals<A, B> && SpecialArgument<promote_t<A, B>>
[[nodiscard]] auto beta(const A& x, const B& y) {
  return detail::lift_promoted(detail::beta_rule{}, promote_t<A, B>(x), promote_t<A, B>(y));
}

/// Legendre polynomial P_n(x).
template <SpecialArgument D>
[[nodiscard]] D legendre(unsigned n, const D& x) {
  return detail::legendre_by_recurrence(n, 0, x);
}
/// Associated Legendre function (1 − x²)^(m/2) dᵐP_l/dxᵐ, without the sign (−1)ᵐ.
template <SpecialArgument D>
[[nodiscard]] D assoc_legendre(unsigned l, unsigned m, const D& x) {
  using std::pow;
  const D power = pow(detail::one_minus_square(x), real_type_t<D>(m) / 2);
  const D polynomial = detail::legendre_by_recurrence(l, m, x);
  if (m % 2 == 1 && innermost(power) == 0) {
    // Derivatives of the root are 0 or infinite; those of the polynomial are smaller.
    return power * innermost(polynomial);
  }
  return power * polynomial;
}
/// Spherical harmonic Y_l^m(θ, 0), with the sign (−1)ᵐ.
template <SpecialArgument D>
[[nodiscard]] D sph_legendre(unsigned l, unsigned m, const D& theta) {
  using std::cos;
  using std::sin;
  return detail::normalized_legendre(l, m, D(cos(theta)), D(-sin(theta)));
}
/// Hermite polynomial H_n(x), physicists' convention: H_1 = 2x.
template <SpecialArgument D>
[[nodiscard]] D hermite(unsigned n, const D& x) {
  using real = real_type_t<D>;
  D below(0), h(1);
  for (unsigned k = 0; k < n; ++k) {
    const D above = 2 * (x * h - real(k) * below);
    below = h;
    h = above;
  }
  return h;
}
/// Associated Laguerre polynomial L_n^m(x).
template <SpecialArgument D>
[[nodiscard]] D assoc_laguerre(unsigned n, unsigned m, const D& x) {
  using real = real_type_t<D>;
  D below(0), p(1);
  for (unsigned k = 0; k < n; ++k) {
    const D above = ((real(2 * k + m + 1) - x) * p - real(k + m) * below) / real(k + 1);
    below = p;
    p = above;
  }
  return p;
}
/// Laguerre polynomial L_n(x).
[[nodiscard]] auto laguerre(unsigned n, const SpecialArgument auto& x) {
  return assoc_laguerre(n, 0, x);
}

// Functions without derivatives here are rejected with a message.

#define DUET_REFUSE_FIRST_ARGUMENT(function, what)                                                 \
  template <Infinitesimal D, class... Rest>                                                        \
  void function(const D&, const Rest&...) {                                                        \
    static_assert(!Infinitesimal<D>,                                                               \
                  "duet: " #function " has no derivative with respect to its " what                \
                  "; give a plain number there");                                                  \
  }
DUET_REFUSE_FIRST_ARGUMENT(cyl_bessel_j, "order")
DUET_REFUSE_FIRST_ARGUMENT(cyl_neumann, "order")
DUET_REFUSE_FIRST_ARGUMENT(cyl_bessel_i, "order")
DUET_REFUSE_FIRST_ARGUMENT(cyl_bessel_k, "order")
DUET_REFUSE_FIRST_ARGUMENT(ellint_1, "modulus")
DUET_REFUSE_FIRST_ARGUMENT(ellint_2, "modulus")
DUET_REFUSE_FIRST_ARGUMENT(ellint_3, "modulus")
DUET_REFUSE_FIRST_ARGUMENT(comp_ellint_3, "modulus")
#undef DUET_REFUSE_FIRST_ARGUMENT

template <Arithmetic K, Infinitesimal D>
void comp_ellint_3(K, const D&) {
  static_assert(!Infinitesimal<D>, "duet: comp_ellint_3 has no derivative with respect to its "
                                   "characteristic; give a plain number there");
}
template <Arithmetic K, Infinitesimal D, class T>
void ellint_3(K, const D&, const T&) {
  static_assert(!Infinitesimal<D>, "duet: ellint_3 has no derivative with respect to its "
                                   "characteristic; give a plain number there");
}

} // namespace duet
