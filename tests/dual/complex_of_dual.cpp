// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/random.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/dual/complex.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <sstream>
#include <type_traits>

// std::complex over dual numbers: complex functions of a real parameter, |z| and arg z among them.
// The standard leaves std::complex of other than built-in types unspecified; these tests pin what
// its templates do.

namespace test_dual_complex_of_dual {

using duet::dual;
using duet::taylor;
using duet_test::random_source;

namespace {

using D = dual<double>;
using Z = std::complex<D>;
using C = std::complex<double>;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

C value(const Z& z) { return {z.real().value(), z.imag().value()}; }
C velocity(const Z& z) { return {z.real().epsilon(), z.imag().epsilon()}; }

Z moving(const C& z, const C& dz) { return {D(z.real(), dz.real()), D(z.imag(), dz.imag())}; }

bool near(const C& x, const C& exact, double scale) {
  return std::abs(x - exact) <= 32 * epsilon * (scale + std::abs(exact));
}
bool near(const D& x, double value, double slope, double scale) {
  return std::abs(x.value() - value) <= 8 * epsilon * std::abs(value) &&
         std::abs(x.epsilon() - slope) <= 8 * epsilon * scale;
}

struct moving_pair {
  C z, dz, w, dw;
  Z a = moving(z, dz);
  Z b = moving(w, dw);
};

moving_pair random_pair(random_source& random) {
  const auto number = [&] { return C(random.uniform(-2, 2), random.uniform(-2, 2)); };
  const C z = number();
  const C dz = number();
  const C w = number();
  return {z, dz, w, number()};
}

/// Along z(t) an analytic f has the velocity f′(z) ż: the dual number over the complex numbers is
/// the same thing in the other nesting.
template <class F>
void check_analytic(F f) {
  random_source random(3);
  for (int k = 0; k < 100; ++k) {
    const moving_pair p = random_pair(random);
    const Z y = f(p.a);
    const auto exact = f(dual<C>(p.z, p.dz));
    const double scale = std::abs(exact.value()) + std::abs(exact.epsilon());
    CHECK(near(value(y), exact.value(), scale));
    CHECK(near(velocity(y), exact.epsilon(), scale));
  }
}

} // namespace

TEST_CASE("arithmetic") {
  random_source random(1);
  for (int k = 0; k < 100; ++k) {
    const auto [z, dz, w, dw, a, b] = random_pair(random);
    CHECK(value(a + b) == z + w);
    CHECK(velocity(a + b) == dz + dw);
    CHECK(value(a - b) == z - w);
    CHECK(velocity(-a) == -dz);
    CHECK(near(value(a * b), z * w, std::abs(z * w)));
    CHECK(near(velocity(a * b), dz * w + z * dw, std::abs(dz * w) + std::abs(z * dw)));
    const C quotient = z / w;
    const double scale = std::abs(dz / w) + std::abs(quotient * dw / w);
    CHECK(near(value(a / b), quotient, std::abs(quotient)));
    CHECK(near(velocity(a / b), (dz - quotient * dw) / w, scale));
    const D s(z.imag(), 3);
    CHECK(near(velocity(a * s), dz * z.imag() + 3.0 * z, std::abs(dz * z.imag()) + std::abs(z)));
    Z c = a;
    c += b;
    c *= a;
    c -= s;
    c /= D(2);
    CHECK(near(velocity(c), (dz * (z + w) + z * (dz + dw) - 3.0) / 2.0, 4 * std::abs(dz) + 10));
  }
}

TEST_CASE("conversion, comparison, streams") {
  const Z z = C(1, 2); // a constant
  CHECK(value(z) == C(1, 2));
  CHECK(velocity(z) == C(0, 0));
  CHECK(z == Z(1.0, 2.0));
  CHECK(z == moving(C(1, 2), C(3, 4))); // by value, as duals
  CHECK(z != Z(1));
  CHECK(Z(3) == D(3));
  CHECK(Z() == D(0));
  Z w = z;
  w *= 2.0; // compound assignment converts, the binary operators deduce and do not
  w += 1;
  CHECK(value(w) == C(3, 4));
  std::ostringstream out;
  out << moving(C(1, 2), C(3, 4));
  CHECK(out.str() == "(1[3],2[4])");
}

TEST_CASE("modulus, argument, norm, conjugate, parts: what has no complex derivative") {
  random_source random(2);
  for (int k = 0; k < 200; ++k) {
    const moving_pair p = random_pair(random);
    const C z = p.z;
    const C dz = p.dz;
    const double r = std::abs(z);
    const C radial = std::conj(z) * dz; // d|z|²/2 + i |z|² dφ
    CHECK(near(abs(p.a), r, radial.real() / r, std::abs(dz)));
    CHECK(near(arg(p.a), std::arg(z), radial.imag() / (r * r), std::abs(dz) / r));
    CHECK(near(norm(p.a), r * r, 2 * radial.real(), 2 * r * std::abs(dz)));
    CHECK(value(conj(p.a)) == std::conj(z));
    CHECK(velocity(conj(p.a)) == std::conj(dz));
    CHECK(real(p.a).epsilon() == dz.real());
    CHECK(imag(p.a).epsilon() == dz.imag());
    // (ṙ + i r φ̇) e^{iφ}
    const Z polar = std::polar(D(r, dz.real()), D(std::arg(z), dz.imag()));
    CHECK(near(value(polar), z, r));
    CHECK(near(velocity(polar), C(dz.real(), r * dz.imag()) * z / r, r * std::abs(dz)));
    const Z back = std::polar(abs(p.a), arg(p.a));
    CHECK(near(velocity(back), dz, std::abs(dz)));
  }
}

TEST_CASE("the modulus neither overflows nor vanishes early") {
  const D large = abs(moving(C(3e200, 4e200), C(1, 2)));
  CHECK(near(large, 5e200, 0.6 + 1.6, 2.2));
  const D small = abs(moving(C(3e-200, 4e-200), C(1, 2)));
  CHECK(near(small, 5e-200, 0.6 + 1.6, 2.2));
  CHECK(abs(Z()) == 0);
  CHECK(abs(Z()).epsilon() == 0); // a constant
}

TEST_CASE("analytic functions agree with the duals over complex numbers") {
  check_analytic([](const auto& z) { return exp(z); });
  check_analytic([](const auto& z) { return log(z); });
  check_analytic([](const auto& z) { return sqrt(z); });
  check_analytic([](const auto& z) { return sin(z); });
  check_analytic([](const auto& z) { return cos(z); });
  check_analytic([](const auto& z) { return tan(z); });
  check_analytic([](const auto& z) { return sinh(z); });
  check_analytic([](const auto& z) { return cosh(z); });
  check_analytic([](const auto& z) { return tanh(z); });
  check_analytic([](const auto& z) { return pow(z, 3); });
  check_analytic([](const auto& z) { return pow(z, z); });
}

TEST_CASE("drivers go through complex results") {
  // A spiral z = r e^{iφ}, r = t, φ = t²; ż = (1 + 2it²) e^{iφ}, z̈ = (6it − 4t³) e^{iφ}.
  const auto spiral = [](const auto& t) { return std::polar(t, t * t); };
  const double t = 0.75;
  const C e = std::polar(1.0, t * t);
  const auto [z, dz] = duet::derivative(spiral, t);
  static_assert(std::is_same_v<std::remove_cvref_t<decltype(dz)>, C>);
  CHECK(z == std::polar(t, t * t));
  CHECK(near(dz, C(1, 2 * t * t) * e, 1));
  const auto zs = duet::derivatives<2>(spiral, t);
  CHECK(near(zs[1], dz, 1));
  CHECK(near(zs[2], C(-4 * t * t * t, 6 * t) * e, 1));
}

TEST_CASE("Taylor numbers: e^{it} has the derivatives i^k e^{it}") {
  using T = taylor<double, 4>;
  const std::complex<T> z = exp(std::complex<T>(T(0), T::variable(0.5)));
  C exact = std::polar(1.0, 0.5);
  for (int k = 0; k <= 4; ++k) {
    CHECK(near(C(z.real().derivative(k), z.imag().derivative(k)), exact, 1));
    exact *= C(0, 1);
  }
  CHECK(std::abs(abs(z).derivative(1)) <= 4 * epsilon); // it stays on the unit circle
}

} // namespace test_dual_complex_of_dual
