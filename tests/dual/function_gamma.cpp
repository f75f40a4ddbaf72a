// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
#include "support/test.hpp"
#include "support/ulp.hpp"

#include <duet/dual/math.hpp>
#include <duet/dual/taylor.hpp>

#include <boost/math/special_functions/bernoulli.hpp>

namespace test_dual_function_gamma {
namespace {

using duet_test::real_100, duet_test::scale, duet_test::ulps, duet_test::worst_error;

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
                         1.0, 2.0, 9.0, 9.5, 33.0, -33.25, -1000.375, 1e-8, 30.0, 170.0}) {
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
    CHECK(l.value() == std::lgamma(x));
    CHECK(g.value() == std::tgamma(x));
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

} // namespace
} // namespace test_dual_function_gamma
