// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
#include "support/random.hpp"
#include "support/test.hpp"
#include "support/ulp.hpp"

#include <duet/dual/math.hpp>

#include <boost/math/special_functions/bernoulli.hpp>
#include <boost/math/special_functions/digamma.hpp>

namespace test_dual_function_gamma {
namespace {

using duet::dual, duet_test::central_difference, duet_test::real_100, duet_test::scale,
    duet_test::ulps, duet_test::worst_error;

TEST_CASE("gamma functions: derivatives agree with series") {
  worst_error worst_tgamma("tgamma");
  worst_error worst_lgamma("lgamma");
  duet_test::random_source random(3);
  std::vector<double> inputs{1e-300, 1e-8,  0.5,   1.0,  1.4616321449683623, 2.0,  8.0,
                             30.0,   170.0, -1e-8, -0.4, -1 + 1e-10,         -1.5, -2.5,
                             -9.75,  -20.25};
  for (int i = 0; i < 40; ++i) {
    inputs.push_back(random.uniform(-6, 12));
  }
  for (const double x : inputs) {
    const auto psi = [](const real_100& t) -> real_100 { return boost::math::digamma(t); };
    const real_100 wide(x);
    const real_100 slope = psi(wide);
    const real_100 near = abs(wide - round(wide));
    const real_100 length = x > 1 ? real_100(1) : real_100(near > 1e-40 ? near : abs(wide));
    const real_100 curvature = central_difference(psi, wide, 1, length);
    const auto y = lgamma(dual<double>::variable(x));
    CHECK(y.value() == std::lgamma(x));
    worst_lgamma.add(ulps(y.epsilon(), slope, scale(slope, curvature, wide)), x);

    const real_100 gamma = boost::math::tgamma(wide);
    const auto z = tgamma(dual<double>::variable(x));
    const real_100 exact = gamma * slope;
    const real_100 second = gamma * (slope * slope + curvature);
    CHECK(z.value() == std::tgamma(x));
    worst_tgamma.add(ulps(z.epsilon(), exact, scale(exact, second, wide)), x);
  }
  CHECK_MESSAGE(worst_lgamma <= 16, worst_lgamma);
  CHECK_MESSAGE(worst_tgamma <= 16, worst_tgamma);
}

/// ψ^(n)(x) for n = 0…6: (−1)^(n+1) n! Σ 1/(x + k)^(n+1), the terms from 60 on by Euler's and
/// Maclaurin's formula. Unlike the rules it uses no reflection.
std::array<real_100, 7> polygammas(const real_100& x) {
  std::array<real_100, 7> result{};
  real_100 z = x;
  for (; z < 60; z += 1) {
    real_100 term = 1 / z;
    for (std::size_t n = 0; n < 7; ++n) {
      result[n] -= term;
      term *= -real_100(n + 1) / z;
    }
  }
  result[0] += log(z) - 1 / (2 * z);
  real_100 power = 1 / z;
  for (std::size_t n = 1; n < 7; ++n) { // power = (−1)^(n+1) (n−1)!/zⁿ
    result[n] += power * (1 + real_100(n) / (2 * z));
    power *= -real_100(n) / z;
  }
  for (int j = 1; j <= 30; ++j) {
    real_100 term = -boost::math::bernoulli_b2n<real_100>(j) / (2 * j * pow(z, 2 * j));
    for (std::size_t n = 0; n < 7; ++n) {
      result[n] += term;
      term *= -real_100(2 * j + int(n)) / z;
    }
  }
  return result;
}

/// Γ^(n)(x), n = 0…6, by Γ′ = Γψ.
std::array<real_100, 7> gammas(const real_100& x, const std::array<real_100, 7>& psi) {
  std::array<real_100, 7> result{boost::math::tgamma(x)};
  for (std::size_t n = 0; n + 1 < 7; ++n) {
    real_100 binomial = 1;
    for (std::size_t k = 0; k <= n; ++k) {
      result[n + 1] += binomial * result[k] * psi[n - k];
      binomial = binomial * (n - k) / (k + 1);
    }
  }
  return result;
}

TEST_CASE_TEMPLATE("gamma functions: derivatives to the fifth in every built-in precision", T,
                   float, double, long double) {
  worst_error worst_tgamma("tgamma");
  worst_error worst_lgamma("lgamma");
  std::vector<T> inputs;
  const T epsilon = std::numeric_limits<T>::epsilon();
  for (int n = 0; n <= 20; ++n) {
    const T half = -T(n) - T(0.5); // where the cotangent of ψ's reflection is 0
    for (const T x : {half, half * (1 - epsilon), half * (1 + 4 * epsilon), half * (1 - 1e-3F)}) {
      inputs.push_back(x);
    }
    for (const T offset : {T(0.01), T(1e-4), T(64 * epsilon)}) { // the poles
      inputs.push_back(-T(n) + offset * T(n + 1));
      inputs.push_back(-T(n) - offset * T(n + 1));
    }
  }
  // Zeros of lgamma and of ψ, the ends of the cases, far out.
  for (const double x : {-2.4570247382208006, -2.7476826467274127, -3.9552942848585979,
                         1.4616321449683623, -0.5040830082644554, -1.5734984731623904, 0.5, 0.49,
                         1.0, 2.0, 9.0, 9.5, 33.0, -33.25, -1000.375}) {
    inputs.push_back(T(x));
  }
  using series = duet::taylor<T, 5>;
  for (const T x : inputs) {
    const real_100 wide(x);
    const auto psi = polygammas(wide);
    const auto gamma = gammas(wide, psi);
    const series l = lgamma(series::variable(x));
    const series g = tgamma(series::variable(x));
    const real_100 largest((std::numeric_limits<T>::max)());
    for (std::size_t k = 1; k <= 5; ++k) {
      const std::size_t i = k - 1;
      if (abs(psi[i]) < largest) {
        worst_lgamma.add(ulps(l.derivative(int(k)), psi[i], scale(psi[i], psi[i + 1], wide)), k, x);
      }
      if (k < 6 && x > -20 && abs(gamma[k]) < largest) {
        worst_tgamma.add(ulps(g.derivative(int(k)), gamma[k], scale(gamma[k], gamma[k + 1], wide)),
                         k, x);
      }
    }
  }
  CHECK_MESSAGE(worst_lgamma <= 16, worst_lgamma);
  CHECK_MESSAGE(worst_tgamma <= 16, worst_tgamma);
}

TEST_CASE("gamma functions: derivatives at -3/2 agree with a table") {
  const auto g = tgamma(duet::taylor<double, 5>::variable(-1.5));
  CHECK(g.derivative(4) == doctest::Approx(1148.336).epsilon(5e-6));
  CHECK(g.derivative(5) == doctest::Approx(3831.21).epsilon(5e-6));
}

} // namespace
} // namespace test_dual_function_gamma
