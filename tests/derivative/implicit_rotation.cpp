// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/derivative/implicit_function.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>

// Implicit functions whose unknown is, or contains, a rotation: three coordinates, no constraint on
// the norm, derivatives of the quaternion itself.

namespace test_derivative_implicit_rotation {
namespace {

using duet::implicit_function, duet::quaternion, duet::vector3;

/// A rotation about three axes at once, over any scalar.
template <class T>
quaternion<T> motion(const T& t) {
  using std::sin;
  const auto rotation_about = [](double x, double y, double z, const T& angle) {
    return duet::exp(vector3<T>(x * angle, y * angle, z * angle));
  };
  return rotation_about(0.3, -0.2, 0.9, t) * rotation_about(-0.5, 1, 0.1, T(t * t)) *
         rotation_about(1, 0.4, -0.7, T(sin(2 * t)));
}

/// Zero where q is the motion: three residuals, linear in the rows of the matrices.
struct orientation {
  template <class Q, class P>
  auto operator()(const Q& q, const P& p) const {
    const auto goal = rotation_matrix(motion(p));
    const auto actual = rotation_matrix(q);
    return duet::make_vector(actual.col(0).dot(goal.col(1)), actual.col(1).dot(goal.col(2)),
                             actual.col(2).dot(goal.col(0)));
  }
};

/// A point on a rotating body at a distance at which it touches a plane: rotation and two numbers.
struct contact {
  template <class X, class P>
  auto operator()(const X& unknown, const P& p) const {
    const auto& [height, q, slip] = unknown;
    const auto aligned = orientation()(q, p);
    const auto tip = rotate(q, vector3<double>(0.3, -0.2, 1));
    return duet::make_vector(aligned[0], aligned[1], aligned[2], height + tip[2], slip[0] - tip[0],
                             slip[1] - tip[0] * tip[1]);
  }
};

TEST_CASE("implicit_solution: a rotation as unknown is differentiated to third order") {
  for (const double p : {-0.4, 0.0, 0.3}) {
    const auto solved = implicit_function<3>(orientation{}, motion(p + 0.05), p);
    const auto expected = duet::derivatives<3>([](const auto& t) { return motion(t); }, p);
    const double sign = dot(solved[0], expected[0]) < 0 ? -1 : 1;
    for (std::size_t k = 0; k <= 3; ++k) {
      CHECK(norm(sign * solved[k] - expected[k]) <= 1e-14 * (1 + norm(expected[k])));
    }
    // The norm is 1 to every order: |q|² is constant.
    CHECK(std::abs(squared_norm(solved[0]) - 1) <= 1e-15);
    CHECK(std::abs(dot(solved[0], solved[1])) <= 1e-15);
    CHECK(std::abs(dot(solved[0], solved[2]) + squared_norm(solved[1])) <= 1e-13);
  }
}

TEST_CASE("implicit_solution: a tuple of number, rotation and vector as unknown") {
  const double p = 0.3;
  const std::tuple start(-1.0, motion(p + 0.02), Eigen::Vector2d(0, 0));
  const auto solved = implicit_function<2>(contact{}, start, p);
  const auto expected = duet::derivatives<2>(
      [](const auto& t) {
        const auto q = motion(t);
        const auto tip = rotate(q, vector3<double>(0.3, -0.2, 1));
        return std::tuple(-tip[2], q, duet::make_vector(tip[0], tip[0] * tip[1]));
      },
      p);
  for (std::size_t k = 0; k <= 2; ++k) {
    const auto& [height, q, slip] = solved[k];
    const auto& [exact_height, exact_q, exact_slip] = expected[k];
    const double tolerance = 1e-14 * (1 + norm(exact_q));
    CHECK(std::abs(height - exact_height) <= tolerance);
    CHECK(norm(q - exact_q) <= tolerance);
    CHECK((slip - exact_slip).norm() <= tolerance);
  }
}

TEST_CASE("implicit_solution: an orientation out of reach throws no_convergence") {
  const auto f = [](const auto& q, const auto& p) {
    const auto x = rotate(q, vector3<double>(1, 0, 0));
    return duet::make_vector(x[0] - p, x[1], x[2] * x[1]);
  };
  CHECK_THROWS_AS(
      static_cast<void>(implicit_function<1>(f, quaternion<double>(0.9, 0.1, 0.3, 0.3), 2.0)),
      duet::no_convergence);
}

} // namespace
} // namespace test_derivative_implicit_rotation
