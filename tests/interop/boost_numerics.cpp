// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/derivative/implicit_function.hpp>
#include <duet/dual/math.hpp>

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <boost/math/quadrature/trapezoidal.hpp>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>

// Root finders and quadrature of Boost.Math, with dual numbers as parameters.

namespace test_interop_boost_numerics {
namespace {

using duet::innermost;

using D = duet::dual<double>;
using T = duet::taylor<double, 2>;
namespace quadrature = boost::math::quadrature;
namespace tools = boost::math::tools;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr int digits = std::numeric_limits<double>::digits;
using std::numbers::pi;

/// x³ = p
template <class P>
auto cubic(const P& p) {
  return [p](const auto& x) { return x * x * x - p; };
}

/// One step of Newton's method in the numbers that carry the derivatives, from a plain root: it
/// makes first derivatives exact (and two steps second ones).
template <class P>
P polished(const P& x, const P& p) {
  return x - cubic(p)(x) / (3 * x * x);
}

bool near(double x, double exact, double units = 16) {
  return std::abs(x - exact) <= units * epsilon * (1 + std::abs(exact));
}

constexpr double p0 = 5;
const double root = std::cbrt(p0);
const double root_slope = root / (3 * p0);
const double root_curvature = -2 * root / (9 * p0 * p0);

TEST_CASE("newton_raphson_iterate: the derivative is one step behind the value") {
  const auto solve = [](const auto& p, double start, std::uintmax_t iterations) {
    using S = std::decay_t<decltype(p)>;
    const auto f = [&](const S& x) { return std::pair<S, S>(cubic(p)(x), 3 * x * x); };
    return tools::newton_raphson_iterate(f, S(start), S(0.5), S(5), digits, iterations);
  };
  const D x = solve(D::variable(p0), 2, 50);
  CHECK(near(x.value(), root, 2));
  CHECK(near(x.epsilon(), root_slope));
  const T y = solve(T::variable(p0), 2, 50);
  CHECK(near(y.derivative(1), root_slope));
  CHECK(near(y.derivative(2), root_curvature));
  // Started at the solution it stops after one step: enough for the first derivative, not for the
  // second.
  const T z = solve(T::variable(p0), root, 50);
  CHECK(near(z.derivative(1), root_slope));
  CHECK(z.derivative(2) == 0);
}

TEST_CASE("bracketing root finders: see values only; one Newton step repairs the derivative") {
  const D p = D::variable(p0);
  const auto close = [](const D& a, const D& b) { return abs(a - b) <= 4 * epsilon; };
  const auto [low, high] = tools::bisect(cubic(p), D(0.5), D(5), close);
  CHECK(near(low.value(), root));
  CHECK(low.epsilon() == 0); // lost: the midpoints of constants are constants
  CHECK(high.epsilon() == 0);
  CHECK(near(polished(D(low.value()), p).epsilon(), root_slope));

  std::uintmax_t iterations = 100;
  const auto [below, above] =
      tools::toms748_solve(cubic(p), D(0.5), D(5), tools::eps_tolerance<D>(digits), iterations);
  CHECK(near(below.value(), root));
  CHECK(near(above.value(), root));
  // The derivative carried by the bracket is that of its last interpolation.
  CHECK(near(polished(D(below.value()), p).epsilon(), root_slope));

  const T q = T::variable(p0);
  const T once = polished(T(low.value()), q);
  CHECK(near(once.derivative(1), root_slope));
  CHECK(near(polished(once, q).derivative(2), root_curvature));
  const auto exact = duet::implicit_function<2>(
      [](const auto& x, const auto& parameter) { return cubic(parameter)(x); }, 2.0, p0);
  CHECK(near(exact[1], root_slope));
  CHECK(near(exact[2], root_curvature));
}

TEST_CASE("brent_find_minima: finds the minimiser; the envelope theorem gives the derivative") {
  // min_x cosh(x − p) + p² is at x = p; the minimum is 1 + p², its slope 2p.
  const D p = D::variable(0.75);
  const auto f = [&](const D& x) { return D(cosh(x - p) + p * p); };
  const auto [x, minimum] = tools::brent_find_minima(f, D(-1), D(2), digits / 2);
  CHECK(std::abs(x.value() - 0.75) <= 1e-7); // half the digits, as for doubles
  CHECK(near(minimum.value(), 1.5625));
  // At the minimiser, taken as a constant, the derivative of the minimum is as accurate as it is.
  CHECK(std::abs(f(D(x.value())).epsilon() - 1.5) <= 1e-7);
}

// ∫₀¹ e^{px} dx = (e^p − 1)/p, and ∫₀^b of the same with a limit that moves.

constexpr double rate = 1.25;
const double grown = std::exp(rate);
const double area = (grown - 1) / rate;
const double area_slope = (grown - area) / rate;
const double area_curvature = (grown - 2 * area_slope) / rate;

/// Boost gives the integral the type of the limits, so these must be dual numbers too.
template <class Integrate>
void check_parameter(Integrate integrate, double units) {
  const auto of = [&](const auto& p) {
    using S = std::decay_t<decltype(p)>;
    return integrate([p](const S& x) { return S(exp(p * x)); }, S(0), S(1));
  };
  const D y = of(D::variable(rate));
  CHECK(near(y.value(), area, units));
  CHECK(near(y.epsilon(), area_slope, units));
  const T s = of(T::variable(rate));
  CHECK(near(s.derivative(1), area_slope, units));
  CHECK(near(s.derivative(2), area_curvature, units));
}

/// The integral with the dual as upper limit: its derivative is the integrand at that limit.
template <class Integrate>
void check_limit(Integrate integrate, double units) {
  const D b = D::variable(1);
  const D y = integrate([](const D& x) { return D(exp(rate * x)); }, D(0), b);
  CHECK(near(y.value(), area, units));
  CHECK(near(y.epsilon(), grown, units));
}

TEST_CASE("quadrature: integrands and limits may depend on a dual number") {
  const auto gauss = [](auto f, auto a, auto b) {
    return quadrature::gauss<decltype(a), 15>::integrate(f, a, b);
  };
  check_parameter(gauss, 8);
  check_limit(gauss, 8);
  const auto gauss_kronrod = [](auto f, auto a, auto b) {
    return quadrature::gauss_kronrod<decltype(a), 15>::integrate(f, a, b);
  };
  check_parameter(gauss_kronrod, 8);
  check_limit(gauss_kronrod, 8);
  const auto tanh_sinh = [](auto f, auto a, auto b) {
    return quadrature::tanh_sinh<decltype(a)>().integrate(f, a, b);
  };
  check_parameter(tanh_sinh, 16);
  check_limit(tanh_sinh, 16);
}

TEST_CASE("trapezoidal: exact for periodic functions") {
  // ∫₀^2π e^{p cos x} dx = 2π I₀(p)
  const D p = D::variable(1);
  const auto f = [&](const D& x) { return D(exp(p * cos(x))); };
  const D y = quadrature::trapezoidal(f, D(0), D(2 * pi), D(1e-12));
  CHECK(near(y.value(), 2 * pi * std::cyl_bessel_i(0, 1.0)));
  CHECK(near(y.epsilon(), 2 * pi * std::cyl_bessel_i(1, 1.0)));
}

} // namespace
} // namespace test_interop_boost_numerics
