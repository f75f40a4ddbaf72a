// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
#include "support/test.hpp"

#include <duet/dual/stumpff.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>

// Rates of exp(x(t)) by the exponential's Jacobian, against Taylor numbers of 50 digits through exp
// itself.

namespace test_quaternion_exponential_rates {
namespace {

using duet::quaternion, duet::taylor, duet::vector3, duet_test::real_50;

constexpr int order = 5;

/// A curve of half-angle vectors that starts at `size` times a unit vector.
template <class R>
vector3<taylor<R, order>> path(double size) {
  const double c[3][order] = {
      {0.7, -0.2, 0.9, 0.4, -0.3}, {0.1, 1.2, -0.9, 0.1, 0.8}, {-1.7, 0.2, 0.3, 0.7, 0.2}};
  const double unit[3] = {2.0 / 7, -6.0 / 7, 3.0 / 7};
  vector3<taylor<R, order>> x;
  for (int i = 0; i < 3; ++i) {
    x[i].set_coefficient(0, R(unit[i]) * R(size));
    for (int k = 0; k < order; ++k) {
      x[i].set_coefficient(k + 1, R(c[i][k]));
    }
  }
  return x;
}

template <class R>
std::array<vector3<R>, order> closed_form(double size) {
  const auto x = path<R>(size);
  vector3<R> start;
  std::array<vector3<R>, order> rates;
  for (int i = 0; i < 3; ++i) {
    start[i] = x[i].coefficient(0);
    for (std::size_t k = 0; k < order; ++k) {
      rates[k][i] = x[i].coefficient(int(k) + 1);
    }
  }
  const duet::detail::jacobian_coefficients<order, R> jacobian(start.squaredNorm());
  return duet::detail::half_body_rates(jacobian, start, rates);
}

/// vec(Q* Q′) of the Taylor series of Q.
std::array<vector3<real_50>, order> reference(double size) {
  using series = taylor<real_50, order>;
  const quaternion<series> q = duet::exp(path<real_50>(size));
  const auto rate = [](const series& x) {
    series result;
    for (int k = 0; k < order; ++k) {
      result.set_coefficient(k, x.coefficient(k + 1) * (k + 1));
    }
    return result;
  };
  const auto w = conj(q) * quaternion<series>(rate(q.w()), rate(q.x()), rate(q.y()), rate(q.z()));
  std::array<vector3<real_50>, order> result;
  for (std::size_t k = 0; k < order; ++k) {
    result[k] = {w.x().coefficient(int(k)), w.y().coefficient(int(k)), w.z().coefficient(int(k))};
  }
  return result;
}

TEST_CASE("half_body_rates: rates of exp(x(t)) agree with 50 digits up to beyond a full turn") {
  for (const double size :
       {0.0, 1e-300, 1e-9, 1e-3, 0.5, 0.9999, 1.0001, 1.5, 2.0, 3.0, 3.141592653589793, 3.2, 6.0}) {
    CAPTURE(size);
    const auto exact = reference(size);
    const auto computed = closed_form<double>(size);
    const auto precise = closed_form<real_50>(size);
    for (std::size_t k = 0; k < order; ++k) {
      CAPTURE(k);
      double error = 0;
      double precise_error = 0;
      for (int i = 0; i < 3; ++i) {
        error = std::max(error, std::abs(double(computed[k][i] - exact[k][i])));
        precise_error = std::max(precise_error, std::abs(double(precise[k][i] - exact[k][i])));
      }
      CHECK(error < 1e-14 * (1 + std::abs(size)) * std::sqrt(double(k + 1)));
      CHECK(precise_error < 1e-47);
    }
  }
}

TEST_CASE("stumpff_sequence: agrees with single Stumpff functions") {
  for (const double s : {0.0, 1e-300, 1e-8, 0.3, 1.0, 3.999, 4.001, 9.8, 39.4, 45.0}) {
    CAPTURE(s);
    const auto c = duet::stumpff_sequence<9>(s);
    const auto exact = duet::stumpff_sequence<9>(real_50(s));
    CHECK(std::abs(double(exact[0] - cos(sqrt(real_50(s))))) < 1e-48);
    CHECK(std::abs(double(exact[7] - duet::stumpff<7>(real_50(s)))) < 1e-48);
    for (std::size_t n = 0; n < c.size(); ++n) {
      CAPTURE(n);
      const double scale =
          s <= 4 ? 1 / std::tgamma(double(n) + 1)
                 : std::max(std::pow(s, -0.5 * double(n)), std::abs(double(exact[n])));
      CHECK(std::abs(c[n] - double(exact[n])) < 1e-15 * scale);
    }
  }
}

} // namespace
} // namespace test_quaternion_exponential_rates
