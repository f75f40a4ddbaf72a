// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "quaternion/truth.hpp"
#include "support/random.hpp"
#include "support/shared_tag.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>

// N9: A(τ) = A₁ (A₁* A₂)^τ, against 100 digits.

namespace test_quaternion_slerp {
namespace {

using duet::quaternion, duet_test::random_source, duet_test::worst_error;
namespace reference = duet_test::reference;

quaternion<double> random_rotation(random_source& random) {
  const auto d = random.direction<4>();
  return normalized(quaternion<double>(d[0], d[1], d[2], d[3]));
}

/// Pairs at every angle up to a half turn (half angles up to π/2), with both signs of b.
std::vector<std::pair<quaternion<double>, quaternion<double>>> pairs() {
  random_source random(21);
  std::vector<std::pair<quaternion<double>, quaternion<double>>> result;
  using std::numbers::pi;
  for (const double half_angle : {0.0, 1e-300, 1e-160, 1e-15, 1e-8, 5e-7, 1e-4, 0.3, 1.0, pi / 4,
                                  1.5, pi / 2 - 1e-4, pi / 2 - 1e-8}) {
    for (int i = 0; i < 8; ++i) {
      const auto a = i == 0 ? quaternion<double>(1) : random_rotation(random);
      const auto d = random.direction<3>();
      const auto b = a * duet::exp(duet::vector3<double>(half_angle * d[0], half_angle * d[1],
                                                         half_angle * d[2]));
      result.emplace_back(a, i % 2 == 0 ? b : -b);
    }
  }
  return result;
}

TEST_CASE("N9: slerp and its derivative with respect to the parameter agree with 100 digits") {
  random_source random(22);
  worst_error value("slerp");
  worst_error slope("slerp, derivative by AD");
  for (const auto& [a, b] : pairs()) {
    const double tau = random.uniform(0, 1);
    const reference::four wide_a = reference::wide(a);
    const reference::four near_b = reference::wide(dot(a, b) < 0 ? -b : b);
    value.add(reference::ulps(slerp(a, b, tau), reference::slerp(wide_a, near_b, tau), 1), a, b,
              tau);

    const reference::four exact_slope = reference::difference(
        [&](const reference::real& t) {
          return reference::slerp(wide_a, near_b, reference::real(tau + t));
        },
        1);
    const auto automatic = duet::derivative<duet_test::shared_tag>(
        [&, p = a, q = b](const auto& t) { return slerp(p, q, t); }, tau);
    // The rate of a small rotation is small, with a small relative error.
    const reference::real scale = reference::length(exact_slope);
    slope.add(reference::ulps(automatic.derivative, exact_slope, scale), a, b, tau);
  }
  CHECK_MESSAGE(value <= 16, value);
  CHECK_MESSAGE(slope <= 16, slope);
}

TEST_CASE("slerp: meets its ends and takes the shorter arc") {
  for (const auto& [a, b] : pairs()) {
    const auto near_b = dot(a, b) < 0 ? -b : b;
    CHECK(norm(slerp(a, b, 0) - a) <= 2e-16);
    CHECK(norm(slerp(a, b, 1) - near_b) <= 1e-15);
    CHECK(norm(slerp(a, b, 0.3) - slerp(a, -b, 0.3)) <= 1e-15);
    CHECK(norm(slerp(a, b, 0.5)) == doctest::Approx(1).epsilon(1e-15));
  }
  // Half a turn apart both arcs are equally long; the sign of b is kept.
  const quaternion<double> i(0, 1, 0, 0);
  const double root = std::sqrt(0.5);
  CHECK(norm(slerp(quaternion<double>(1), i, 0.5) - quaternion<double>(root, root, 0, 0)) <= 2e-16);
  CHECK(norm(slerp(quaternion<double>(1), -i, 0.5) - quaternion<double>(root, -root, 0, 0)) <=
        2e-16);
  CHECK_THROWS_AS(static_cast<void>(slerp(pairs()[0].first, quaternion<double>(), 0.5)),
                  duet::invalid_input);
}

} // namespace
} // namespace test_quaternion_slerp
