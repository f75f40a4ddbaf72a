// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/dual/math.hpp>
#include <duet/interop/boost_math.hpp>

#include <boost/math/special_functions/bessel.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/cbrt.hpp>
#include <boost/math/special_functions/digamma.hpp>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <boost/math/special_functions/expint.hpp>
#include <boost/math/special_functions/hermite.hpp>
#include <boost/math/special_functions/hypot.hpp>
#include <boost/math/special_functions/laguerre.hpp>
#include <boost/math/special_functions/lambert_w.hpp>
#include <boost/math/special_functions/legendre.hpp>
#include <boost/math/special_functions/sinc.hpp>
#include <boost/math/special_functions/trigamma.hpp>
#include <boost/math/special_functions/zeta.hpp>

#include <initializer_list>

// The special functions of Boost.Math called with dual and Taylor numbers.

namespace test_interop_boost_math {
namespace {

using D = duet::dual<double>;
using T = duet::taylor<double, 4>;
using wide = long double;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr wide pi = std::numbers::pi_v<wide>;

/// f′ by the central difference of order 8; the step is small against the distance of x from
/// the nearest singularity.
template <class F>
wide difference(F f, wide x, wide length) {
  const wide h = length / 64;
  const auto odd = [&](int k) { return f(wide(x + k * h)) - f(wide(x - k * h)); };
  return (odd(1) * 4 / 5 - odd(2) / 5 + odd(3) * 4 / 105 - odd(4) / 280) / h;
}

/// If f is approximated piecewise, the derivatives are slightly less accurate than the values.
constexpr double tolerance = 64 * epsilon;

/// f‴ of a slope of order `order` − 1 by differences of order 6, to ten digits.
template <class F>
wide high_difference(F df, int order, wide x, wide length) {
  const wide h = length / 32;
  const auto at = [&](int k) { return df(wide(x + k * h)); };
  if (order == 3) {
    const auto even = [&](int k) { return at(k) + at(-k); };
    return (even(1) * 1.5L - even(2) * 3 / 20 + even(3) / 90 - at(0) * 49 / 18) / (h * h);
  }
  const auto odd = [&](int k) { return at(k) - at(-k); };
  return (odd(1) * -488 + odd(2) * 338 - odd(3) * 72 + odd(4) * 7) / (240 * h * h * h);
}

/// f and f″ against differences, f′ against its closed form `df` if there is one, and f‴ and f⁗
/// to six digits.
template <class F, class DF>
void check(const char* name, F f, DF df, std::initializer_list<double> points, wide length = 1) {
  for (const double x : points) {
    CAPTURE(name);
    CAPTURE(x);
    const D y = f(D::variable(x));
    const T series = f(T::variable(x));
    const double value = double(f(wide(x)));
    const double slope = double(df(wide(x)));
    const double curvature = double(difference(df, wide(x), length));
    const double scale = std::abs(value) + std::abs(slope * x);
    const double slope_scale = scale + std::abs(slope) + std::abs(curvature * x);
    CHECK(std::abs(y.value() - value) <= 16 * epsilon * scale);
    CHECK(std::abs(y.epsilon() - slope) <= tolerance * slope_scale);
    CHECK(std::abs(series.value() - value) <= 16 * epsilon * scale);
    CHECK(std::abs(series.derivative(1) - slope) <= tolerance * slope_scale);
    CHECK(std::abs(series.derivative(2) - curvature) <=
          1e-12 * (slope_scale + std::abs(curvature)));
    for (int order = 3; order <= 4; ++order) {
      const auto higher = double(high_difference(df, order, wide(x), length));
      CHECK(std::abs(series.derivative(order) - higher) <=
            1e-6 * (slope_scale + std::abs(curvature) + std::abs(higher)));
    }
  }
}

/// As above, if f′ has no closed form.
template <class F>
void check(const char* name, F f, std::initializer_list<double> points, wide length = 1) {
  check(
      name, f, [=](wide x) { return difference(f, x, length); }, points, length / 2);
}

namespace bm = boost::math;

TEST_CASE("Boost.Math over dual: gamma functions, also at integers") {
  check(
      "tgamma", [](auto x) { return bm::tgamma(x); },
      [](wide x) { return bm::tgamma(x) * bm::digamma(x); }, {1, 1.5, 2, 2.3, 3, 4.7, 10}, 0.5L);
  check(
      "lgamma", [](auto x) { return bm::lgamma(x); }, [](wide x) { return bm::digamma(x); },
      {1, 1.5, 2, 2.3, 3, 4.7, 10, 25.5}, 0.5L);
  check(
      "digamma", [](auto x) { return bm::digamma(x); }, [](wide x) { return bm::trigamma(x); },
      {1, 1.7, 2, 3.2, 12}, 0.5L);
  check(
      "beta", [](auto x) { return bm::beta(x, decltype(x)(2.5)); },
      [](wide x) { return bm::beta(x, 2.5L) * (bm::digamma(x) - bm::digamma(x + 2.5L)); },
      {1.5, 2, 7}, 0.5L);
  const auto density = [](wide x) { return x * std::sqrt(x) * std::exp(-x) / bm::tgamma(2.5L); };
  check(
      "gamma_p", [](auto x) { return bm::gamma_p(decltype(x)(2.5), x); }, density,
      {0.8, 1.7, 2.5, 4, 12}, 0.5L);
  check(
      "gamma_q", [](auto x) { return bm::gamma_q(decltype(x)(2.5), x); },
      [=](wide x) { return -density(x); }, {0.8, 1.7, 2.5, 4}, 0.5L);
  check(
      "gamma_p of its parameter", [](auto a) { return bm::gamma_p(a, decltype(a)(1.2)); },
      {1.7, 2.6, 7.3}, 0.5L);
  check(
      "ibeta", [](auto x) { return bm::ibeta(decltype(x)(2.5), decltype(x)(1.5), x); },
      [](wide x) { return x * std::sqrt(x) * std::sqrt(1 - x) / bm::beta(2.5L, 1.5L); },
      {0.3, 0.5, 0.7}, 0.25L);
}

TEST_CASE("Boost.Math over dual: error functions, also at 0") {
  const auto bell = [](wide x) { return 2 / std::sqrt(pi) * std::exp(-x * x); };
  check("erf", [](auto x) { return bm::erf(x); }, bell, {-1, 0, 0.1, 0.7, 2});
  check(
      "erfc", [](auto x) { return bm::erfc(x); }, [=](wide x) { return -bell(x); },
      {-1, 0, 0.1, 0.7, 2});
  check(
      "erf_inv", [](auto x) { return bm::erf_inv(x); },
      [=](wide x) { return 1 / bell(bm::erf_inv(x)); }, {-0.4, 0.3, 0.6}, 0.25L);
}

TEST_CASE("Boost.Math over dual: Bessel functions") {
  check(
      "J0", [](auto x) { return bm::cyl_bessel_j(0, x); },
      [](wide x) { return -bm::cyl_bessel_j(1, x); }, {0.3, 1, 2.1, 5, 9, 30});
  check(
      "J1", [](auto x) { return bm::cyl_bessel_j(1, x); },
      [](wide x) { return bm::cyl_bessel_j(0, x) - bm::cyl_bessel_j(1, x) / x; },
      {1, 2.1, 5, 9, 30}, 0.5L);
  check(
      "J1/2", [](auto x) { return bm::cyl_bessel_j(decltype(x)(0.5), x); },
      [](wide x) { // √(2/πx) sin x
        return std::sqrt(2 / (pi * x)) * (std::cos(x) - std::sin(x) / (2 * x));
      },
      {1, 2.1, 5, 9}, 0.5L);
  check(
      "Y1", [](auto x) { return bm::cyl_neumann(1, x); },
      [](wide x) { return bm::cyl_neumann(0, x) - bm::cyl_neumann(1, x) / x; }, {1, 2.1, 5, 9},
      0.5L);
  check(
      "I1", [](auto x) { return bm::cyl_bessel_i(1, x); },
      [](wide x) { return bm::cyl_bessel_i(0, x) - bm::cyl_bessel_i(1, x) / x; }, {1, 2.1, 9},
      0.5L);
  check(
      "K1", [](auto x) { return bm::cyl_bessel_k(1, x); },
      [](wide x) { return -bm::cyl_bessel_k(0, x) - bm::cyl_bessel_k(1, x) / x; }, {1, 2.1, 9},
      0.5L);
}

TEST_CASE("Boost.Math over dual: orthogonal polynomials") {
  check(
      "P3", [](auto x) { return bm::legendre_p(3, x); },
      [](wide x) { return (15 * x * x - 3) / 2; }, {-0.5, 0, 0.3}, 0.25L);
  check(
      "H4", [](auto x) { return bm::hermite(4, x); }, [](wide x) { return 8 * bm::hermite(3, x); },
      {-0.5, 0, 0.3, 2});
  check(
      "L4", [](auto x) { return bm::laguerre(4, x); },
      [](wide x) { return -bm::laguerre(3, 1, x); }, {0, 0.3, 2});
}

TEST_CASE("Boost.Math over dual: elliptic integrals") {
  const auto first = [](wide k) { return bm::ellint_1(k); };
  const auto second = [](wide k) { return bm::ellint_2(k); };
  check(
      "K", [](auto k) { return bm::ellint_1(k); },
      [=](wide k) { return second(k) / (k * (1 - k * k)) - first(k) / k; }, {-0.3, 0.4, 0.6}, 0.2L);
  check(
      "E", [](auto k) { return bm::ellint_2(k); },
      [=](wide k) { return (second(k) - first(k)) / k; }, {-0.3, 0.4, 0.6}, 0.2L);
  check(
      "F", [](auto phi) { return bm::ellint_1(decltype(phi)(0.4), phi); },
      [](wide phi) { return 1 / std::sqrt(1 - 0.16L * std::sin(phi) * std::sin(phi)); },
      {0.4, 0.9, 3});
  check(
      "E(phi)", [](auto phi) { return bm::ellint_2(decltype(phi)(0.4), phi); },
      [](wide phi) { return std::sqrt(1 - 0.16L * std::sin(phi) * std::sin(phi)); }, {0.4, 0.9, 3});
}

TEST_CASE(
    "Boost.Math over dual: zeta, exponential integral, sinc, Lambert's W, cube root, hypotenuse") {
  check(
      "zeta", [](auto x) { return bm::zeta(x); }, {2.5, 3.2, 5.5}, 0.5L);
  check(
      "Ei", [](auto x) { return bm::expint(x); }, [](wide x) { return std::exp(x) / x; },
      {1, 1.3, 3, 7}, 0.5L);
  check(
      "E2", [](auto x) { return bm::expint(2, x); }, [](wide x) { return -bm::expint(1, x); },
      {1.3, 3}, 0.5L);
  check(
      "sinc", [](auto x) { return bm::sinc_pi(x); },
      [](wide x) { return x == 0 ? 0 : std::cos(x) / x - std::sin(x) / (x * x); }, {0.4, 1, 3},
      0.25L);
  check(
      "W", [](auto x) { return bm::lambert_w0(x); },
      [](wide x) { return 1 / (x + std::exp(bm::lambert_w0(x))); }, {0.5, 1, 3, 20}, 0.5L);
  check(
      "cbrt", [](auto x) { return bm::cbrt(x); },
      [](wide x) { return 1 / (3 * std::cbrt(x) * std::cbrt(x)); }, {-2, 0.8, 8}, 0.5L);
  check(
      "hypot", [](auto x) { return bm::hypot(x, decltype(x)(1.5)); },
      [](wide x) { return x / std::hypot(x, 1.5L); }, {-1, 0, 0.3, 8});
}

// Boost answers these arguments from a table or a special case, mostly by a constant. They are in
// docs/reference/boost_functions.md. If this test fails with a newer Boost, update that page.
TEST_CASE("Boost.Math over dual: known errors at arguments that Boost compares with a constant") {
  const auto lost = [](const D& y) { return y.epsilon() == 0; };
  const auto at = [](double x) { return D::variable(x); };
  CHECK(lost(bm::zeta(at(2))));
  CHECK(lost(bm::zeta(at(3))));
  CHECK(lost(bm::beta(at(1), D(2.5))));
  CHECK(lost(bm::gamma_p(at(0.5), D(1.2))));
  CHECK(lost(bm::gamma_p(at(2), D(1.2))));
  CHECK(lost(bm::ibeta(at(1), D(1.5), D(0.4))));
  CHECK(lost(bm::cyl_bessel_j(at(2), D(2.1)))); // the order; the argument is fine
  CHECK(lost(bm::cyl_bessel_j(1, at(0))));      // ½
  CHECK(lost(bm::cyl_bessel_i(1, at(0))));      // ½
  CHECK(lost(bm::erf_inv(at(0))));              // √π/2
  CHECK(lost(bm::ellint_2(D(0.4), at(0))));     // 1
  CHECK(lost(bm::beta(at(2.3), D(1e-20))));     // where b < ε; −ψ′(2.3)
  CHECK(lost(bm::gamma_p(D(30.5), at(30.5))));  // x = a, as at 300.5
  const T zero = T::variable(0);
  CHECK(bm::cyl_bessel_j(0, zero).derivative(2) == 0); // −½
  CHECK(bm::cyl_bessel_i(0, zero).derivative(2) == 0); // ½
  // Series and continued fractions stop when the value is right: √(π/2x) e^−x is 6 % off.
  const double k = std::sqrt(double(pi)) / 2 * std::exp(-2.0); // K_½(2)
  const double third = bm::cyl_bessel_k(T(0.5), T::variable(2)).derivative(3);
  CHECK(std::abs(third + 2.546875 * k) > 0.01 * k);
  // Twice π/4: Carlson's integral of two equal arguments moves both.
  CHECK(std::abs(bm::ellint_1(zero).derivative(2) - double(pi) / 2) <= tolerance);
  CHECK(std::abs(bm::ellint_2(zero).derivative(2) + double(pi) / 2) <= tolerance);
}

} // namespace
} // namespace test_interop_boost_math
