// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/constants.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual/math.hpp>

#include <boost/math/policies/policy.hpp>
#include <boost/math/special_functions/bessel.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <boost/math/special_functions/ellint_3.hpp>
#include <boost/math/special_functions/expint.hpp>
#include <boost/math/special_functions/zeta.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

/// \file
/// The special functions of `<cmath>` since C++17, over dual and Taylor numbers: values by
/// Boost.Math, except Legendre's, Hermite's and Laguerre's, by recurrences; derivatives of every
/// order by recurrences (see dual/rules/elementary.hpp), infinite ones at the ends of domains
/// included. Names, arguments and signs are those of `<cmath>`. Orders, degrees, moduli and
/// characteristics are plain numbers, see docs/reference/boost_functions.md.
///
/// An opt-in header, as Boost's take seconds to compile.

namespace duet {

namespace detail {

namespace policies = boost::math::policies;
/// Infinities and NaN instead of exceptions, as in `<cmath>`.
using quiet_policy = policies::policy<policies::domain_error<policies::ignore_error>,
                                      policies::pole_error<policies::ignore_error>,
                                      policies::overflow_error<policies::ignore_error>,
                                      policies::evaluation_error<policies::ignore_error>>;

/// Base of the rules below: `plain(x)` is the value of a plain number.
template <class Rule>
struct rule_by_boost {
  template <class T>
  T value(const T& x) const {
    if constexpr (Infinitesimal<T>) {
      return lift(static_cast<const Rule&>(*this), x);
    } else {
      return static_cast<const Rule&>(*this).plain(x);
    }
  }
};

enum class bessel { j, y, i, k };

/// 2 C_ν′ = ±C_{ν−1} ± C_{ν+1}, without a division by x.
///
/// If x² is negligible beside 1, one of the two terms is the complete sum: the rest of the other,
/// and of its derivatives, would be ∞ − ∞.
template <bessel Kind>
struct cylinder : rule_by_boost<cylinder<Kind>> {
  static constexpr bool is_second = Kind == bessel::y || Kind == bessel::k;
  double order;
  constexpr explicit cylinder(double nu) : order(nu) {}

  template <class T>
  T plain(const T& x) const {
    if (x == 0) {
      return at_zero<T>();
    }
    if (Kind == bessel::y && order < 0 && is_integer()) { // Boost has another sign for small x
      const T y = cylinder(-order).plain(x);
      return std::fmod(order, 2) == 0 ? y : T(-y);
    }
    const T nu(order);
    if constexpr (Kind == bessel::j) {
      return boost::math::cyl_bessel_j(nu, x, quiet_policy());
    } else if constexpr (Kind == bessel::y) {
      return boost::math::cyl_neumann(nu, x, quiet_policy());
    } else if constexpr (Kind == bessel::i) {
      return boost::math::cyl_bessel_i(nu, x, quiet_policy());
    } else {
      return boost::math::cyl_bessel_k(nu, x, quiet_policy());
    }
  }
  template <class T>
  T slope(const T& x, const T&) const {
    using std::isinf;
    constexpr bool is_sum = Kind == bessel::i || Kind == bessel::k;
    T above = cylinder(order + 1).value(x);
    if (order == 0) {
      return Kind == bessel::i ? above : T(-above);
    }
    T below = cylinder(order - 1).value(x);
    const auto& z = innermost(x);
    const T& larger = is_larger_above() ? above : below;
    if (has_branch_point() &&
        (z * z < std::numeric_limits<real_type_t<T>>::min() || isinf(innermost(larger)))) {
      (is_larger_above() ? below : above) = T(0);
    }
    const T sum = is_sum ? T(below + above) : T(below - above);
    return Kind == bessel::k ? T(-sum / 2) : T(sum / 2);
  }

private:
  [[nodiscard]] bool is_integer() const { return std::trunc(order) == order; }
  /// Y_−½, Y_−3/2, …, which are ±J_½, ±J_3/2, …
  [[nodiscard]] bool is_of_first_kind() const {
    return !is_second ||
           (Kind == bessel::y && order < 0 && !is_integer() && cylinder(order + 0.5).is_integer());
  }
  /// True if it is not a power series at 0.
  [[nodiscard]] bool has_branch_point() const { return is_second || !is_integer(); }
  /// True if `above` is the larger of the two terms of the slope near 0.
  [[nodiscard]] bool is_larger_above() const {
    return is_second && (order > 0 || is_of_first_kind());
  }

  /// The limit from above.
  template <class T>
  [[nodiscard]] T at_zero() const {
    const double size = std::abs(order);
    const bool is_odd = std::fmod(std::floor(size), 2) == 1;
    const T infinity = std::numeric_limits<T>::infinity();
    if constexpr (Kind == bessel::k) {
      return infinity;
    } else if constexpr (Kind == bessel::y) {
      if (is_of_first_kind()) {
        return T(0);
      }
      // Y_−ν = cos νπ Y_ν + sin νπ J_ν
      const bool is_positive = order < 0 && std::fmod(std::floor(size + 0.5), 2) == 1;
      return is_positive ? infinity : T(-infinity);
    } else {
      if (order > 0 || (order != 0 && is_integer())) {
        return T(0);
      }
      return order == 0 ? T(1) : is_odd ? T(-infinity) : infinity; // (x/2)^ν/Γ(ν + 1)
    }
  }
};

/// (2n + 1) f_n′ = n f_{n−1} − (n + 1) f_{n+1}
template <bool IsNeumann>
struct spherical_bessel_rule : rule_by_boost<spherical_bessel_rule<IsNeumann>> {
  unsigned order;
  constexpr explicit spherical_bessel_rule(unsigned n) : order(n) {}

  template <class T>
  T plain(const T& x) const {
    if constexpr (IsNeumann) {
      return boost::math::sph_neumann(order, x, quiet_policy());
    } else {
      return boost::math::sph_bessel(order, x, quiet_policy());
    }
  }
  template <class T>
  T slope(const T& x, const T&) const {
    using std::isinf;
    using real = real_type_t<T>;
    const T above = spherical_bessel_rule(order + 1).value(x);
    if (order == 0) {
      return -above;
    }
    if (IsNeumann && isinf(innermost(above))) { // it is the larger one
      return -above;
    }
    return (real(order) * spherical_bessel_rule(order - 1).value(x) - real(order + 1) * above) /
           real(2 * order + 1);
  }
};

/// ∂/∂φ of the elliptic integrals: 1/Δ, Δ and 1/((1 − ν sin²φ)Δ), Δ² = 1 − k² sin²φ, of large k
/// cos²φ + (1 − k²) sin²φ, which does not cancel.
template <int Kind>
struct elliptic : rule_by_boost<elliptic<Kind>> {
  double modulus;
  double characteristic;
  constexpr explicit elliptic(double k, double nu = 0) : modulus(k), characteristic(nu) {}

  template <class T>
  T plain(const T& phi) const {
    const T k(modulus);
    if constexpr (Kind == 1) {
      return boost::math::ellint_1(k, phi, quiet_policy());
    } else if constexpr (Kind == 2) {
      return boost::math::ellint_2(k, phi, quiet_policy());
    } else {
      return boost::math::ellint_3(k, T(characteristic), phi, quiet_policy());
    }
  }
  template <class T>
  T slope(const T& phi, const T&) const {
    using std::abs;
    using std::cos;
    using std::sin;
    using std::sqrt;
    using real = real_type_t<T>;
    const T s = sin(phi);
    const real k(modulus);
    const T delta = [&] {
      if (k * k < real(0.5)) {
        return T(sqrt(one_minus_square(T(k * s))));
      }
      const T c = cos(phi);
      return k * k == 1 ? abs(c) : T(sqrt(T(c * c + (1 - k) * (1 + k) * s * s)));
    }();
    if constexpr (Kind == 1) {
      return 1 / delta;
    } else if constexpr (Kind == 2) {
      return delta;
    } else {
      return 1 / ((1 - real(characteristic) * s * s) * delta);
    }
  }
};

struct exponential_integral : rule_by_boost<exponential_integral> {
  template <class T>
  T plain(const T& x) const {
    return boost::math::expint(x, quiet_policy());
  }
  template <class T>
  T slope(const T& x, const T&) const {
    using std::exp;
    return exp(x) / x;
  }
};

/// B(x, y), with ∂B/∂x = B (ψ(x) − ψ(x + y)).
struct beta_rule {
  template <class T>
  T value(const T& x, const T& y) const {
    if constexpr (Infinitesimal<T>) {
      return lift(*this, x, y);
    } else if (x == 0 || y == 0) {
      return std::numeric_limits<T>::infinity();
    } else {
      return boost::math::beta(x, y, quiet_policy());
    }
  }
  template <class T>
  std::array<T, 2> slopes(const T& b, const T& x, const T& y) const {
    const T both = digamma(T(x + y));
    return {b * (digamma(x) - both), b * (digamma(y) - both)};
  }
};

/// K(k) = π/2 / agm(1, √(1 − k²)) by the arithmetic–geometric mean, and E(k) by the same iteration:
/// E/K = 1 − Σ 2^{n−1} c_n². Both over dual numbers, whose derivatives converge one step after
/// another.
template <class D>
[[nodiscard]] std::array<D, 2> complete_elliptic_by_mean(const D& k) {
  using std::sqrt;
  using real = real_type_t<D>;
  D a(1), b = sqrt(one_minus_square(k));
  D sum = k * k / 2;
  real weight(1);
  const int steps = 12 + scalar_traits<D>::order; // from b = 10⁻³⁰⁰ to the last digit
  for (int n = 0; n < steps; ++n) {
    const D c = (a - b) / 2, mean = (a + b) / 2;
    sum = sum + weight * c * c;
    weight = 2 * weight;
    b = sqrt(a * b);
    a = mean;
  }
  const D first = constant::pi<real>() / (2 * a);
  return {first, first * (1 - sum)};
}

/// K(k) and E(k) at k = ±1: K′ = (E/(1 − k²) − K)/k and E′ = (E − K)/k, whose largest term there
/// determines all derivatives.
template <bool IsFirst>
struct complete_at_one : rule_by_boost<complete_at_one<IsFirst>> {
  template <class T>
  T plain(const T&) const {
    return IsFirst ? std::numeric_limits<T>::infinity() : T(1);
  }
  template <class T>
  T slope(const T& k, const T&) const {
    return IsFirst ? T(1 / (k * one_minus_square(k)))
                   : T(complete_at_one<true>{}.value(k) * -innermost(k));
  }
};

template <class D>
[[nodiscard]] std::array<D, 2> complete_elliptic(const D& k) {
  if (innermost(k) * innermost(k) == 1) {
    return {complete_at_one<true>{}.value(k), complete_at_one<false>{}.value(k)};
  }
  return complete_elliptic_by_mean(k);
}

/// ζ(s) by the Euler–Maclaurin formula, for s clearly below 0 by the reflection to 1 − s.
template <class D>
[[nodiscard]] D zeta_of(const D& s) {
  using real = real_type_t<D>;
  if (innermost(s) < real(-0.25)) {
    // 2 (2π)^(s−1) sin(πs/2) Γ(1 − s) ζ(1 − s); whole periods are removed first, and Γ, which would
    // overflow, is computed in halves: Γ(x) = 2^(x−1)/√π Γ(x/2) Γ((x + 1)/2).
    const real periods = 4 * std::floor(innermost(s) / 4);
    const D other = 1 - s;
    const real pi = constant::pi<real>();
    return pow(pi, D(-other - real(0.5))) * tgamma(D(other / 2)) * tgamma(D((other + 1) / 2)) *
           sin(D((s - periods) * (pi / 2))) * zeta_of(other);
  }
  constexpr int terms = 8;
  const real n(terms);
  D sum(1);
  for (int k = 2; k < terms; ++k) {
    sum = sum + pow(real(k), D(-s));
  }
  const D power = pow(n, D(-s));
  if (innermost(power) == 0) {
    return sum; // its factor overflows
  }
  D rising = s / n; // s (s + 1) … (s + 2k − 2)/n^(2k−1)
  D tail = real(0.5) + n / (s - 1);
  // B₂ₖ/(2k)!
  constexpr std::array<long double, 12> factors{1.0L / 12,
                                                -1.0L / 720,
                                                1.0L / 30240,
                                                -1.0L / 1209600,
                                                1.0L / 47900160,
                                                -691.0L / 1307674368000,
                                                1.0L / 74724249600,
                                                -3617.0L / 10670622842880000,
                                                43867.0L / 5109094217170944000,
                                                -174611.0L / 802857662698291200000.0L,
                                                77683.0L / 14101100039391805440000.0L,
                                                -236364091.0L / 1693824136731743669452800000.0L};
  for (std::size_t k = 0; k < factors.size(); ++k) {
    tail = tail + real(factors[k]) * rising;
    rising = rising * (s + int(2 * k + 1)) * (s + int(2 * k + 2)) / (n * n);
  }
  return sum + power * tail;
}

/// p_n by the recurrence p_{k+1} = next(k, p_k, p_{k−1}) upwards from p_m = `first` and 0.
template <class D, class Next>
[[nodiscard]] D upwards(unsigned m, unsigned n, const D& first, const Next& next) {
  D below(0), p = first;
  for (unsigned k = m; k < n; ++k) {
    const D above = next(k, p, below);
    below = p;
    p = above;
  }
  return p;
}

/// dᵐP_l/dxᵐ by the recurrence of P_l^m upwards from (2m − 1)!!
template <class D>
[[nodiscard]] D legendre_by_recurrence(unsigned l, unsigned m, const D& x) {
  using real = real_type_t<D>;
  D first(m > l ? 0 : 1);
  for (unsigned k = 1; k < m; ++k) {
    first = first * real(2 * k + 1);
  }
  return upwards(m, l, first, [&](unsigned k, const D& p, const D& below) -> D {
    return (real(2 * k + 1) * x * p - real(k + m) * below) / real(k + 1 - m);
  });
}

/// √((2l + 1)/4π (l − m)!/(l + m)!) P_l^m, upwards from that of l = m, x = cos θ and s = −sin θ.
/// Factors near 1 instead of factorials, which leave the range.
template <class D>
[[nodiscard]] D normalized_legendre(unsigned l, unsigned m, const D& x, const D& s) {
  using std::sqrt;
  using real = real_type_t<D>;
  if (m > l) {
    return D(0);
  }
  D first(real(sqrt(1 / (4 * constant::pi<real>()))));
  for (unsigned k = 1; k <= m; ++k) {
    first = first * (real(sqrt(1 + 1 / (2 * real(k)))) * s);
  }
  const auto order = real(m);
  real b(0);
  return upwards(m, l, first, [&](unsigned k, const D& p, const D& below) {
    const real n = real(k) + 1;
    const real a = sqrt((4 * n * n - 1) / ((n - order) * (n + order)));
    const D above = a * (x * p - b * below);
    b = 1 / a;
    return above;
  });
}

} // namespace detail

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
  return detail::upwards(0, n, D(1), [&](unsigned k, const D& h, const D& below) -> D {
    return 2 * (x * h - real(k) * below);
  });
}
/// Associated Laguerre polynomial L_n^m(x).
template <SpecialArgument D>
[[nodiscard]] D assoc_laguerre(unsigned n, unsigned m, const D& x) {
  using real = real_type_t<D>;
  return detail::upwards(0, n, D(1), [&](unsigned k, const D& p, const D& below) -> D {
    return ((real(2 * k + m + 1) - x) * p - real(k + m) * below) / real(k + 1);
  });
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
