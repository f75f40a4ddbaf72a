// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "quaternion/truth.hpp"
#include "support/random.hpp"
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

using duet::quaternion, duet::vector3, duet_test::random_source, duet_test::worst_error;
namespace frame = duet::frame;
namespace reference = duet_test::reference;

quaternion<double> random_rotation(random_source& random) {
  const auto d = random.direction<4>();
  return {d[0], d[1], d[2], d[3]};
}
vector3<double> random_vector(random_source& random) {
  return {random.normal(), random.normal(), random.normal()};
}

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

TEST_CASE("N7: angular_velocity agrees with AD of the rotation matrix") {
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

TEST_CASE("N7: angular_velocity and quaternion_rate agree with 100 digits") {
  worst_error spatial("spatial");
  worst_error body("body");
  worst_error rate_s("rate from spatial");
  worst_error rate_b("rate from body");
  random_source random(71);
  for (int i = 0; i < 200; ++i) {
    const auto q = random_rotation(random);
    const auto q_dot = random_rotation(random) * random.log_uniform(1e-8, 1e8);
    const auto wide_q = reference::wide(q);
    const auto wide_rate = reference::wide(q_dot);
    auto exact_s = reference::times(reference::product(wide_rate, reference::conj(wide_q)), 2);
    auto exact_b = reference::times(reference::product(reference::conj(wide_q), wide_rate), 2);
    exact_s[0] = 0;
    exact_b[0] = 0;
    const reference::real scale = 2 * reference::length(wide_rate);
    spatial.add(reference::ulps(quaternion<double>(0, angular_velocity(q, q_dot, frame::spatial)),
                                exact_s, scale),
                q, q_dot);
    body.add(reference::ulps(quaternion<double>(0, angular_velocity(q, q_dot, frame::body)),
                             exact_b, scale),
             q, q_dot);

    const vector3<double> omega = random_vector(random);
    const reference::four wide_omega = reference::wide(quaternion<double>(0, omega));
    const auto back_s = reference::times(reference::product(wide_omega, wide_q), 0.5);
    const auto back_b = reference::times(reference::product(wide_q, wide_omega), 0.5);
    rate_s.add(reference::ulps(quaternion_rate(q, omega, frame::spatial), back_s,
                               reference::length(back_s)),
               q, omega.transpose());
    rate_b.add(
        reference::ulps(quaternion_rate(q, omega, frame::body), back_b, reference::length(back_b)),
        q, omega.transpose());
  }
  for (const auto& w : {spatial, body, rate_s, rate_b}) {
    CHECK_MESSAGE(w <= 4, w);
  }
}

TEST_CASE("N7: quaternion_rate and angular_velocity are inverse") {
  random_source random(72);
  for (int i = 0; i < 50; ++i) {
    const auto q = random_rotation(random);
    const vector3<double> omega = random_vector(random);
    CHECK((angular_velocity(q, quaternion_rate(q, omega, frame::spatial), frame::spatial) - omega)
              .norm() <= 5e-15);
    CHECK(
        (angular_velocity(q, quaternion_rate(q, omega, frame::body), frame::body) - omega).norm() <=
        5e-15);
  }
}

TEST_CASE("N8: the matrices E and G give ω = 2 E q̇ = 2 R G q̇ and E Gᵀ = R") {
  const quaternion<double> named(10, 1, 2, 3);
  Eigen::Matrix<double, 3, 4> e;
  e << -1, 10, -3, 2, -2, 3, 10, -1, -3, -2, 1, 10;
  Eigen::Matrix<double, 3, 4> g;
  g << -1, 10, 3, -2, -2, -3, 10, 1, -3, 2, -1, 10;
  CHECK(quaternion_rate_matrix(named, frame::spatial) == e);
  CHECK(quaternion_rate_matrix(named, frame::body) == g);

  random_source random(73);
  for (int i = 0; i < 50; ++i) {
    const auto q = random_rotation(random);
    const auto q_dot = random_rotation(random);
    const Eigen::Vector4d column(q_dot.w(), q_dot.x(), q_dot.y(), q_dot.z());
    const Eigen::Matrix<double, 3, 4> E = quaternion_rate_matrix(q, frame::spatial);
    const Eigen::Matrix<double, 3, 4> G = quaternion_rate_matrix(q, frame::body);
    CHECK((2 * E * column - angular_velocity(q, q_dot, frame::spatial)).norm() <= 2e-15);
    CHECK((2 * G * column - angular_velocity(q, q_dot, frame::body)).norm() <= 2e-15);
    CHECK((E * G.transpose() - rotation_matrix(q)).norm() <= 2e-15);
    // The rows are perpendicular to q and to each other: q̇ = ½ Eᵀ ω.
    CHECK((E * E.transpose() - Eigen::Matrix3d::Identity()).norm() <= 2e-15);
    CHECK((E * Eigen::Vector4d(q.w(), q.x(), q.y(), q.z())).norm() <= 2e-15);
    const vector3<double> omega = random_vector(random);
    const auto rate = quaternion_rate(q, omega, frame::spatial);
    CHECK((0.5 * E.transpose() * omega - Eigen::Vector4d(rate.w(), rate.x(), rate.y(), rate.z()))
              .norm() <= 2e-15);
  }
}

// Angular acceleration: the derivative of 2 q̇ q* is 2 q̈ q*, without its scalar part.
TEST_CASE("N7: angular_velocity over Taylor numbers contains the angular acceleration") {
  const double t = 0.4;
  const auto ys = duet::derivatives<2>([](const auto& u) { return motion(u); }, t);
  const auto by_ad = duet::derivative<duet_test::shared_tag>(
      [](const auto& u) {
        struct inner;
        const auto [q, q_dot] = duet::derivative<inner>([](const auto& w) { return motion(w); }, u);
        return angular_velocity(q, q_dot, frame::spatial);
      },
      t);
  const vector3<double> alpha = angular_velocity(ys[0], ys[2], frame::spatial);
  CHECK((by_ad.value - angular_velocity(ys[0], ys[1], frame::spatial)).norm() <= 1e-14);
  CHECK((by_ad.derivative - alpha).norm() <= 5e-14);
}

} // namespace
} // namespace test_quaternion_rate
