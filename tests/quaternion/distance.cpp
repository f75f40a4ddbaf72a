// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/gap.hpp"
#include "support/lanes.hpp"
#include "support/random.hpp"
#include "support/shared_tag.hpp"
#include "support/test.hpp"

#include <duet/derivative/tangent_coordinates.hpp>
#include <duet/interop/multiprecision.hpp>
#include <duet/quaternion/distance.hpp>
#include <duet/quaternion/rotation.hpp>

// The angle between two rotations and its square.

namespace test_quaternion_distance {
namespace {

using duet::distance, duet::squared_distance, duet_test::max_abs_difference, std::numbers::pi;
using quaternion = duet::quaternion<double>;
using vector = duet::vector3<double>;
using matrix = duet::matrix3<double>;
namespace frame = duet::frame;

const vector axis(2.0 / 7, -3.0 / 7, 6.0 / 7);
const quaternion start = duet::from_rotation_vector(vector(0.3, -1.2, 0.7));

/// Angle by its definition in 50 digits, for the given rounded rotations.
double exact_distance(const quaternion& a, const quaternion& b) {
  const duet::quaternion<duet::real_50> rotation =
      conj(duet::quaternion<duet::real_50>(a)) * duet::quaternion<duet::real_50>(b);
  const duet::real_50 sine =
      sqrt(rotation.x() * rotation.x() + rotation.y() * rotation.y() + rotation.z() * rotation.z());
  return double(2 * atan2(sine, abs(rotation.w())));
}

TEST_CASE("distance: equals the rotation angle for all signs of both quaternions") {
  for (const double angle : {0.0, 1e-200, 1e-12, 1e-4, 0.3, 1.0, 2.5, pi - 1e-9, pi}) {
    CAPTURE(angle);
    const quaternion rotation = duet::from_rotation_vector(vector(angle * axis));
    CHECK(distance(quaternion(1), rotation) == doctest::Approx(angle).epsilon(1e-15));
    CHECK(std::abs(squared_distance(rotation, quaternion(1)) - angle * angle) <=
          2e-15 * angle * angle);
    for (const quaternion& b : {rotation * start, -(start * rotation)}) {
      CHECK(std::abs(distance(start, b) - angle) < 1e-15);
      CHECK(distance(start, b) == doctest::Approx(exact_distance(start, b)).epsilon(4e-15));
      CHECK(distance(b, start) == doctest::Approx(distance(start, b)).epsilon(4e-15));
      CHECK(distance(start, -b) == distance(start, b));
      CHECK(distance(-start, b) == distance(start, b));
      CHECK(squared_distance(start, b) ==
            doctest::Approx(std::pow(distance(start, b), 2)).epsilon(1e-15));
    }
  }
  CHECK(distance(start, duet::from_rotation_vector(vector(4 * axis)) * start) ==
        doctest::Approx(2 * pi - 4).epsilon(1e-15));
  CHECK(distance(start, start) == 0);
  CHECK(distance(start, -start) == 0);
  DUET_CHECK_REFUSED("duet: distance: the quaternion is zero", distance(start, quaternion()));
  CHECK_THROWS_AS(static_cast<void>(squared_distance(quaternion(), start)), duet::invalid_input);
}

TEST_CASE("distance: accurate for nearby rotations, invariant, and obeys the triangle inequality") {
  duet_test::random_source random(7);
  for (int i = 0; i < 100; ++i) {
    const auto some = [&](double size) {
      return quaternion(random.uniform(-size, size), random.uniform(-size, size),
                        random.uniform(-size, size), random.uniform(-size, size));
    };
    const quaternion a = normalized(some(1));
    const quaternion b = normalized(a + some(std::pow(10, -0.15 * i)));
    const quaternion c = normalized(some(1));
    CHECK(distance(a, b) == doctest::Approx(exact_distance(a, b)).epsilon(4e-15));
    CHECK(distance(a, c) <= distance(a, b) + distance(b, c) + 1e-15);
    CHECK(distance(c * a, c * b) == doctest::Approx(distance(a, b)).epsilon(1e-14).scale(0.1));
    CHECK(distance(a * c, b * c) == doctest::Approx(distance(a, b)).epsilon(1e-14).scale(0.1));
  }
}

TEST_CASE("distance: gradients and Hessians have closed forms, also at and near zero") {
  // b = exp(r/2) a moves as exp(δ/2) b. The gradient of θ² = |r|² is 2r, the Hessian
  // 2 ((θ/2) cot(θ/2) (1 − r̂r̂ᵀ) + r̂r̂ᵀ); those of θ are r̂ and ½ cot(θ/2) (1 − r̂r̂ᵀ).
  const auto square = [](const auto& b) { return squared_distance(start, b); };
  const auto angle = [](const auto& b) { return distance(start, b); };
  const matrix along = axis * axis.transpose();
  for (const double theta : {1e-150, 1e-30, 1e-8, 1e-3, 0.4, 2.0, 3.1}) {
    CAPTURE(theta);
    const quaternion b = duet::from_rotation_vector(vector(theta * axis)) * start;
    CHECK(max_abs_difference(
              duet::gradient<duet_test::shared_tag>(square, b, frame::spatial).gradient,
              vector(2 * theta * axis)) < 4e-15);
    const matrix across = theta / 2 / std::tan(theta / 2) * (matrix::Identity() - along);
    CHECK(max_abs_difference(duet::hessian(square, b, frame::spatial).hessian,
                             matrix(2 * (across + along))) < 1e-13);
    if (theta > 1e-4) {
      CHECK(max_abs_difference(
                duet::gradient<duet_test::shared_tag>(angle, b, frame::spatial).gradient, axis) <
            1e-15 / theta);
      CHECK(max_abs_difference(duet::hessian(angle, b, frame::spatial).hessian,
                               matrix(across / theta)) < 1e-14 / (theta * theta));
    }
  }
  const auto [value, slope, curvature] = duet::hessian(square, start, frame::body);
  CHECK(value == 0);
  CHECK(slope.norm() == 0);
  CHECK(max_abs_difference(curvature, matrix(2 * matrix::Identity())) < 1e-15);
  // From the identity the difference is exact for any angle, however small.
  const auto from_one = [](const auto& b) { return distance(quaternion(1), b); };
  for (const double theta : {1e-300, 1e-150, 1e-8}) {
    const quaternion b = duet::from_rotation_vector(vector(theta * axis));
    CHECK(max_abs_difference(
              duet::gradient<duet_test::shared_tag>(from_one, b, frame::spatial).gradient, axis) <
          1e-15);
  }
  // Gradient with respect to both arguments.
  const auto both = [](const auto& a, const auto& b) { return squared_distance(a, b); };
  const quaternion end = duet::from_rotation_vector(vector(0.8 * axis)) * start;
  const auto g =
      duet::gradient<duet_test::shared_tag>(both, std::tuple(start, end), frame::spatial).gradient;
  CHECK(max_abs_difference(g.head<3>(), vector(-1.6 * axis)) < 4e-15);
  CHECK(max_abs_difference(g.tail<3>(), vector(1.6 * axis)) < 4e-15);
}

TEST_CASE("squared_distance: at a half turn the gradient belongs to the arc of the given sign") {
  const quaternion half_turn(0, 1, 0, 0);
  const auto square = [](const auto& b) { return squared_distance(quaternion(1), b); };
  const auto gradient_at = [&](const quaternion& b) {
    return vector(duet::gradient<duet_test::shared_tag>(square, b, frame::spatial).gradient);
  };
  CHECK(square(half_turn) == doctest::Approx(pi * pi).epsilon(1e-15));
  CHECK(max_abs_difference(gradient_at(half_turn), vector(2 * pi, 0, 0)) < 4e-15);
  CHECK(max_abs_difference(gradient_at(-half_turn), vector(-2 * pi, 0, 0)) < 4e-15);
}

TEST_CASE("distance: batches agree with each lane") {
  std::vector<quaternion> a, b;
  for (const double angle : {0.0, 1e-170, 1e-9, 0.4, 2.0, pi, 4.0, 6.28}) {
    a.push_back(start);
    b.push_back(duet::from_rotation_vector(vector(angle * axis)) * start);
  }
  DUET_CHECK_LANES(distance, 16, a, b);
  DUET_CHECK_LANES(squared_distance, 16, a, b);
}

} // namespace
} // namespace test_quaternion_distance
