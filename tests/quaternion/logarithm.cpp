// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

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
  }
  CHECK_MESSAGE(value <= 16, value);
  CHECK_MESSAGE(slope <= 16, slope);
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
  DUET_CHECK_REFUSED("duet: log: the quaternion is zero", log(zero));
  DUET_CHECK_REFUSED("duet: pow: the quaternion is zero", pow(zero, 2));
  DUET_CHECK_REFUSED("duet: normalized: the quaternion is zero", normalized(zero));
  DUET_CHECK_REFUSED("duet: inverse: the quaternion is zero", inverse(zero));
  CHECK_THROWS_AS(static_cast<void>(slerp(zero, quaternion<double>(1), 0.5)), duet::invalid_input);
  CHECK(norm(zero) == 0);
  // NaN is not zero.
  const quaternion<double> nan(0, std::nan(""), 0, 0);
  CHECK(std::isnan(log(nan).x()));
  CHECK(std::isnan(normalized(nan).x()));
  CHECK(std::isnan(inverse(nan).x()));
}

} // namespace test_quaternion_logarithm
