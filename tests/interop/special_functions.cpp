// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
#include "support/test.hpp"
#include "support/ulp.hpp"

#include <duet/core/batch/batch.hpp>
#include <duet/core/batch/math.hpp>
#include <duet/dual/second_dual.hpp>
#include <duet/interop/boost_math.hpp>
#include <duet/interop/special_functions.hpp>

#include <initializer_list>

// The special functions of <cmath> over Taylor numbers: derivatives to the third by differences of
// the defining integrals and series in 100 digits.

namespace test_interop_special_functions {
namespace {

using duet_test::central_difference;
using duet_test::worst_error;
using R = duet_test::real_100;

struct middle_tag;
struct outermost_tag;

const R pi = acos(R(-1));
constexpr double pi_half = 1.5707963267948966;

/// f and its derivatives against those of `exact`.
template <class F, class Exact>
void check(const char* name, F f, Exact exact, std::initializer_list<double> at,
           double limit = 64) {
  worst_error worst(name);
  for (const double x : at) {
    const auto y = f(duet::taylor<double, 3>::variable(x));
    const R length = R(0.3);
    std::array<R, 5> reference;
    reference[0] = exact(R(x));
    for (std::size_t k = 1; k < 5; ++k) {
      reference[k] = central_difference(exact, R(x), int(k), length);
    }
    for (std::size_t k = 0; k <= 3; ++k) {
      if (abs(reference[k]) < 1e-25) { // 0 except for the error of the difference
        CHECK_MESSAGE(std::abs(y.derivative(int(k))) <= 1e-14, name);
        continue;
      }
      const R scale = abs(reference[k]) + abs(R(reference[k + 1] * x));
      worst.add(duet_test::ulps(y.derivative(int(k)), reference[k], scale), k, x);
    }
  }
  CHECK_MESSAGE(worst <= limit, worst);
}

/// Checks f and its derivatives at x against `expected` in all numbers that carry them. NaN in
/// `expected` stands for any finite number.
template <class F, class Expected>
void check_all_numbers(F f, double x, Expected expected) {
  using D = duet::dual<double>;
  using second = duet::dual<D, 1, middle_tag>;
  using third = duet::dual<second, 1, outermost_tag>;
  const auto series = f(duet::taylor<double, 3>::variable(x));
  const auto nested = f(third::variable(second::variable(D::variable(x))));
  const auto half = f(duet::second_order_dual<double, 1>::variable(x));
  const std::array by_nesting{nested.value().value().value(), nested.value().value().epsilon(),
                              nested.value().epsilon().epsilon(),
                              nested.epsilon().epsilon().epsilon()};
  const std::array by_second{half.value(), half.partial(0), half.second_partial(0, 0)};
  for (std::size_t k = 0; k <= 3; ++k) {
    CAPTURE(k);
    const double y = expected(int(k));
    const auto is = [&](double z) { return y != y ? std::isfinite(z) : z == y; };
    CHECK(is(series.derivative(int(k))));
    CHECK(is(by_nesting[k]));
    CHECK((k == 3 || is(by_second[std::min(k, std::size_t(2))])));
  }
}

/// Σ_k (±z²/4)^k (z/2)^ν/(k! Γ(k + ν + 1))
R bessel_series(const R& nu, const R& z, int sign) {
  R term = pow(R(z / 2), nu) / tgamma(R(nu + 1));
  R sum = 0;
  for (int k = 1; k < 120; ++k) {
    sum += term;
    term *= sign * z * z / (4 * k * (k + nu));
  }
  return sum;
}

TEST_CASE("special functions: Bessel functions") {
  for (const int nu : {0, 1, 2, 5}) {
    check(
        "J", [=](const auto& x) { return cyl_bessel_j(nu, x); },
        [=](const R& x) { return bessel_series(nu, x, -1); }, {0.25, 1, 2.4, 7.5, 13});
    check(
        "I", [=](const auto& x) { return cyl_bessel_i(nu, x); },
        [=](const R& x) { return bessel_series(nu, x, 1); }, {0.25, 1, 2.4, 7.5, 13});
  }
  for (const double nu : {1.0 / 3, 1.5, 2.25}) { // also at 1e-8, where the leading power dominates
    const R order = nu;
    const auto at = {1e-8, 0.25, 1.0, 7.5};
    check(
        "J", [=](const auto& x) { return cyl_bessel_j(nu, x); },
        [=](const R& x) { return bessel_series(order, x, -1); }, at);
    check(
        "I", [=](const auto& x) { return cyl_bessel_i(nu, x); },
        [=](const R& x) { return bessel_series(order, x, 1); }, at);
    check(
        "Y", [=](const auto& x) { return cyl_neumann(nu, x); },
        [=](const R& x) -> R {
          return (cos(R(order * pi)) * bessel_series(order, x, -1) - bessel_series(-order, x, -1)) /
                 sin(R(order * pi));
        },
        at);
    check(
        "K", [=](const auto& x) { return cyl_bessel_k(nu, x); },
        [=](const R& x) -> R {
          return pi / 2 * (bessel_series(-order, x, 1) - bessel_series(order, x, 1)) /
                 sin(R(order * pi));
        },
        at);
  }
  // K_½ = √(π/2x) e^−x, Y_½ = −√(2/πx) cos x
  check(
      "K", [](const auto& x) { return cyl_bessel_k(0.5, x); },
      [](const R& x) -> R { return sqrt(R(pi / (2 * x))) * exp(R(-x)); }, {0.5, 1, 4});
  check(
      "Y", [](const auto& x) { return cyl_neumann(0.5, x); },
      [](const R& x) -> R { return -sqrt(R(2 / (pi * x))) * cos(x); }, {0.5, 1, 4, 9});
  check(
      "j", [](const auto& x) { return sph_bessel(1, x); },
      [](const R& x) -> R { return sin(x) / (x * x) - cos(x) / x; }, {0.5, 1, 4, 9});
  check(
      "y", [](const auto& x) { return sph_neumann(1, x); },
      [](const R& x) -> R { return -cos(x) / (x * x) - sin(x) / x; }, {0.5, 1, 4, 9});
  const auto at_zero = cyl_bessel_j(1, duet::taylor<double, 3>::variable(0));
  CHECK(at_zero.derivative(1) == 0.5);
  CHECK(at_zero.derivative(3) == doctest::Approx(-0.375).epsilon(1e-15));
}

TEST_CASE("special functions: Bessel functions at and near 0, where derivatives are infinite") {
  const double inf = std::numeric_limits<double>::infinity();
  const double nothing = 0;
  // Near 0 all are c x^p, except for integer orders of the first kind: 0, ±∞ or the value of x^p.
  const auto check_power = [&](const auto& f, double p, bool is_negative) {
    CAPTURE(p);
    const double sign = is_negative ? -1 : 1;
    double factor = sign;
    check_all_numbers(f, 0, [&](int k) {
      factor *= k == 0 ? 1 : p + 1 - k;
      return p == k ? std::numeric_limits<double>::quiet_NaN() : p > k ? nothing : factor * inf;
    });
    // If x^p is in range, its derivatives have the ratios p, p(p − 1), …
    const double x = 1e-50;
    const auto y = f(duet::taylor<double, 3>::variable(x));
    CHECK(y.value() * sign > 0);
    CHECK(y.derivative(1) * x == doctest::Approx(p * y.value()).epsilon(1e-13).scale(0));
    CHECK(y.derivative(3) * x * x * x ==
          doctest::Approx(p * (p - 1) * (p - 2) * y.value()).epsilon(1e-13).scale(0));
  };
  for (const double nu : {1.0 / 3, 0.5, 1.5, 2.25, 2.5, -0.5, -1.0 / 3, -1.5}) {
    const bool is_negative = nu < -1; // 1/Γ(ν + 1)
    check_power([=](const auto& x) { return cyl_bessel_j(nu, x); }, nu, is_negative);
    check_power([=](const auto& x) { return cyl_bessel_i(nu, x); }, nu, is_negative);
  }
  for (const double nu : {1.0 / 3, 0.5, 1.0, 1.5, 2.0, 2.5}) {
    check_power([=](const auto& x) { return cyl_neumann(nu, x); }, -nu, true);
    check_power([=](const auto& x) { return cyl_bessel_k(nu, x); }, -nu, false);
  }
  check_power([](const auto& x) { return cyl_neumann(-0.5, x); }, 0.5, false); // J_½
  check_power([](const auto& x) { return cyl_neumann(-1.5, x); }, 1.5, true);  // −J_3/2
  check_power([](const auto& x) { return cyl_neumann(-0.75, x); }, -0.75, false);
  check_power([](const auto& x) { return cyl_neumann(-1, x); }, -1, false);
  for (const unsigned n : {0u, 1u, 2u}) {
    check_power([=](const auto& x) { return sph_neumann(n, x); }, -1.0 - n, true);
  }
  const auto signs = [&](int k) { return k % 2 == 0 ? -inf : inf; };
  check_all_numbers([](const auto& x) { return cyl_neumann(0, x); }, 0, signs);
  check_all_numbers([](const auto& x) { return cyl_bessel_k(0, x); }, 0,
                    [&](int k) { return -signs(k); });
  // Also if values overflow.
  check_all_numbers([](const auto& x) { return cyl_neumann(5, x); }, 1e-100, signs);
  check_all_numbers([](const auto& x) { return sph_neumann(3, x); }, 1e-300, signs);
  CHECK(cyl_bessel_j(0.5, duet::dual<double>(0)).epsilon() == 0); // a constant
}

TEST_CASE("special functions: elliptic integrals") {
  // π/2 Σ ((2n)!/(4ⁿ n!²))² k²ⁿ, and the same over 1 − 2n
  const auto series = [](const R& k, bool is_second) {
    R term = pi / 2, sum = 0;
    for (int n = 0; n < 300; ++n) {
      sum += is_second ? R(term / (1 - 2 * n)) : term;
      const R ratio = R(2 * n + 1) / (2 * n + 2) * k;
      term *= ratio * ratio;
    }
    return sum;
  };
  check(
      "K", [](const auto& k) { return comp_ellint_1(k); },
      [=](const R& k) { return series(k, false); }, {-0.4, 0, 0.001, 0.3, 0.45});
  check(
      "E", [](const auto& k) { return comp_ellint_2(k); },
      [=](const R& k) { return series(k, true); }, {-0.4, 0, 0.001, 0.3, 0.45});

  // The derivative with respect to φ is the integrand.
  const auto check_integral = [](const auto& f, const auto& standard, const auto& integrand) {
    for (const double phi : {0.2, 1.0, 1.4}) {
      const auto y = f(duet::taylor<double, 3>::variable(phi));
      CHECK(y.value() == doctest::Approx(standard(phi)).epsilon(1e-14));
      CHECK(y.derivative(1) == doctest::Approx(double(integrand(R(phi)))).epsilon(1e-14));
      for (int k = 2; k <= 3; ++k) {
        const double exact = double(central_difference(integrand, R(phi), k - 1, R(0.3)));
        CHECK(y.derivative(k) == doctest::Approx(exact).epsilon(1e-13));
      }
    }
  };
  const auto root = [](const R& t) -> R { return sqrt(R(1 - R(0.7) * R(0.7) * sin(t) * sin(t))); };
  check_integral([](const auto& t) { return ellint_1(0.7, t); },
                 [](double t) { return std::ellint_1(0.7, t); },
                 [=](const R& t) -> R { return 1 / root(t); });
  check_integral([](const auto& t) { return ellint_2(0.7, t); },
                 [](double t) { return std::ellint_2(0.7, t); }, root);
  check_integral([](const auto& t) { return ellint_3(0.7, 0.25, t); },
                 [](double t) { return std::ellint_3(0.7, 0.25, t); },
                 [=](const R& t) -> R { return 1 / ((1 - R(0.25) * sin(t) * sin(t)) * root(t)); });
}

TEST_CASE("special functions: exponential integral, zeta and beta") {
  check(
      "Ei", [](const auto& x) { return expint(x); },
      [](const R& x) -> R { // γ + log|x| + Σ xᵏ/(k k!)
        R sum("0.57721566490153286060651209008240243104215933593992359880576723488486772677766467");
        sum += log(R(abs(x)));
        R term = 1;
        for (int i = 1; i < 150; ++i) {
          term *= x / i;
          sum += term / i;
        }
        return sum;
      },
      {-3, -0.5, 0.6, 2, 7});
  check(
      "zeta", [](const auto& s) { return riemann_zeta(s); },
      [](const R& s) -> R { // by the alternating series, accelerated (Cohen, Villegas, Zagier)
        const int n = 50;
        R d = pow(R(3 + sqrt(R(8))), n);
        d = (d + 1 / d) / 2;
        R b = -1, c = -d, sum = 0;
        for (int j = 0; j < n; ++j) {
          c = b - c;
          sum += c * exp(R(-s * log(R(j + 1))));
          b = b * (j + n) * (j - n) / ((j + R(0.5)) * (j + 1));
        }
        return sum / d / (1 - exp(R((1 - s) * log(R(2)))));
      },
      {-1.5, 0, 0.5, 2, 4.5});
  check(
      "beta", [](const auto& x) { return beta(x, 3); },
      [](const R& x) -> R { return 2 / (x * (x + 1) * (x + 2)); }, {0.5, 1, 2, 4.5});
  const auto mixed = beta(duet::second_order_dual<double, 2>::variable(1, 0),
                          duet::second_order_dual<double, 2>::variable(1, 1));
  CHECK(mixed.second_partial(0, 1) == // 2 − π²/6
        doctest::Approx(0.35506593315177356).epsilon(1e-14));
}

TEST_CASE("special functions: zeta near 0 and where its factors overflow") {
  using D = duet::dual<double>;
  const auto slope = [](double s) { return riemann_zeta(D::variable(s)).epsilon(); };
  CHECK(slope(50) == doctest::Approx(-std::log(2) * std::pow(2.0, -50)).epsilon(1e-8).scale(0));
  for (const double s : {400.0, 1e14, 1e30, 1e300}) {
    CHECK(std::abs(slope(s)) <= std::pow(2.0, -s));
  }
  CHECK(slope(-1e-20) == doctest::Approx(-0.91893853320467274178).epsilon(1e-14)); // −½ log 2π
  CHECK(slope(-0.2) == doctest::Approx(slope(-0.2 - 1e-14)).epsilon(1e-12));
  CHECK(slope(-0.25) == doctest::Approx(slope(-0.25 - 1e-14)).epsilon(1e-12));
  // At −2n: (−1)ⁿ (2n)! ζ(2n + 1)/(2 (2π)²ⁿ)
  for (const int n : {1, 60, 85, 86, 100, 125}) {
    const double size = 0.5 * double(exp(R(lgamma(R(2 * n + 1)) - 2 * n * log(R(2 * pi)))) *
                                     std::riemann_zeta(2 * n + 1));
    CHECK(slope(-2 * n) == doctest::Approx(n % 2 == 0 ? size : -size).epsilon(1e-12));
  }
}

TEST_CASE("special functions: orthogonal polynomials, also at the ends of their domains") {
  const auto at = {-1.0, -0.6, 0.0, 0.3, 1.0};
  check(
      "P4", [](const auto& x) { return legendre(4, x); },
      [](const R& x) -> R { return (35 * x * x * x * x - 30 * x * x + 3) / 8; }, at);
  check(
      "P42", [](const auto& x) { return assoc_legendre(4, 2, x); },
      [](const R& x) -> R { return (1 - x * x) * (105 * x * x - 15) / 2; }, at);
  check(
      "P31", [](const auto& x) { return assoc_legendre(3, 1, x); },
      [](const R& x) -> R { return sqrt(R(1 - x * x)) * (15 * x * x - 3) / 2; }, {-0.6, 0, 0.3});
  check(
      "Y31", [](const auto& t) { return sph_legendre(3, 1, t); },
      [](const R& t) -> R {
        return -sqrt(R(7 / (48 * pi))) * sin(t) * (15 * cos(t) * cos(t) - 3) / 2;
      },
      {0.3, 1, 2.5});
  check(
      "H4", [](const auto& x) { return hermite(4, x); },
      [](const R& x) -> R { return 16 * x * x * x * x - 48 * x * x + 12; }, at);
  check(
      "L3", [](const auto& x) { return laguerre(3, x); },
      [](const R& x) -> R { return (-x * x * x + 9 * x * x - 18 * x + 6) / 6; }, {0, 0.3, 1});
  check(
      "L21", [](const auto& x) { return assoc_laguerre(2, 1, x); },
      [](const R& x) -> R { return x * x / 2 - 3 * x + 3; }, {0, 0.3, 1});
}

TEST_CASE("special functions: associated Legendre functions of odd order at the ends") {
  using D = duet::dual<double>;
  for (const double x : {-1.0, 1.0}) {
    for (const unsigned m : {3u, 5u}) { // of (1 − x²)^(m/2)
      CHECK(assoc_legendre(5, m, D::variable(x)).value() == 0);
      CHECK(assoc_legendre(5, m, D::variable(x)).epsilon() == 0);
    }
  }
  // P_5^5 = 945 (1 − x²)^(5/2): its second derivative is 945 · 15 x² √(1 − x²) − 945 · 5 (1 −
  // x²)^(3/2)
  CHECK(assoc_legendre(5, 5, duet::taylor<double, 2>::variable(1)).derivative(2) == 0);
}

TEST_CASE(
    "special functions: associated Legendre functions of odd order, infinite derivatives at ends") {
  const double inf = std::numeric_limits<double>::infinity();
  for (const double x : {-1.0, 1.0}) {
    for (unsigned l = 1; l <= 6; ++l) {
      for (const unsigned m : {1u, 3u, 5u}) {
        if (m > l) {
          continue;
        }
        CAPTURE(x);
        CAPTURE(l);
        CAPTURE(m);
        // c (1 − x²)^(m/2), c = dᵐP_l/dxᵐ, positive at 1 and of parity l − m
        double factor = x > 0 || (l - m) % 2 == 0 ? 1 : -1;
        check_all_numbers([=](const auto& y) { return assoc_legendre(l, m, y); }, x,
                          [&](int k) {
                            factor *= k == 0 ? 1 : -x * (m / 2.0 + 1 - k);
                            return m > 2 * unsigned(k) ? 0 : factor * inf;
                          });
      }
    }
  }
}

TEST_CASE("special functions: end points of domains") {
  const double inf = std::numeric_limits<double>::infinity();
  const auto alternating = [=](int k) { return k % 2 == 0 ? inf : -inf; };
  check_all_numbers([](const auto& k) { return comp_ellint_1(k); }, 1, [=](int) { return inf; });
  check_all_numbers([](const auto& k) { return comp_ellint_1(k); }, -1, alternating);
  check_all_numbers([](const auto& k) { return comp_ellint_2(k); }, 1,
                    [=](int k) { return k == 0 ? 1 : -inf; });
  check_all_numbers([](const auto& k) { return comp_ellint_2(k); }, -1,
                    [=](int k) { return k == 0 ? 1 : -alternating(k); });
  check_all_numbers([](const auto& x) { return beta(x, 2); }, 0, alternating);
  check_all_numbers([](const auto& x) { return riemann_zeta(x); }, 1, alternating);
  check_all_numbers([](const auto& x) { return expint(x); }, 0,
                    [=](int k) { return -alternating(k); });
  check_all_numbers([](const auto& x) { return boost::math::cbrt(x); }, 0,
                    [=](int k) { return k == 0 ? 0 : -alternating(k); });
  // E(φ, 1) = sin φ to the last number before π/2
  const auto e = ellint_2(1, duet::taylor<double, 3>::variable(pi_half));
  CHECK(e.derivative(1) == std::cos(pi_half));
  CHECK(e.derivative(2) == -1);
  CHECK(e.derivative(3) == -std::cos(pi_half));
}

TEST_CASE("special functions: spherical harmonics of orders whose factorials overflow") {
  using D = duet::dual<double>;
  struct harmonic {
    unsigned l, m;
    double theta;
  };
  for (const auto [l, m, theta] :
       {harmonic{100, 100, pi_half}, harmonic{100, 99, 1.1}, harmonic{60, 7, 1.1},
        harmonic{60, 60, 2.0}, harmonic{40, 33, 0.7}, harmonic{5, 0, 0.4}}) {
    const D y = sph_legendre(l, m, D::variable(theta));
    const double value = std::sph_legendre(l, m, theta);
    CHECK(y.value() == doctest::Approx(value).epsilon(1e-11).scale(0));
    // Y′ = m cot θ Y_l^m + √((l − m)(l + m + 1)) Y_l^(m+1)
    const double next =
        m < l ? std::sqrt(double((l - m) * (l + m + 1))) * std::sph_legendre(l, m + 1, theta) : 0;
    const double slope = m / std::tan(theta) * value + next;
    CHECK(std::abs(y.epsilon() - slope) <= 1e-10 * (l + 1) * std::abs(value));
  }
  CHECK(sph_legendre(3, 4, D::variable(0.7)).value() == 0);
}

TEST_CASE("special functions: sinc, Lambert's W and the like of Boost.Math are duet's") {
  for (const double x : {9.0, 1e5, 1e80, 1e155, -1e300}) { // sin x/x
    const auto y = boost::math::sinc_pi(duet::taylor<double, 2>::variable(x));
    const double s = std::sin(x) / x, c = std::cos(x) / x;
    CHECK(y.value() == doctest::Approx(s).epsilon(1e-15).scale(0));
    CHECK(y.derivative(1) == doctest::Approx(c - s / x).epsilon(1e-14).scale(0));
    CHECK(y.derivative(2) == doctest::Approx(-s - 2 * (c - s / x) / x).epsilon(1e-13).scale(0));
  }
  using D = duet::dual<double>; // for which Boost has a separate template
  CHECK(boost::math::sinc_pi(D::variable(0.001)).epsilon() ==
        doctest::Approx(-0.001 / 3 * (1 - 1e-7)).epsilon(1e-13).scale(0));
  using lanes = duet::batch<double, 2>;
  CHECK(all(boost::math::sinc_pi(duet::dual<lanes>(lanes(0.0))).value() == 1));
  const auto at_zero = boost::math::sinc_pi(duet::taylor<double, 6>::variable(0));
  CHECK(at_zero.derivative(4) == doctest::Approx(0.2).epsilon(1e-15));
  CHECK(at_zero.derivative(6) == doctest::Approx(-1.0 / 7).epsilon(1e-15));
  // W(x) = Σ (−k)^(k−1) xᵏ/k!
  const auto w = boost::math::lambert_w0(duet::taylor<double, 5>::variable(0));
  for (int k = 1; k <= 5; ++k) {
    CHECK(w.derivative(k) == doctest::Approx(std::pow(-k, k - 1)).epsilon(1e-14));
  }
  const auto y = boost::math::lambert_w0(duet::taylor<double, 3>::variable(2));
  const double v = 0.8526055020137254913; // W(2); W‴ = (2W² + 8W + 9) W³/(x³ (1 + W)⁵)
  CHECK(y.derivative(3) ==
        doctest::Approx((2 * v * v + 8 * v + 9) * v * v * v / (8 * std::pow(1 + v, 5)))
            .epsilon(1e-14));
}

} // namespace
} // namespace test_interop_special_functions
