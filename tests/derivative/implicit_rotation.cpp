// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
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

// The angle of a crank a that carries a rod of length l to the height p, in 100 digits:
// a sin φ + √(l² − a² cos² φ) = p, and the rotation of the crank is exp(½ φ e_z).
TEST_CASE("implicit_solution: a crank agrees with 100 digits to third order") {
  using duet_test::real_100;
  static constexpr double a = 0.4, l = 1.1;
  const auto height = [](const auto& s, const auto& c) {
    using std::sqrt;
    return a * s + sqrt(l * l - a * a * c * c);
  };
  const double p = 1.25;
  const auto solved = implicit_function<3>(
      [&](const auto& q, const auto& goal) {
        const auto arm = rotate(q, vector3<double>(1, 0, 0));
        // Two residuals keep the axis, the third is the height.
        const auto axis = rotate(q, vector3<double>(0, 0, 1));
        return duet::make_vector(axis[0], axis[1], height(arm[1], arm[0]) - goal);
      },
      duet::from_axis_angle(vector3<double>(0, 0, 1), 0.3), p);
  const auto angle = [&](const real_100& goal) {
    real_100 x = 0.5;
    for (int i = 0; i < 200; ++i) { // the secant through nearby points, by hand
      const auto f = [&](const real_100& y) {
        return real_100(
            real_100(a) * sin(y) +
            sqrt(real_100(l) * real_100(l) - real_100(a) * real_100(a) * cos(y) * cos(y)) - goal);
      };
      const real_100 h("1e-45");
      const real_100 step = f(x) * h / (f(x + h) - f(x));
      x -= step;
      if (abs(step) < real_100("1e-95")) {
        break;
      }
    }
    return x;
  };
  const auto check = [&](const auto& component, const auto& exact_of) {
    for (int k = 0; k <= 3; ++k) {
      const real_100 exact = duet_test::central_difference(
          [&](const real_100& goal) { return real_100(exact_of(real_100(angle(goal) / 2))); }, p, k,
          0.1);
      const double error = double(abs(real_100(component(solved[std::size_t(k)]) - exact)));
      CHECK(error <= 1e-14 * (1 + std::abs(double(exact))));
    }
  };
  check([](const auto& q) { return q.w(); }, [](const real_100& x) { return real_100(cos(x)); });
  check([](const auto& q) { return q.z(); }, [](const real_100& x) { return real_100(sin(x)); });
  for (const auto& q : solved) {
    CHECK(std::abs(q.x()) + std::abs(q.y()) <= 1e-14);
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
