// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "quaternion/truth.hpp"
#include "support/random.hpp"
#include "support/shared_tag.hpp"
#include "support/test.hpp"

#include <duet/derivative/jacobian.hpp>
#include <duet/quaternion/exponential.hpp>

// N4: exp(w + v) = e^w (cos |v| + v sin |v|/|v|), against 100 digits.

namespace test_quaternion_exponential {
namespace {

using duet::quaternion, duet_test::random_source, duet_test::worst_error;
namespace reference = duet_test::reference;

/// Vector parts of every size, and on both sides of the switches of the algorithm: s = |v|² = 1 and
/// 9.8696, for s and, in derivatives, for 4s.
std::vector<double> lengths() {
  std::vector<double> result{0, 1e-300, 1e-160, 1e-30, 1e-8, 1e-4, 0.01, 0.3};
  using std::numbers::pi;
  const double switches[] = {1, std::sqrt(9.8696), 0.5, std::sqrt(9.8696) / 2};
  for (const double middle :
       {switches[0], switches[1], switches[2], switches[3], pi / 2, pi, 2 * pi}) {
    for (const double distance : {0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-8, -1e-8, 1e-4, -1e-4}) {
      result.push_back(middle * (1 + distance));
    }
  }
  return result;
}

std::vector<quaternion<double>> inputs() {
  random_source random(1);
  std::vector<quaternion<double>> result;
  for (const double length : lengths()) {
    const auto d = random.direction<3>();
    result.push_back({0, length * d[0], length * d[1], length * d[2]});
    result.push_back({0, 0, length, 0});
  }
  for (int i = 0; i < 60; ++i) {
    const auto d = random.direction<3>();
    const double length = random.uniform(0, 7);
    result.push_back(
        {i % 2 == 0 ? 0 : random.uniform(-300, 300), length * d[0], length * d[1], length * d[2]});
  }
  return result;
}

TEST_CASE("N4: exp and its first derivative agree with 100 digits") {
  random_source random(2);
  worst_error value("exp");
  worst_error slope("exp, derivative by AD");
  for (const auto& q : inputs()) {
    const reference::four x = reference::wide(q);
    const reference::four exact = reference::exp(x);
    value.add(reference::ulps(exp(q), exact,
                              reference::length(exact) +
                                  reference::change_of_value(reference::exp, x, 1)),
              q);

    const auto d = random.direction<4>();
    const quaternion<double> q_dot(d[0], d[1], d[2], d[3]);
    const reference::four dx = reference::wide(q_dot);
    const reference::four exact_slope = reference::difference(
        [&](const reference::real& t) { return reference::exp(reference::sum(x, dx, t)); }, 1);
    const reference::real scale =
        reference::length(exact_slope) + reference::change_of_derivative(reference::exp, x, dx, 1);
    const auto automatic = duet::derivative<duet_test::shared_tag>(
        [&](const auto& t) { return exp(q + t * q_dot); }, 0.0);
    slope.add(reference::ulps(automatic.derivative, exact_slope, scale), q, q_dot);
  }
  CHECK_MESSAGE(value <= 16, value);
  CHECK_MESSAGE(slope <= 16, slope);
}

TEST_CASE("N4: exp of a vector equals exp of the pure quaternion") {
  const duet::vector3<double> v(0.3, -1.2, 0.5);
  CHECK(duet::exp(v) == exp(quaternion<double>(0, v)));
  CHECK(norm(duet::exp(v)) == doctest::Approx(1).epsilon(1e-15));
}

} // namespace
} // namespace test_quaternion_exponential
