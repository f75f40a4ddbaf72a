// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rotation.hpp>

// Rotation matrices and quaternions by every branch of Shepperd's method.

namespace test_quaternion_rotation_matrix {
namespace {

using duet::from_rotation_matrix, duet::matrix3, duet::quaternion, duet_test::random_source;

/// q or −q, whichever has a positive component `largest`.
quaternion<double> with_positive(const quaternion<double>& q, int largest) {
  const double components[] = {q.w(), q.x(), q.y(), q.z()};
  return components[largest] < 0 ? -q : q;
}

/// Unit quaternions whose largest component, in some up to rounding, has this index.
template <class Visit>
void for_each_branch(const Visit& visit) {
  random_source random(111);
  for (int largest = 0; largest < 4; ++largest) {
    for (int i = 0; i < 50; ++i) {
      double c[4];
      for (double& x : c) {
        x = i % 5 == 0 ? random.signed_log_uniform(1e-300, 0.5) : random.uniform(-0.99, 0.99);
      }
      c[largest] = 1;
      if (i == 1) { // a half turn, or the identity
        c[(largest + 1) % 4] = c[(largest + 2) % 4] = c[(largest + 3) % 4] = 0;
      }
      visit(normalized(quaternion<double>(c[0], c[1], c[2], c[3])), largest);
    }
  }
}

TEST_CASE("from_rotation_matrix: recovers the rotation in every branch") {
  for_each_branch([](const quaternion<double>& q, int largest) {
    const auto expected = with_positive(q, largest);
    CHECK(norm(from_rotation_matrix(rotation_matrix(q)) - expected) <= 1e-15);
    CHECK(norm(from_rotation_matrix(rotation_matrix(-q)) - expected) <= 1e-15);
  });
}

TEST_CASE("from_rotation_matrix: correct where two branches meet") {
  for (int sign = 0; sign < 8; ++sign) {
    const auto s = [&](int bit) { return (sign >> bit & 1) != 0 ? -0.5 : 0.5; };
    const quaternion<double> q(0.5, s(0), s(1), s(2));
    CHECK(norm(from_rotation_matrix(rotation_matrix(q)) - q) <= 1e-15);
  }
  const double root = std::sqrt(0.5);
  for (const auto& q :
       {quaternion<double>(0, root, root, 0), quaternion<double>(0, root, 0, -root),
        quaternion<double>(0, 0, root, root), quaternion<double>(root, 0, 0, -root)}) {
    const auto back = from_rotation_matrix(rotation_matrix(q));
    CHECK(std::abs(std::abs(dot(back, q)) - 1) <= 1e-15);
  }
}

TEST_CASE("from_rotation_matrix: first and second derivatives are correct in every branch") {
  random_source random(112);
  for_each_branch([&](const quaternion<double>& q, int largest) {
    const duet::vector3<double> v(random.normal(), random.normal(), random.normal());
    const auto curve = [&](const auto& t) {
      using T = std::decay_t<decltype(t)>;
      return q * duet::exp(duet::vector3<T>(v[0] * t, v[1] * t, v[2] * t));
    };
    const auto direct = duet::derivatives<2>(curve, 0.0);
    const auto around = duet::derivatives<2>(
        [&](const auto& t) { return from_rotation_matrix(rotation_matrix(curve(t))); }, 0.0);
    const double sign = norm(with_positive(q, largest) - q) == 0 ? 1 : -1;
    for (std::size_t k = 0; k <= 2; ++k) {
      CHECK(norm(around[k] - sign * direct[k]) <= 5e-15 * (1 + norm(direct[k])));
    }
  });
}

TEST_CASE("from_rotation_matrix: rejects other matrices with their defect and determinant") {
  const auto message = [](const matrix3<double>& m) {
    return duet_test::message_of([&] { static_cast<void>(from_rotation_matrix(m)); });
  };
  matrix3<double> m = matrix3<double>::Identity();
  CHECK(message(m) == "");
  m(0, 0) = -1;
  CHECK(message(m) == "duet: from_rotation_matrix: the matrix is not a rotation: |R R^T - 1| = 0, "
                      "det R = -1 (expected 0 and 1)");
  m(0, 0) = 2;
  CHECK(message(m).find("|R R^T - 1| = 3") != std::string::npos);
  CHECK(message(matrix3<double>::Zero()) != "");
  m(0, 0) = std::nan("");
  CHECK(message(m) != "");
  m = matrix3<double>::Identity();
  m(0, 1) = 2e-6;
  CHECK(message(m) != "");
  m(0, 1) = 1e-7;
  CHECK(message(m) == "");
}

} // namespace
} // namespace test_quaternion_rotation_matrix
