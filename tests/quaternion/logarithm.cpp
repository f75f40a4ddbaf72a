// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "quaternion/closed_forms.hpp"
#include "quaternion/hard_inputs.hpp"
#include "quaternion/truth.hpp"
#include "support/random.hpp"
#include "support/shared_tag.hpp"
#include "support/test.hpp"

#include <duet/derivative/jacobian.hpp>
#include <duet/quaternion/exponential.hpp>

// N4: log q = log |q| + û atan2(|q⃗|, q₀), against 100 digits.

namespace test_quaternion_logarithm {

using duet::quaternion, duet_test::random_source, duet_test::worst_error;
namespace reference = duet_test::reference;

TEST_CASE("N4: log and its first derivative agree with 100 digits") {
  random_source random(3);
  worst_error value("log");
  worst_error slope("log, derivative by AD");
  worst_error closed("log, derivative in closed form");
  for (const auto& q : duet_test::hard_quaternions()) {
    const reference::four x = reference::wide(q);
    const reference::real smooth = duet_test::smooth_length(x);
    const reference::four exact = reference::log(x);
    value.add(reference::ulps(log(q), exact,
                              reference::length(exact) +
                                  reference::change_of_value(reference::log, x, smooth)),
              q);

    const auto d = random.direction<4>();
    const quaternion<double> q_dot(d[0], d[1], d[2], d[3]);
    const reference::four dx = reference::wide(q_dot);
    const reference::four exact_slope = reference::difference(
        [&](const reference::real& t) { return reference::log(reference::sum(x, dx, t)); }, 1,
        smooth);
    const reference::real scale = reference::length(exact_slope) +
                                  reference::change_of_derivative(reference::log, x, dx, smooth);
    const auto automatic = duet::derivative<duet_test::shared_tag>(
        [&](const auto& t) { return log(q + t * q_dot); }, 0.0);
    slope.add(reference::ulps(automatic.derivative, exact_slope, scale), q, q_dot);
    // The closed form contains φ and loses precision near a full turn; AD does not.
    if (q.w() > 0 || smooth > reference::length(x) / 10) {
      closed.add(
          reference::ulps(duet_test::closed_form::log_derivative(q, q_dot), exact_slope, scale), q,
          q_dot);
    }
  }
  CHECK_MESSAGE(value <= 16, value);
  CHECK_MESSAGE(slope <= 16, slope);
  CHECK_MESSAGE(closed <= 16, closed);
}

// The vector part of a small rotation must not be lost next to the scalar part 1.
TEST_CASE("log: the vector part is accurate near the identity and a full turn") {
  for (const double length : {1e-300, 1e-160, 1e-150, 1e-30, 1e-8, 1e-4}) {
    const auto l = log(quaternion<double>(1, 0, length, 0));
    CHECK(std::abs(l.y() / std::atan(length) - 1) <= 3e-16);
    const auto logarithm = log(quaternion<double>(-1, 0, length, 0));
    CHECK(logarithm.y() == doctest::Approx(3.141592653589793 - std::atan(length)).epsilon(3e-16));
  }
}

TEST_CASE("exp and log are inverse to each other") {
  worst_error exp_of_log("exp(log q)");
  worst_error log_of_exp("log(exp q)");
  for (const auto& q : duet_test::hard_quaternions()) {
    const double size = norm(q);
    if (size > 1e-100 && size < 1e100) {
      exp_of_log.add(norm(exp(log(q)) - q) / size / 0x1p-53 / (1 + std::abs(std::log(size))), q);
    }
  }
  random_source random(4);
  for (int i = 0; i < 1000; ++i) {
    const auto d = random.direction<3>();
    const double length = i % 2 == 0 ? random.uniform(0, 3.1) : random.log_uniform(1e-300, 3.1);
    const quaternion<double> l(random.uniform(-3, 3), length * d[0], length * d[1], length * d[2]);
    log_of_exp.add(norm(log(exp(l)) - l) / 0x1p-53 / (1 + norm(l)) * (3.15 - length), l);
  }
  CHECK_MESSAGE(exp_of_log <= 8, exp_of_log);
  CHECK_MESSAGE(log_of_exp <= 16, log_of_exp);
}

TEST_CASE("log: log(-q) belongs to the longer arc, no sign is flipped") {
  random_source random(5);
  for (int i = 0; i < 100; ++i) {
    const auto d = random.direction<4>();
    const quaternion<double> q(d[0], d[1], d[2], d[3]);
    const auto v = log(q).vec();
    const auto w = log(-q).vec();
    CHECK(v.norm() + w.norm() == doctest::Approx(3.141592653589793).epsilon(1e-15));
    CHECK(v.dot(w) == doctest::Approx(-v.norm() * w.norm()).epsilon(1e-14));
    CHECK(norm(exp(log(-q)) + q) <= 1e-15);
  }
}

TEST_CASE("log: a half turn is a regular point") {
  const auto l = log(quaternion<double>(0, 0, 1, 0));
  CHECK(l == quaternion<double>(0, 0, 1.5707963267948966, 0));
  CHECK(norm(exp(l) - quaternion<double>(0, 0, 1, 0)) <= 1e-16);
}

TEST_CASE("log: at -|q| the axis is x and derivatives are NaN") {
  using duet::dual;
  CHECK(log(quaternion<double>(-1, 0, 0, 0)) == quaternion<double>(0, 3.141592653589793, 0, 0));
  const auto l = log(quaternion<double>(-1e200, 0, -0.0, 0));
  CHECK(l.w() == doctest::Approx(std::log(1e200)).epsilon(1e-15));
  CHECK(l.vec() == duet::vector3<double>(3.141592653589793, 0, 0));
  CHECK(norm(exp(log(quaternion<double>(-1, 0, 0, 0))) + quaternion<double>(1)) <= 2e-16);

  // With respect to the vector part there is no derivative; the scalar part changes only |q|.
  using D = dual<double, 2>;
  const auto by_both = log(quaternion<D>(D::variable(-2, 0), D(0), D::variable(0, 1), D(0)));
  CHECK(by_both.w().partial(0) == -0.5);
  CHECK(by_both.w().partial(1) == 0);
  for (const D& component : {by_both.x(), by_both.y(), by_both.z()}) {
    CHECK(component.partial(0) == 0);
    CHECK(std::isnan(component.partial(1)));
  }
}

TEST_CASE("log, pow, normalized and inverse reject the zero quaternion") {
  const quaternion<double> zero;
  CHECK_THROWS_WITH_AS(static_cast<void>(log(zero)), "duet: log: the quaternion is zero",
                       duet::invalid_input);
  CHECK_THROWS_WITH_AS(static_cast<void>(pow(zero, 2)), "duet: pow: the quaternion is zero",
                       duet::invalid_input);
  CHECK_THROWS_WITH_AS(static_cast<void>(normalized(zero)),
                       "duet: normalized: the quaternion is zero", duet::invalid_input);
  CHECK_THROWS_WITH_AS(static_cast<void>(inverse(zero)), "duet: inverse: the quaternion is zero",
                       duet::invalid_input);
  CHECK_THROWS_AS(static_cast<void>(slerp(zero, quaternion<double>(1), 0.5)), duet::invalid_input);
  CHECK(norm(zero) == 0);
  // NaN is not zero.
  const quaternion<double> nan(0, std::nan(""), 0, 0);
  CHECK(std::isnan(log(nan).x()));
  CHECK(std::isnan(normalized(nan).x()));
  CHECK(std::isnan(inverse(nan).x()));
}

} // namespace test_quaternion_logarithm
