// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/identical.hpp"
#include "support/multiprecision.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/core/batch/batch.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/dual/complex.hpp>
#include <duet/dual/eigen_traits.hpp>

#include <Eigen/Core>

#include <complex>

// std::complex over dual numbers: complex functions of a real parameter, |z| and arg z among them.

namespace test_dual_complex_of_dual {
namespace {

using duet::dual, duet::taylor, duet_test::random_source;

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

TEST_CASE("std::complex of dual: arithmetic") {
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

TEST_CASE("std::complex of dual: conversion, comparison and streams") {
  const Z z = C(1, 2); // a constant
  CHECK(value(z) == C(1, 2));
  CHECK(velocity(z) == C(0, 0));
  CHECK(z == Z(1.0, 2.0));
  CHECK(z == moving(C(1, 2), C(3, 4))); // by value, as duals
  CHECK(z != Z(1));
  CHECK(Z(3) == D(3));
  CHECK(Z() == D(0));
  Z w = z;
  w *= 2.0;
  w += 1;
  CHECK(value(w) == C(3, 4));
  std::ostringstream out;
  out << moving(C(1, 2), C(3, 4));
  CHECK(out.str() == "(1[3],2[4])");
}

TEST_CASE("std::complex of dual: modulus, argument, norm, conjugate and parts have derivatives") {
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

TEST_CASE("std::complex of dual: the modulus neither overflows nor underflows early") {
  const D large = abs(moving(C(3e200, 4e200), C(1, 2)));
  CHECK(near(large, 5e200, 0.6 + 1.6, 2.2));
  const D small = abs(moving(C(3e-200, 4e-200), C(1, 2)));
  CHECK(near(small, 5e-200, 0.6 + 1.6, 2.2));
  CHECK(abs(Z()) == 0);
  CHECK(abs(Z()).epsilon() == 0); // a constant
}

TEST_CASE("std::complex of dual: drivers differentiate complex results") {
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

TEST_CASE("std::complex of Taylor: e^{it} has the derivatives i^k e^{it}") {
  using T = taylor<double, 4>;
  const std::complex<T> z = exp(std::complex<T>(T(0), T::variable(0.5)));
  C exact = std::polar(1.0, 0.5);
  for (int k = 0; k <= 4; ++k) {
    CHECK(near(C(z.real().derivative(k), z.imag().derivative(k)), exact, 1));
    exact *= C(0, 1);
  }
  CHECK(std::abs(abs(z).derivative(1)) <= 4 * epsilon); // it stays on the unit circle
}

using R = duet_test::real_100;
using CR = std::complex<R>;
using series = taylor<double, 3>;
struct middle_tag;
struct outermost_tag;
using nested = dual<dual<D, 1, middle_tag>, 1, outermost_tag>;

/// visit(name, f over complex numbers of any precision). Of 100 digits the standard library has no
/// arcsines: those of complex numbers over R are by logarithms.
template <class Visit>
void for_each_function(Visit&& visit) {
  visit("exp", [](const auto& z) { return std::exp(z); });
  visit("log", [](const auto& z) { return std::log(z); });
  visit("sqrt", [](const auto& z) { return std::sqrt(z); });
  visit("sin", [](const auto& z) { return std::sin(z); });
  visit("cos", [](const auto& z) { return std::cos(z); });
  visit("tan", [](const auto& z) { return std::tan(z); });
  visit("sinh", [](const auto& z) { return std::sinh(z); });
  visit("cosh", [](const auto& z) { return std::cosh(z); });
  visit("tanh", [](const auto& z) { return std::tanh(z); });
  // In 100 digits by logarithms.
  const CR i(R(0), R(1)), one(R(1)), two(R(2));
  const auto visit_inverse = [&](const std::string& name, const auto& wide, const auto& f) {
    visit(name, [=]<class T>(const std::complex<T>& z) {
      if constexpr (std::is_same_v<T, R>) {
        return CR(wide(z));
      } else {
        return f(z);
      }
    });
  };
  visit_inverse(
      "log10", [=](const CR& z) { return log(z) / log(R(10)); },
      [](const auto& z) { return std::log10(z); });
  visit_inverse(
      "asin", [=](const CR& z) { return -i * log(i * z + sqrt(one - z) * sqrt(one + z)); },
      [](const auto& z) { return std::asin(z); });
  visit_inverse(
      "acos", [=](const CR& z) { return -i * log(z + i * sqrt(one - z) * sqrt(one + z)); },
      [](const auto& z) { return std::acos(z); });
  visit_inverse(
      "atan", [=](const CR& z) { return i / two * (log(one - i * z) - log(one + i * z)); },
      [](const auto& z) { return std::atan(z); });
  visit_inverse(
      "asinh", [=](const CR& z) { return log(z + sqrt(one + i * z) * sqrt(one - i * z)); },
      [](const auto& z) { return std::asinh(z); });
  visit_inverse(
      "acosh", [=](const CR& z) { return log(z + sqrt(z - one) * sqrt(z + one)); },
      [](const auto& z) { return std::acosh(z); });
  visit_inverse(
      "atanh", [=](const CR& z) { return (log(one + z) - log(one - z)) / two; },
      [](const auto& z) { return std::atanh(z); });
  // (Of 100 digits libc++ has powers of two complex numbers only.)
  const auto power = []<class T, class X, class P>(std::type_identity<T>, const X& x, const P& p) {
    if constexpr (std::is_same_v<T, R>) {
      return CR(std::exp(CR(p) * std::log(CR(x))));
    } else {
      return std::pow(x, p);
    }
  };
  visit("pow(z, 2)",
        [=]<class T>(const std::complex<T>& z) { return power(std::type_identity<T>(), z, T(2)); });
  visit("pow(z, -3)", []<class T>(const std::complex<T>& z) {
    return std::complex<T>(std::pow(z, std::complex<T>(T(-3))));
  });
  visit("pow(z, 1/2)", [=]<class T>(const std::complex<T>& z) {
    return power(std::type_identity<T>(), z, T(0.5));
  });
  visit("pow(z, z)", [](const auto& z) { return std::pow(z, z); });
  visit("pow(2, z)",
        [=]<class T>(const std::complex<T>& z) { return power(std::type_identity<T>(), T(2), z); });
  visit("z/(2 + z²)", []<class T>(const std::complex<T>& z) { return z / (z * z + T(2)); });
}

/// x with another value; a sum would lose the sign of a zero.
template <class T>
T with_value(const T& x, double value) {
  if constexpr (duet::Infinitesimal<T>) {
    return x.with_value(with_value(x.value(), value));
  } else {
    return value;
  }
}
/// v + td for the t, of value 0, by which it is differentiated.
template <class T>
std::complex<T> along(const C& v, const C& d, const T& t) {
  return {with_value(T(t * d.real()), v.real()), with_value(T(t * d.imag()), v.imag())};
}

std::array<C, 4> derivatives_of(const std::complex<series>& y) {
  std::array<C, 4> result;
  for (int k = 0; k <= 3; ++k) {
    result[std::size_t(k)] = C(y.real().derivative(k), y.imag().derivative(k));
  }
  return result;
}
std::array<C, 4> derivatives_of(const std::complex<nested>& y) {
  const auto of_part = [](const nested& x) {
    return std::array{x.value().value().value(), x.value().value().epsilon(),
                      x.value().epsilon().epsilon(), x.epsilon().epsilon().epsilon()};
  };
  std::array<C, 4> result;
  for (std::size_t k = 0; k <= 3; ++k) {
    result[k] = C(of_part(y.real())[k], of_part(y.imag())[k]);
  }
  return result;
}

using duet_test::identical;
bool identical(const C& a, const C& b) {
  return identical(a.real(), b.real()) && identical(a.imag(), b.imag());
}

bool is_infinite(const C& z) { return std::isinf(z.real()) || std::isinf(z.imag()); }

TEST_CASE("std::complex of dual: derivatives to the third agree with differences in 100 digits") {
  // Among them equal parts, on axes, small and large.
  const C points[] = {{1, 0.5},  {1, 1},      {-1, 1},     {2, -2},      {0.5, 0.5},  {0.25, 0},
                      {0, 0.75}, {0.3, -1.7}, {-0.4, 0.2}, {1e-9, 2e-9}, {-3, -0.25}, {5, 4}};
  for_each_function([&](const std::string& name, const auto& f) {
    for (const C& v : points) {
      // along the axes, which are cuts, where the point is on one
      const C d = v.imag() == 0 ? C(1, 0) : v.real() == 0 ? C(0, 1) : C(2, -3);
      const auto by_series = derivatives_of(f(along(v, d, series::variable(0))));
      const auto by_nesting = derivatives_of(
          f(along(v, d, nested::variable(dual<D, 1, middle_tag>::variable(D::variable(0))))));
      std::array<C, 4> exact;
      for (int k = 0; k <= 3; ++k) {
        const auto part = [&](bool is_imaginary) {
          const auto along_line = [&](const R& t) {
            const CR y = f(CR(R(v.real()) + t * R(d.real()), R(v.imag()) + t * R(d.imag())));
            return is_imaginary ? y.imag() : y.real();
          };
          return double(duet_test::central_difference(along_line, R(0), k, R(1000 * std::abs(v))));
        };
        exact[std::size_t(k)] = C(part(false), part(true));
      }
      for (std::size_t k = 1; k <= 3; ++k) {
        CAPTURE(name);
        CAPTURE(v);
        CAPTURE(k);
        const double size = std::abs(v) < 1e-3 ? 0 : std::abs(exact[0]) + std::abs(exact[1]);
        const double scale = std::abs(exact[k]) + size * std::pow(std::abs(d / v), k);
        CHECK(std::abs(by_series[k] - exact[k]) <= 64 * epsilon * scale + 1e-30);
        CHECK(std::abs(by_nesting[k] - exact[k]) <= 64 * epsilon * scale + 1e-30);
      }
    }
  });
}

TEST_CASE("std::complex of dual: values equal those of complex<double>, also at zeros, infinities "
          "and cuts") {
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double parts[] = {0.0, -0.0, 0.5, -0.5, 1, -1, 2, -3, 1e-300, 1e300, inf, -inf, nan};
  for_each_function([&](const std::string& name, const auto& f) {
    for (const double x : parts) {
      for (const double y : parts) {
        CAPTURE(name);
        CAPTURE(x);
        CAPTURE(y);
        CHECK(identical(value(f(moving(C(x, y), C(1, 2)))), f(C(x, y))));
      }
    }
  });
  for (const double x : parts) {
    for (const double y : parts) {
      CHECK(identical(value(proj(moving(C(x, y), C(1, 2)))), std::proj(C(x, y))));
      CHECK(identical(arg(moving(C(x, y), C(1, 2))).value(), std::arg(C(x, y))));
      CHECK(identical(abs(moving(C(x, y), C(1, 2))).value(), std::abs(C(x, y))));
    }
  }
}

TEST_CASE(
    "std::complex of dual: on cuts the derivative is that of the side given by the sign of zero") {
  for_each_function([&](const std::string& name, const auto& f) {
    for (const C v : {C(2, 0.0), C(2, -0.0), C(-2, 0.0), C(-2, -0.0), C(0.0, 2), C(-0.0, 2),
                      C(0.0, -2), C(-0.0, -2), C(0.5, -0.0), C(-0.25, 0.0)}) {
      CAPTURE(name);
      CAPTURE(v);
      const double offset = 1e-9;
      const C near_cut(v.real() == 0 ? std::copysign(offset, v.real()) : v.real(),
                       v.imag() == 0 ? std::copysign(offset, v.imag()) : v.imag());
      for (const C d : {C(1, 0), C(0, 1)}) {
        const auto on_cut = derivatives_of(f(along(v, d, series::variable(0))));
        const auto beside_cut = derivatives_of(f(along(near_cut, d, series::variable(0))));
        for (std::size_t k = 1; k <= 3; ++k) {
          CHECK(std::abs(on_cut[k] - beside_cut[k]) <= 1e-5 * (1 + std::abs(beside_cut[k])));
        }
      }
    }
  });
}

TEST_CASE("std::complex of dual: powers of every pair of types, qualified or not") {
  using std::pow;
  const C z(1, 2), w(0.5, -1);
  const Z a = moving(z, C(1, -1));
  const Z b = moving(w, C(2, 1));
  const D s(1.5, 3);
  const auto check = [](const Z& y, const C& exact, const C& slope) {
    CHECK(identical(value(y), exact));
    CHECK(near(velocity(y), slope, std::abs(slope) + std::abs(exact)));
  };
  const C dz(1, -1), dw(2, 1);
  const auto by_base = [&](const C& p) { return p * std::pow(z, p - 1.0) * dz; };
  check(std::pow(a, b), std::pow(z, w), by_base(w) + std::pow(z, w) * std::log(z) * dw);
  check(pow(a, b), std::pow(z, w), by_base(w) + std::pow(z, w) * std::log(z) * dw);
  check(std::pow(a, s), std::pow(z, 1.5), by_base(1.5) + std::pow(z, 1.5) * std::log(z) * 3.0);
  check(std::pow(s, b), std::pow(1.5, w),
        w * std::pow(1.5, w - 1.0) * 3.0 + std::pow(1.5, w) * std::log(1.5) * dw);
  check(std::pow(a, 2), std::pow(z, 2), 2.0 * z * dz);
  check(pow(a, -2L), std::pow(z, -2L), by_base(-2));
  check(std::pow(a, 0.5F), std::pow(z, 0.5F), by_base(0.5));
  check(pow(a, 2.5), std::pow(z, 2.5), by_base(2.5));
  check(std::pow(a, w), std::pow(z, w), by_base(w));
  check(std::pow(z, b), std::pow(z, w), std::pow(z, w) * std::log(z) * dw);
  check(std::pow(2.0, b), std::pow(2.0, w), std::pow(2.0, w) * std::log(2) * dw);
  check(pow(3, b), std::pow(3, w), std::pow(3, w) * std::log(3) * dw);
  check(std::pow(a, D(2)), std::pow(z, 2.0), 2.0 * z * dz);
}

TEST_CASE("std::complex of dual: powers at 0 and their singularities") {
  const Z zero = moving(C(0, 0), C(0, 1));
  CHECK(velocity(std::pow(zero, D(1))) == C(0, 1));
  CHECK(velocity(std::pow(zero, D(2))) == C(0, 0));
  CHECK(velocity(std::pow(zero, 1)) == C(0, 1));
  CHECK(velocity(std::pow(zero, Z(2))) == C(0, 0));
  CHECK(velocity(std::pow(zero, 0.0)) == C(0, 0));
  const std::complex<series> z(0, series::variable(0));
  CHECK(derivatives_of(std::pow(z, series(2)))[2] == C(-2, 0));
  CHECK(derivatives_of(std::pow(z, 3))[3] == C(0, -6));
  CHECK(derivatives_of(std::pow(z, std::complex<series>(3)))[3] == C(0, -6));
  CHECK(is_infinite(velocity(std::sqrt(zero))));
  CHECK(is_infinite(velocity(std::log(zero))));
  CHECK(is_infinite(velocity(std::pow(zero, D(0.5)))));
  CHECK(is_infinite(velocity(std::pow(zero, -1))));
  CHECK(is_infinite(velocity(std::asin(moving(C(1, 0), C(1, 0))))));
  CHECK(is_infinite(velocity(std::atan(moving(C(0, 1), C(1, 0))))));
  CHECK(is_infinite(derivatives_of(std::pow(z, 1.5))[2]));
  // Constants do not know.
  const Z constant(0);
  for (const Z& y :
       {std::sqrt(constant), std::log(constant), std::pow(constant, D(0.5)), std::pow(constant, -1),
        std::asin(Z(1)), std::acosh(Z(-1)), std::pow(constant, D(0.5, 1))}) {
    CHECK(velocity(y) == C(0, 0));
  }
}

TEST_CASE("std::complex of dual: quotients of large or small numbers, operators of two types") {
  const Z large = moving(C(3e200, 4e200), C(1e200, 0));
  CHECK(value(large / large) == C(1, 0));
  CHECK(near(velocity(1 / large), -1e200 / C(3e200, 4e200) / C(3e200, 4e200), 1e-201));
  Z ratio = moving(C(3e-200, 4e-200), C(1e-200, 0));
  ratio /= moving(C(3e-200, 4e-200), C(0, 0));
  CHECK(near(velocity(ratio), 1.0 / C(3, 4), 0.2));
  const C z(1, 2), dz(1, -1), c(0.5, 3);
  const Z a = moving(z, dz);
  CHECK(value(2.5 * a + 1 - a / 2 - c) == 2.5 * z + 1.0 - z / 2.0 - c);
  CHECK(velocity(2.5 * a + 1 - a / 2 - c) == 2.5 * dz - dz / 2.0);
  CHECK(velocity(a * c) == dz * c);
  CHECK(near(velocity(c / a), -c / (z * z) * dz, 1));
  CHECK(a == C(1, 2));
  CHECK(C(1, 2) == a);
  CHECK(a != 1);
  CHECK(Z(3) == 3);
  CHECK(std::signbit((moving(C(1, -0.0), dz) + 1).imag().value()));
  using outer = dual<D, 1, outermost_tag>;
  const auto both = std::complex<outer>(outer::variable(2), 0) * a; // d/dt d/du of ua
  CHECK(both.real().epsilon().epsilon() == 1);
  CHECK(both.imag().epsilon().epsilon() == -1);
  const Z on_circle = std::polar(2, D::variable(0.5));
  CHECK(near(velocity(on_circle), 2.0 * C(-std::sin(0.5), std::cos(0.5)), 2));
}

TEST_CASE("std::complex of dual: square roots by Eigen, also on the axes") {
  for (const C v : {C(0, 2), C(0, -2), C(2, 0), C(1, 1)}) {
    CAPTURE(v);
    for (const C d : {C(1, 0), C(0, 1)}) {
      const Eigen::Array<Z, 1, 1> z(moving(v, d));
      const Eigen::Array<Z, 1, 1> root = z.sqrt();
      const Eigen::Array<Z, 1, 1> inverse = z.rsqrt();
      CHECK(near(velocity(root(0)), 0.5 / std::sqrt(v) * d, 1));
      CHECK(near(velocity(inverse(0)), -0.5 / (v * std::sqrt(v)) * d, 1));
    }
  }
}

TEST_CASE_TEMPLATE(
    "std::complex of dual: functions work in every built-in precision and in batches", T, float,
    long double, duet::batch<double, 2>) {
  using number = dual<T>;
  using real = duet::lane_type_t<T>;
  const std::complex<number> z(number::variable(T(real(0.5))), number(T(real(1.5))));
  const auto y = std::pow(std::sqrt(std::asin(z)), 2) / std::pow(z, number(T(real(0.5))));
  const auto first = duet::lane(y, 0);
  // d/dz asin(z) z^−½
  const std::complex<real> v(real(0.5), real(1.5));
  const std::complex<real> one(1);
  const std::complex<real> exact =
      (one / (std::sqrt(one - v) * std::sqrt(one + v)) - std::asin(v) / (v * real(2))) /
      std::sqrt(v);
  const std::complex<real> slope(first.real().epsilon(), first.imag().epsilon());
  CHECK(std::abs(slope - exact) <= 16 * std::numeric_limits<real>::epsilon() * std::abs(exact));
}

} // namespace
} // namespace test_dual_complex_of_dual
