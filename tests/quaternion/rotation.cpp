// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "quaternion/truth.hpp"
#include "support/random.hpp"
#include "support/shared_tag.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rotation.hpp>

// Unit quaternions as rotations of vectors; axis and angle, rotation vectors, pairs of vectors.

namespace test_quaternion_rotation {
namespace {

using duet::quaternion, duet::vector3, duet_test::random_source, duet_test::worst_error;
namespace reference = duet_test::reference;

using std::numbers::pi;

vector3<double> direction(random_source& random) {
  const auto d = random.direction<3>();
  return {d[0], d[1], d[2]};
}
quaternion<double> random_rotation(random_source& random) {
  const auto d = random.direction<4>();
  return normalized(quaternion<double>(d[0], d[1], d[2], d[3]));
}
quaternion<double> pure(const vector3<double>& v) { return {0, v}; }

TEST_CASE("rotate: the active rotation v -> q v q*") {
  const double root = std::sqrt(0.5);
  const quaternion<double> quarter_about_z(root, 0, 0, root);
  CHECK((rotate(quarter_about_z, vector3<double>(1, 0, 0)) - vector3<double>(0, 1, 0)).norm() <=
        4e-16);
  random_source random(101);
  worst_error by_quaternion("rotate");
  worst_error by_matrix("rotation_matrix");
  for (int i = 0; i < 200; ++i) {
    const auto q = random_rotation(random);
    const vector3<double> v = random.log_uniform(1e-100, 1e100) * direction(random);
    const auto wide_q = reference::wide(q);
    // Normalised in wide arithmetic: a rounded norm would scale q v q*.
    const auto unit = reference::times(wide_q, 1 / reference::length(wide_q));
    const auto exact = reference::product(reference::product(unit, reference::wide(pure(v))),
                                          reference::conj(unit));
    by_quaternion.add(reference::ulps(pure(rotate(q, v)), exact, 4 * reference::length(exact)), q,
                      v.transpose());
    by_matrix.add(
        reference::ulps(pure(rotation_matrix(q) * v), exact, 4 * reference::length(exact)), q,
        v.transpose());
    const auto p = random_rotation(random);
    CHECK((rotate(p * q, v) - rotate(p, rotate(q, v))).norm() <= 2e-15 * v.norm());
    CHECK((rotation_matrix(p * q) - rotation_matrix(p) * rotation_matrix(q)).norm() <= 3e-15);
  }
  CHECK_MESSAGE(by_quaternion <= 4, by_quaternion);
  CHECK_MESSAGE(by_matrix <= 4, by_matrix);
}

TEST_CASE("from_axis_angle: rotates about an axis of any length and rejects the zero axis") {
  random_source random(102);
  for (int i = 0; i < 100; ++i) {
    const vector3<double> n = direction(random);
    const double angle = random.uniform(-7, 7);
    const quaternion<double> expected(std::cos(angle / 2),
                                      vector3<double>(std::sin(angle / 2) * n));
    for (const double length : {1e-300, 1e-140, 0.1, 1.0, 1e140, 1e300}) {
      CHECK(norm(duet::from_axis_angle(vector3<double>(length * n), angle) - expected) <= 1e-15);
    }
  }
  DUET_CHECK_REFUSED("duet: from_axis_angle: the axis is the zero vector",
                     duet::from_axis_angle(vector3<double>(0, 0, 0), 1.0));

  // ω of a rotation about a fixed axis is that axis.
  const vector3<double> n(1, 2, 2);
  const auto [q, q_dot] = duet::derivative<duet_test::shared_tag>(
      [&](const auto& t) { return duet::from_axis_angle(n, t); }, 0.7);
  CHECK(norm(q_dot - q * quaternion<double>(0, vector3<double>(n / 6))) <= 1e-16);
}

TEST_CASE("rotation_vector: inverse of from_rotation_vector, equal for q and -q, at most pi") {
  random_source random(103);
  for (int i = 0; i < 200; ++i) {
    const double angle = i % 2 == 0 ? random.uniform(0, pi) : random.log_uniform(1e-300, pi);
    const vector3<double> r = angle * direction(random);
    const auto q = duet::from_rotation_vector(r);
    CHECK((rotation_vector(q) - r).norm() <= 1e-15 * std::max(1.0, r.norm()) * r.norm() + 1e-320);
    CHECK(rotation_vector(q) == rotation_vector(-q));
    const auto any = random_rotation(random) * random.log_uniform(1e-100, 1e100);
    CHECK(rotation_vector(any).norm() <= pi * (1 + 2e-16));
    CHECK(rotation_vector(any) == rotation_vector(-any));
    CHECK((rotation_matrix(duet::from_rotation_vector(rotation_vector(any))) -
           rotation_matrix(normalized(any)))
              .norm() <= 3e-15);
  }
  // At a half turn the direction is that of the sign of q.
  CHECK(rotation_vector(quaternion<double>(0, 0, 1, 0)) == vector3<double>(0, pi, 0));
  CHECK(rotation_vector(quaternion<double>(0, 0, -1, 0)) == vector3<double>(0, -pi, 0));
  CHECK(rotation_vector(quaternion<double>(-1, 0, 0, 0)).norm() == 0);
  DUET_CHECK_REFUSED("duet: rotation_vector: the quaternion is zero",
                     rotation_vector(quaternion<double>()));
}

TEST_CASE("rotation_vector: has derivatives everywhere except across a half turn") {
  random_source random(104);
  for (const double angle : {0.0, 1e-300, 1e-8, 1e-4, 1.0, 3.0, pi - 1e-8}) {
    const vector3<double> r = angle * direction(random);
    const vector3<double> d = direction(random);
    const auto [back, rate] = duet::derivative<duet_test::shared_tag>(
        [&](const auto& t) {
          using T = std::decay_t<decltype(t)>;
          const duet::vector3<T> moved(r[0] + t * d[0], r[1] + t * d[1], r[2] + t * d[2]);
          // The sign of −q gives the same derivative.
          return rotation_vector(-duet::from_rotation_vector(moved));
        },
        0.0);
    CHECK((back - r).norm() <= 2e-15);
    CHECK((rate - d).norm() <= 5e-15);
  }
}

TEST_CASE("from_two_vectors: the shortest rotation from a to b") {
  random_source random(105);
  const double angles[] = {0, 1e-300, 1e-160, 1e-12,     1e-8,      1e-4,
                           1, pi / 2, 3,      pi - 1e-4, pi - 1e-8, pi - 1e-12};
  for (const double angle : angles) {
    for (int i = 0; i < 20; ++i) {
      const vector3<double> a = direction(random);
      const vector3<double> n = a.cross(direction(random)).normalized();
      const vector3<double> b = std::cos(angle) * a + std::sin(angle) * n.cross(a);
      const double size_a = random.log_uniform(1e-100, 1e100),
                   size_b = random.log_uniform(1e-100, 1e100);
      const auto q =
          duet::from_two_vectors(vector3<double>(size_a * a), vector3<double>(size_b * b));
      CHECK(norm(q) == doctest::Approx(1).epsilon(1e-15));
      CHECK((rotate(q, a) - b).norm() <= 2e-15);
      CHECK(std::abs(q.vec().dot(a)) <= 1e-15);
      CHECK(q.w() >= 0);
      CHECK(std::abs(2 * std::atan2(q.vec().norm(), q.w()) - angle) <= 2e-15);
    }
  }
}

TEST_CASE("from_two_vectors: opposite vectors give a half turn about a perpendicular axis") {
  random_source random(106);
  for (int i = 0; i < 50; ++i) {
    const vector3<double> a = i < 3 ? vector3<double>(vector3<double>::Unit(i)) : direction(random);
    const auto q = duet::from_two_vectors(a, vector3<double>(-3 * a));
    CHECK((rotate(q, a) + a).norm() <= 1e-15);
    CHECK(std::abs(q.w()) <= 1e-15);
    CHECK(norm(q) == doctest::Approx(1).epsilon(1e-15));
  }
  // Vectors as nearly opposite as doubles can be.
  const auto q = duet::from_two_vectors(vector3<double>(1, 0, 0), vector3<double>(-1, 1e-200, 0));
  CHECK(norm(q - quaternion<double>(0, 0, 0, 1)) <= 1e-16);
  CHECK_THROWS_AS(
      static_cast<void>(duet::from_two_vectors(vector3<double>(0, 0, 0), vector3<double>(1, 0, 0))),
      duet::invalid_input);
  // No derivative exists.
  const auto [value, rate] = duet::derivative<duet_test::shared_tag>(
      [](const auto& t) {
        using T = std::decay_t<decltype(t)>;
        return duet::from_two_vectors(duet::vector3<T>(T(1), T(0), T(0)),
                                      duet::vector3<T>(T(-1), t, T(0)));
      },
      0.0);
  CHECK(std::isnan(rate.w()));
}

TEST_CASE("from_two_vectors: first and second derivatives agree with the moving axis") {
  random_source random(107);
  for (const double angle : {1e-8, 0.5, 2.0, pi - 1e-4}) {
    const vector3<double> a = direction(random);
    const vector3<double> n = a.cross(direction(random)).normalized();
    // b rotates about n and so does q, in half angles at half the rate; lengths have no effect.
    const auto [q, q_dot] = duet::derivative<duet_test::shared_tag>(
        [&](const auto& t) {
          using T = std::decay_t<decltype(t)>;
          const duet::vector3<T> from(a[0] * (1 + t), a[1] * (1 + t), a[2] * (1 + t));
          const auto rotated = rotate(duet::from_axis_angle(n, angle + t), a);
          return duet::from_two_vectors(from, duet::vector3<T>(rotated * (2 - t)));
        },
        0.0);
    const quaternion<double> expected = quaternion<double>(0, vector3<double>(n / 2)) * q;
    // At the distance δ from opposite vectors the second derivative is as large as δ⁻².
    const double distance = pi - angle;
    CHECK(norm(q_dot - expected) <= 5e-15 + 1e-15 / (distance * distance));
  }
}

} // namespace
} // namespace test_quaternion_rotation
