// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/constants.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/parts.hpp>
#include <duet/interop/bessel_rules.hpp>

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

/// \file
/// Derivatives of the special functions of special_functions.hpp; see dual/rules/elementary.hpp.

namespace duet {
namespace detail {

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

/// dᵐP_l/dxᵐ by the recurrence of P_l^m upwards from (2m − 1)!!
template <class D>
[[nodiscard]] D legendre_by_recurrence(unsigned l, unsigned m, const D& x) {
  using real = real_type_t<D>;
  if (m > l) {
    return D(0);
  }
  D below(0), p(1);
  for (unsigned k = 1; k < m; ++k) {
    p = p * real(2 * k + 1);
  }
  for (unsigned k = m; k < l; ++k) {
    const D above = (real(2 * k + 1) * x * p - real(k + m) * below) / real(k + 1 - m);
    below = p;
    p = above;
  }
  return p;
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
  D below(0), p(real(sqrt(1 / (4 * constant::pi<real>()))));
  for (unsigned k = 1; k <= m; ++k) {
    p = p * (real(sqrt(1 + 1 / (2 * real(k)))) * s);
  }
  const auto order = real(m);
  real b(0);
  for (unsigned k = m; k < l; ++k) {
    const real n = real(k) + 1;
    const real a = sqrt((4 * n * n - 1) / ((n - order) * (n + order)));
    const D above = a * (x * p - b * below);
    b = 1 / a;
    below = p;
    p = above;
  }
  return p;
}

} // namespace detail

} // namespace duet
