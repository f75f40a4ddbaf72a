// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
#include "support/random.hpp"
#include "support/shared_tag.hpp"
#include "support/test.hpp"
#include "support/ulp.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/quaternion/euler.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>

// P5: angular velocity from the rates of yaw ψ, pitch θ and roll φ, R = Rz(ψ) Ry(θ) Rx(φ).

namespace test_quaternion_euler_rate {
namespace {

using duet_test::random_source, duet_test::real_50, duet_test::worst_error;

/// The matrix by hand, columns φ′, θ′, ψ′ as in the paper.
template <class T>
duet::matrix3<T> by_hand(const T& psi, const T& theta) {
  using std::cos, std::sin;
  duet::matrix3<T> a;
  a << cos(psi) * cos(theta), -sin(psi), T(0), //
      sin(psi) * cos(theta), cos(psi), T(0),   //
      -sin(theta), T(0), T(1);
  return a;
}

/// The library's columns are in the order of the letters z, y, x.
template <class M>
M in_paper_order(const M& letters) {
  M m;
  m << letters.col(2), letters.col(1), letters.col(0);
  return m;
}

/// ω of angles and their rates, by AD of the quaternion alone.
duet::vector3<double> automatic(double psi, double theta, double phi, double psi_rate,
                                double theta_rate, double phi_rate) {
  const auto [q, q_dot] = duet::derivative<duet_test::shared_tag>(
      [=](const auto& t) {
        return duet::from_euler<duet::zyx>(psi + psi_rate * t, theta + theta_rate * t,
                                           phi + phi_rate * t);
      },
      0.0);
  return angular_velocity(q, q_dot, duet::frame::spatial);
}

TEST_CASE("P5: euler_rate_matrix agrees with the hand-written matrix, AD and 50 digits") {
  random_source random(91);
  worst_error library("euler_rate_matrix<zyx>");
  const double quarter = 1.5707963267948966; // its cosine is 6e-17
  for (int i = 0; i < 100; ++i) {
    const double psi = i % 10 == 0 ? quarter : i % 10 == 1 ? 1e-20 : random.uniform(-3, 3);
    const double theta = i % 7 == 0 ? -quarter : i % 7 == 1 ? 1e-9 : random.uniform(-1.5, 1.5);
    const double phi = random.uniform(-3, 3);
    const duet::vector3<double> rates(random.normal(), random.normal(), random.normal());
    const duet::matrix3<double> a = in_paper_order(duet::euler_rate_matrix<duet::zyx>(psi, theta));
    CHECK((a - by_hand(psi, theta)).norm() <= 1e-15);
    CHECK((a * rates - automatic(psi, theta, phi, rates[2], rates[1], rates[0])).norm() <= 1e-14);
    const auto exact = by_hand(real_50(psi), real_50(theta));
    for (int k = 0; k < 9; ++k) {
      library.add(duet_test::ulps(a(k), exact(k), exact(k)), k, psi,
                  theta); // relative to the element itself
    }
  }
  CHECK_MESSAGE(library <= 4, library);
}

TEST_CASE("P5: the printed matrix has -sin psi at (3, 1) and a wrong angular velocity") {
  random_source random(92);
  for (int i = 0; i < 100; ++i) {
    const double psi = random.uniform(-3, 3), theta = random.uniform(-1.5, 1.5);
    const duet::matrix3<double> printed = duet::printed_euler_rate_matrix(psi, theta);
    const duet::matrix3<double> difference = printed - by_hand(psi, theta);
    CHECK(difference(2, 0) == std::sin(theta) - std::sin(psi));
    CHECK(difference.cwiseAbs().sum() == std::abs(difference(2, 0)));
  }
  // If yaw and pitch are equal, the error of the print has no effect.
  CHECK(duet::printed_euler_rate_matrix(0.4, 0.4) == by_hand(0.4, 0.4));

  const double psi = 0.1, theta = -0.7, phi = 0.3;
  const duet::vector3<double> rates(1, 2, 3); // φ′, θ′, ψ′
  const auto reference = automatic(psi, theta, phi, rates[2], rates[1], rates[0]);
  const duet::vector3<double> printed = duet::printed_euler_rate_matrix(psi, theta) * rates;
  CHECK((printed - reference).norm() ==
        doctest::Approx(std::abs(std::sin(theta) - std::sin(psi)) * rates[0]));
}

TEST_CASE("P5: the derivative of delta, A'{...} + A{...}'', agrees with AD") {
  const auto angles = [](const auto& u) {
    using std::cos, std::sin;
    using T = std::decay_t<decltype(u)>;
    return duet::vector3<T>(T(0.3 + sin(u)), T(0.2 * u * u), T(cos(2 * u))); // φ, θ, ψ
  };
  const double u = 0.7;
  const auto y = duet::derivatives<2>(angles, u);
  const auto [a, a_dot] = duet::derivative<duet_test::shared_tag>(
      [&](const auto& t) {
        const auto v = angles(t);
        return in_paper_order(duet::euler_rate_matrix<duet::zyx>(v[2], v[1]));
      },
      u);
  const duet::vector3<double> by_formula = a_dot * y[1] + a * y[2];
  const auto q = duet::derivatives<2>(
      [&](const auto& t) {
        const auto v = angles(t);
        return duet::from_euler<duet::zyx>(v[2], v[1], v[0]);
      },
      u);
  const auto by_quaternion = angular_velocity(q[0], q[2], duet::frame::spatial);
  CHECK((a * y[1] - angular_velocity(q[0], q[1], duet::frame::spatial)).norm() <= 1e-14);
  CHECK((by_formula - by_quaternion).norm() <= 1e-14);
}

} // namespace
} // namespace test_quaternion_euler_rate
