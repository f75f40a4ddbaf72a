// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "quaternion/hard_inputs.hpp"
#include "quaternion/truth.hpp"
#include "support/random.hpp"
#include "support/shared_tag.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/quaternion/exponential.hpp>

// N5: q^ρ = |q|^ρ (cos ρφ + û sin ρφ), against 100 digits.

namespace test_quaternion_power {

using duet::quaternion, duet_test::random_source, duet_test::worst_error;
namespace reference = duet_test::reference;

TEST_CASE("N5: pow and its derivatives by base and exponent agree with 100 digits") {
  random_source random(11);
  worst_error value("pow");
  worst_error slope("pow, derivative by AD");
  const double exponents[] = {0, 1e-8, 0.25, 0.5, 1, -1, 2, -0.7, 1.9};
  int i = 0;
  for (const auto& q : duet_test::hard_quaternions()) {
    const double rho = exponents[++i % 9];
    const reference::four x = reference::wide(q);
    // An integer power is smooth near a full turn, as long as the exponent is constant.
    const bool is_smooth = rho == std::round(rho) && duet_test::smooth_length(x) < 1e-9 * norm(q);
    const reference::real smooth = is_smooth ? reference::length(x) : duet_test::smooth_length(x);
    const auto power = [&](const reference::four& y) { return reference::pow(y, rho); };
    const reference::four exact = power(x);
    const reference::four by_rho = reference::difference(
        [&](const reference::real& t) { return reference::pow(x, reference::real(rho + t)); }, 1);
    value.add(
        reference::ulps(pow(q, rho), exact,
                        reference::length(exact) + reference::change_of_value(power, x, smooth)),
        q, rho);

    // Both change: q by q_dot, of the size of q, and rho by rho_dot.
    const double size = norm(q);
    const auto d = random.direction<4>();
    const quaternion<double> q_dot(size * d[0], size * d[1], size * d[2], size * d[3]);
    const double rho_dot = is_smooth ? 0 : random.uniform(-1, 1);
    const reference::four dx = reference::wide(q_dot);
    const reference::real reach = smooth / reference::length(x);
    const reference::four exact_slope = reference::difference(
        [&](const reference::real& t) {
          return reference::pow(reference::sum(x, dx, t), reference::real(rho + rho_dot * t));
        },
        1, reach);
    if (reference::length(exact_slope) > 1e300) {
      continue; // near a full turn the derivative may be too large
    }
    const reference::real scale =
        reference::length(exact_slope) + reference::length(by_rho) +
        reference::change_of_derivative(power, x, dx, smooth) +
        std::abs(rho_dot) * reference::length(exact) *
            reference::change_of_value(reference::log, x, duet_test::smooth_length(x));
    const auto automatic = duet::derivative<duet_test::shared_tag>(
        [&](const auto& t) { return pow(q + t * q_dot, rho + t * rho_dot); }, 0.0);
    slope.add(reference::ulps(automatic.derivative, exact_slope, scale), q, rho, q_dot, rho_dot);
  }
  CHECK_MESSAGE(value <= 16, value);
  CHECK_MESSAGE(slope <= 16, slope);
}

// By acos, a rotation of 1e-6 would be wrong in its fourth digit.
TEST_CASE("pow and slerp: the angle of small rotations has a small relative error") {
  for (const double half_angle : {5e-7, 5e-9, 1e-12, 1e-100, 1e-300}) {
    const quaternion<double> q(std::cos(half_angle), 0, std::sin(half_angle), 0);
    for (const double rho : {0.25, 0.5, 0.9, 3.0}) {
      CHECK(std::abs(std::asin(pow(q, rho).y()) / (rho * half_angle) - 1) <= 1e-15);
      CHECK(std::abs(std::asin(slerp(quaternion<double>(1), q, rho).y()) / (rho * half_angle) -
                     1) <= 1e-15);
    }
  }
}

// q² is a polynomial and so smooth at −1, although log is not.
TEST_CASE("pow: integer powers are smooth at a full turn") {
  for (const double length : {0.0, 1e-300, 1e-31, 1e-8, 1e-4, 0.01, 0.12, 0.13}) {
    const quaternion<double> q(-1, 0, length, 0);
    const quaternion<double> q_dot(0.3, -0.4, 0.5, 0.6);
    for (const int rho : {2, 3, -1, 0}) {
      const auto repeated = [&](const auto& base) {
        using quaternion_t = std::decay_t<decltype(base)>;
        switch (rho) {
        case 2:
          return base * base;
        case 3:
          return base * base * base;
        case -1:
          return inverse(base);
        default:
          return quaternion_t(base.w() * 0 + 1);
        }
      };
      const auto [y, dy] = duet::derivative<duet_test::shared_tag>(
          [&](const auto& t) { return pow(q + t * q_dot, rho); }, 0.0);
      const auto [z, dz] = duet::derivative<duet_test::shared_tag>(
          [&](const auto& t) { return repeated(q + t * q_dot); }, 0.0);
      CHECK(norm(y - z) <= 1e-15);
      CHECK(norm(dy - dz) <= 5e-15);
    }
  }
}

TEST_CASE("pow: a power of -|q| rotates about the axis x") {
  const auto root = pow(quaternion<double>(-4, 0, 0, 0), 0.5);
  CHECK(norm(root - quaternion<double>(0, 2, 0, 0)) <= 1e-15);
}

TEST_CASE("N5: higher derivatives of pow are accurate near integer exponents, where they vanish") {
  random_source random(14);
  worst_error worst("pow, third and fourth derivative");
  for (int i = 0; i < 60; ++i) {
    const auto a = random.direction<4>(), b = random.direction<4>();
    const quaternion<double> q(std::abs(a[0]), a[1], a[2], a[3]), rate(b[0], b[1], b[2], b[3]);
    const double rho = 1 + i % 3 + random.uniform(-0.04, 0.04);
    const reference::four x = reference::wide(q), dx = reference::wide(rate);
    const auto derivative = [&](int k, const reference::real& exponent) {
      return reference::difference(
          [&](const reference::real& t) {
            return reference::pow(reference::sum(x, dx, t), exponent);
          },
          k, reference::real(0.1));
    };
    const auto series =
        pow(q + duet::taylor<double, 4>::variable(0) * rate, duet::taylor<double, 4>(rho));
    for (int k = 3; k <= 4; ++k) {
      const auto exact = derivative(k, reference::real(rho));
      const auto nearby = derivative(k, reference::real(rho * (1 + 1e-8)));
      const reference::real scale =
          reference::length(exact) + 1e8 * reference::length(reference::sum(nearby, exact, -1));
      worst.add(
          reference::ulps(quaternion<double>(series.w().derivative(k), series.x().derivative(k),
                                             series.y().derivative(k), series.z().derivative(k)),
                          exact, scale),
          k, q, rate, rho);
    }
  }
  CHECK_MESSAGE(worst <= 32, worst);
}

} // namespace test_quaternion_power
