// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/mixed_arguments.hpp"
#include "support/test.hpp"

#include <duet/quaternion/curves.hpp>
#include <duet/quaternion/distance.hpp>
#include <duet/quaternion/euler.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>

namespace test_quaternion_mixed_arguments {

using namespace test_support::mixed;

TEST_CASE("quaternions: every function accepts constants mixed with derivatives") {
  check(
      "quaternion", [](const auto&... x) { return quaternion(x...); }, 0.1, 0.2, 0.3, 0.4);
  check(
      "+ - *", [](const auto& a, const auto& b) { return (a + b) * (a - b) * a * b; }, p, q);
  check(
      "* / of a number", [](const auto& a, const auto& x) { return a * x + x * a + a / x; }, p,
      0.3);
  DUET_CHECK_MIXED(dot, p, q);
  DUET_CHECK_MIXED(pow, p, 0.3);
  DUET_CHECK_MIXED(slerp, p, q, 0.3);
  DUET_CHECK_MIXED(distance, p, q);
  DUET_CHECK_MIXED(squared_distance, p, q);
  DUET_CHECK_MIXED(squad_control, p, q, r);
  DUET_CHECK_MIXED(squad, p, q, r, s, 0.3);
  check(
      "bezier", [](const auto& points, const auto& tau) { return bezier(points, tau); },
      std::array{p, q, r}, 0.3);
  check(
      "bezier", [](const auto& points, const auto& tau) { return bezier(points, tau); },
      std::vector{p, q, r}, 0.3);
  DUET_CHECK_MIXED(rotate, p, u);
  DUET_CHECK_MIXED(from_axis_angle, u, 0.3);
  DUET_CHECK_MIXED(from_two_vectors, u, v);
  DUET_CHECK_MIXED(from_euler<zyx>, 0.3, -0.4, 0.6);
  DUET_CHECK_MIXED(euler_rate_matrix<zyx>, 0.3, -0.4);
  DUET_CHECK_MIXED(euler_rate_matrix<zxz>, 0.3, 0.4);
  DUET_CHECK_MIXED(printed_euler_rate_matrix, 0.3, -0.4);
  check(
      "angular_velocity",
      [](const auto& a, const auto& rate) { return angular_velocity(a, rate, frame::body); }, p, q);
  check(
      "angular_acceleration",
      [](const auto& a, const auto& second) {
        return angular_acceleration(a, r, second, frame::body);
      },
      p, q);
  check(
      "quaternion_acceleration",
      [](const auto& a, const auto& omega, const auto& alpha) {
        return quaternion_acceleration(a, omega, alpha, frame::spatial);
      },
      p, u, v);
  check(
      "quaternion_rate",
      [](const auto& a, const auto& omega) { return quaternion_rate(a, omega, frame::spatial); }, p,
      u);
}

} // namespace test_quaternion_mixed_arguments
