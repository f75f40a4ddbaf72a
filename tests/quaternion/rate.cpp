// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/shared_tag.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>

// N7 and N8: rates of unit quaternions and angular velocities, in both frames.

namespace test_quaternion_rate {
namespace {

using duet::quaternion, duet::vector3;
namespace frame = duet::frame;

/// Rotation about three axes at once, over any scalar.
template <class T>
quaternion<T> motion(const T& t) {
  using std::sin;
  const auto rotation_about = [](const vector3<double>& axis, const T& angle) {
    return duet::exp(vector3<T>(axis[0] * angle, axis[1] * angle, axis[2] * angle));
  };
  return rotation_about({0.3, -0.2, 0.9}, t) * rotation_about({-0.5, 1, 0.1}, T(t * t)) *
         rotation_about({1, 0.4, -0.7}, T(sin(2 * t)));
}

/// The coefficient of ε in every entry.
template <class M>
Eigen::Matrix3d slope(const M& m) {
  return m.unaryExpr([](const auto& x) { return x.epsilon(); }).template cast<double>();
}

TEST_CASE("N7: angular_velocity and quaternion_rate agree with AD of the rotation matrix") {
  // ω̂^s = Ṙ Rᵀ and ω̂^b = Rᵀ Ṙ, by AD of the matrix alone.
  for (double t = -2; t <= 2; t += 0.125) {
    const auto [q, q_dot] =
        duet::derivative<duet_test::shared_tag>([](const auto& u) { return motion(u); }, t);
    const auto matrix = rotation_matrix(motion(duet::dual<double>::variable(t)));
    const Eigen::Matrix3d r = rotation_matrix(q);
    const Eigen::Matrix3d r_dot = slope(matrix);
    const Eigen::Matrix3d spatial = r_dot * r.transpose();
    const Eigen::Matrix3d body = r.transpose() * r_dot;
    const vector3<double> omega_s = angular_velocity(q, q_dot, frame::spatial);
    const vector3<double> omega_b = angular_velocity(q, q_dot, frame::body);
    CHECK((omega_s - vector3<double>(spatial(2, 1), spatial(0, 2), spatial(1, 0))).norm() <= 1e-14);
    CHECK((omega_b - vector3<double>(body(2, 1), body(0, 2), body(1, 0))).norm() <= 1e-14);
    CHECK((omega_s - rotate(q, omega_b)).norm() <= 1e-14);
    CHECK(norm(quaternion_rate(q, omega_s, frame::spatial) - q_dot) <= 1e-14);
    CHECK(norm(quaternion_rate(q, omega_b, frame::body) - q_dot) <= 1e-14);
    // For a unit quaternion the scalar part vanishes.
    CHECK(std::abs((q_dot * conj(q)).w()) <= 1e-15);
  }
}

TEST_CASE("angular_acceleration and quaternion_acceleration: agree with AD and are inverse") {
  const auto check = [](double t, auto axes) {
    const auto q = duet::derivatives<2>([](const auto& u) { return motion(u); }, t);
    const auto [omega, rate] = duet::derivative<duet_test::shared_tag>(
        [&](const auto& u) {
          const auto [value, slope] = duet::derivative([](const auto& w) { return motion(w); }, u);
          return angular_velocity(value, slope, axes);
        },
        t);
    const vector3<double> alpha = angular_acceleration(q[0], q[1], q[2], axes);
    CHECK((alpha - rate).norm() <= 1e-13);
    const auto back = quaternion_acceleration(q[0], omega, alpha, axes);
    CHECK(norm(quaternion<double>(back - q[2])) <= 1e-13);
  };
  for (double t = -2; t <= 2; t += 0.125) {
    check(t, frame::spatial);
    check(t, frame::body);
  }
}

// They are linear in q: one quaternion tells all.
TEST_CASE("N8: the matrices E and G") {
  const quaternion<double> named(10, 1, 2, 3);
  Eigen::Matrix<double, 3, 4> e;
  e << -1, 10, -3, 2, -2, 3, 10, -1, -3, -2, 1, 10;
  Eigen::Matrix<double, 3, 4> g;
  g << -1, 10, 3, -2, -2, -3, 10, 1, -3, 2, -1, 10;
  CHECK(quaternion_rate_matrix(named, frame::spatial) == e);
  CHECK(quaternion_rate_matrix(named, frame::body) == g);
}

} // namespace
} // namespace test_quaternion_rate
