// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/multiprecision.hpp"
#include "support/test.hpp"

#include <duet/derivative/implicit_function.hpp>
#include <duet/derivative/jacobian.hpp>

// x(p) with F(x, p) = 0: values and derivatives of scalars, vectors and tuples, against closed
// forms and wide arithmetic.

namespace test_derivative_implicit_function {
namespace {

using duet::implicit_function, duet_test::real_100;

/// Kepler's equation E − e sin E = M: no closed form, and singular as e → 1.
struct kepler {
  double eccentricity;
  template <class X, class P>
  auto operator()(const X& anomaly, const P& mean) const {
    using std::sin;
    return anomaly - eccentricity * sin(anomaly) - mean;
  }
};

/// In 100 digits, by Newton's method with the derivative by hand.
real_100 wide_kepler(double eccentricity, const real_100& mean) {
  real_100 x = mean + eccentricity;
  for (int i = 0; i < 30; ++i) {
    x -= (x - eccentricity * sin(x) - mean) / (1 - eccentricity * cos(x));
  }
  return x;
}

TEST_CASE(
    "implicit_solution: a scalar unknown has the closed-form derivatives of the square root") {
  const auto f = [](const auto& x, const auto& p) { return x * x - p; };
  for (const double p : {1e-8, 0.3, 1.0, 2.0, 1e8}) {
    const auto x = implicit_function<3>(f, 1.0, p);
    const double root = std::sqrt(p);
    CHECK(x[0] == doctest::Approx(root).epsilon(2e-16));
    CHECK(x[1] == doctest::Approx(0.5 / root).epsilon(5e-16));
    CHECK(x[2] == doctest::Approx(-0.25 / (root * p)).epsilon(1e-15));
    CHECK(x[3] == doctest::Approx(0.375 / (root * p * p)).epsilon(2e-15));
  }
}

TEST_CASE("implicit_solution: Kepler's equation agrees with 100 digits to third order") {
  for (const double e : {0.0, 0.1, 0.7, 0.95}) {
    for (const double mean : {0.05, 0.5, 2.0, 3.0}) {
      const auto x = implicit_function<3>(kepler{e}, mean, mean);
      for (int k = 0; k <= 3; ++k) {
        const real_100 exact = duet_test::central_difference(
            [&](const real_100& m) { return wide_kepler(e, m); }, mean, k, 0.01);
        const auto error = double(abs(real_100(x[std::size_t(k)] - exact)));
        CHECK(error <= 1e-14 * (1 + std::abs(double(exact))));
      }
    }
  }
}

TEST_CASE("implicit_solution: residuals may be a scalar, an array, a fixed or a dynamic vector") {
  const auto scalar = [](const auto& x, const auto& p) { return x * x * x - p; };
  const auto array = [](const auto& x, const auto& p) { return std::array{x * x * x - p}; };
  const auto fixed = [](const auto& x, const auto& p) { return duet::make_vector(x * x * x - p); };
  const auto dynamic = [](const auto& x, const auto& p) {
    using T = std::decay_t<decltype(x * p)>;
    Eigen::Matrix<T, Eigen::Dynamic, 1> r(1);
    r[0] = x * x * x - p;
    return r;
  };
  CHECK(implicit_function<1>(scalar, 1.0, 8.0)[1] == doctest::Approx(1.0 / 12).epsilon(1e-15));
  CHECK(implicit_function<1>(array, 1.0, 8.0)[1] == doctest::Approx(1.0 / 12).epsilon(1e-15));
  CHECK(implicit_function<1>(fixed, 1.0, 8.0)[1] == doctest::Approx(1.0 / 12).epsilon(1e-15));
  CHECK(implicit_function<1>(dynamic, 1.0, 8.0)[1] == doctest::Approx(1.0 / 12).epsilon(1e-15));
  // Integers as start and parameter.
  CHECK(implicit_function<1>(scalar, 1, 8)[1] == doctest::Approx(1.0 / 12).epsilon(1e-15));
  const auto wrong = [](const auto& x, const auto& p) {
    using T = std::decay_t<decltype(x * p)>;
    return Eigen::Matrix<T, Eigen::Dynamic, 1>(Eigen::Matrix<T, Eigen::Dynamic, 1>::Zero(2));
  };
  DUET_CHECK_REFUSED("duet: implicit_function: F returned 2 residuals for an unknown of 1 "
                     "coordinates",
                     implicit_function<1>(wrong, 1.0, 8.0));
}

// The intersection of the circle of radius p with the line y = 2x: x = p/√5.
TEST_CASE("implicit_solution: vector and tuple unknowns have closed-form derivatives") {
  const auto by_vector = implicit_function<2>(
      [](const auto& x, const auto& p) {
        return duet::make_vector(x[0] * x[0] + x[1] * x[1] - p * p, x[1] - 2 * x[0]);
      },
      Eigen::Vector2d(1, 1), 3.0);
  static_assert(std::is_same_v<decltype(by_vector), const std::array<Eigen::Vector2d, 3>>);
  const Eigen::Vector2d direction = Eigen::Vector2d(1, 2) / std::sqrt(5.0);
  CHECK((by_vector[0] - 3 * direction).norm() <= 1e-15);
  CHECK((by_vector[1] - direction).norm() <= 1e-15);
  CHECK(by_vector[2].norm() <= 1e-15);

  const auto by_tuple = implicit_function<2>(
      [](const auto& unknown, const auto& p) {
        const auto& [x, v] = unknown;
        return duet::make_vector(x * x + v[0] * v[0] - p * p, v[0] - 2 * x, v[1] - x * v[0]);
      },
      std::tuple(1.0, Eigen::Vector2d(1, 1)), 3.0);
  CHECK(std::get<0>(by_tuple[1]) == doctest::Approx(direction[0]).epsilon(1e-15));
  CHECK(std::get<1>(by_tuple[0])[1] == doctest::Approx(18.0 / 5).epsilon(1e-15));
  CHECK(std::get<1>(by_tuple[2])[1] == doctest::Approx(4.0 / 5).epsilon(1e-15));
}

// The residuals differ by 24 orders of magnitude, and so do the unknowns.
TEST_CASE("implicit_solution: the solution does not depend on units") {
  for (const double unit : {1e-12, 1e-9, 1.0, 1e9}) {
    const auto x = implicit_function<1>(
        [=](const auto& v, const auto& p) {
          return duet::make_vector(1e12 * (v[0] * v[0] * v[0] - p * unit * unit * unit),
                                   1e-12 * (v[1] * v[0] - unit * unit));
        },
        Eigen::Vector2d(3 * unit, 7 * unit), 8.0);
    CHECK(x[0][0] == doctest::Approx(2 * unit).epsilon(1e-14).scale(unit));
    CHECK(x[0][1] == doctest::Approx(unit / 2).epsilon(1e-14).scale(unit));
    CHECK(x[1][0] == doctest::Approx(unit / 12).epsilon(1e-14).scale(unit));
  }
}

TEST_CASE("implicit_solution: converges to 0 despite round-off, in all units") {
  for (const double unit : {1e-30, 1.0, 1e20, 1e30, 1e100}) {
    CAPTURE(unit);
    const Eigen::Vector2d start(unit, unit / 2);
    const auto sum = implicit_function<1>( // below round-off of 0.3 the residual is that of v₁ only
        [=](const auto& v, const auto& p) {
          return duet::make_vector(sin(v[0] / unit + .3) - std::sin(.3) + (p - 3) + v[1] / unit,
                                   (v[1] - v[0]) / unit);
        },
        start, 3.0);
    CHECK(sum[0].norm() <= 1e-15 * unit);
    CHECK(sum[1][0] / unit == doctest::Approx(-1 / (1 + std::cos(.3))).epsilon(1e-14));
    const auto cubic = implicit_function<1>(
        [=](const auto& v, const auto& p) {
          const auto w = v[0] / unit, z = v[1] / unit;
          return duet::make_vector(exp(w) - (p - 2) + z / 10, z * z * z + z - .3 * w);
        },
        start, 3.0);
    CHECK(cubic[0].norm() <= 1e-15 * unit);
    CHECK(cubic[1][0] / unit == doctest::Approx(1 / 1.03).epsilon(1e-14));
  }
}

TEST_CASE("implicit_solution: converges from a distant initial guess at which full steps fail") {
  const auto arctangent = [](const auto& x, const auto& p) { return atan(x) - p; };
  CHECK(implicit_function<1>(arctangent, 20.0, 0.3)[0] ==
        doctest::Approx(std::tan(0.3)).epsilon(1e-15));
  const auto exponential = [](const auto& x, const auto& p) { return exp(x) - p; };
  CHECK(implicit_function<1>(exponential, 30.0, 1.0)[0] == doctest::Approx(0).epsilon(1e-15));
  CHECK(implicit_function<1>(exponential, -5.0, 2.0)[1] == doctest::Approx(0.5).epsilon(1e-15));
}

TEST_CASE("implicit_solution: an initial guess at the solution stays there despite round-off") {
  const auto exact = [](const auto& x, const auto& p) { return x + p; };
  CHECK(implicit_function<1>(exact, 0.0, 0.0) == std::array{0.0, -1.0});
  const auto noisy = [](const auto& x, const auto& p) { return cos(x + 0.3) - p; };
  const double p = 0.9553364891256060; // cos 0.3, rounded
  const auto x = implicit_function<1>(noisy, 0.0, p);
  CHECK(std::abs(x[0]) <= 1e-15);
  CHECK(x[1] == doctest::Approx(-1 / std::sin(0.3)).epsilon(1e-14));
}

TEST_CASE("implicit_solution: parameters of any shape and captured variables are differentiated") {
  // Derivatives with respect to a vector of parameters, by a Jacobian around the solution.
  const auto solve = [](const auto& p) {
    return duet::implicit_solution(
        [](const auto& x, const auto& q) {
          return duet::make_vector(x[0] + x[1] - q[0], x[0] * x[1] - q[1]);
        },
        Eigen::Vector2d(0.5, 5), p);
  };
  const auto [x, J] = duet::jacobian(solve, Eigen::Vector2d(5, 6));
  // The Jacobian's condition number is 15: a rounding of the residual 6 moves x by up to 3e-15.
  CHECK((x - Eigen::Vector2d(2, 3)).norm() <= 4e-15);
  Eigen::Matrix2d expected; // x₀ is the smaller root of x² − p₀ x + p₁
  expected << -2, 1, 3, -1;
  CHECK((J - expected).norm() <= 4e-14);
}

TEST_CASE("implicit_solution: no solution or a singular one throws no_convergence") {
  const auto message = [](const auto& f, double start) {
    return duet_test::message_of<duet::no_convergence>(
        [&] { static_cast<void>(implicit_function<1>(f, start, 1.0)); });
  };
  const auto none = [](const auto& x, const auto& p) { return x * x + p; };
  CHECK(message(none, 3.0).find("duet: implicit_function: Newton's method") == 0);
  CHECK(message(none, 3.0).find("residual") != std::string::npos);
  CHECK(message([](const auto& x, const auto& p) { return 1 + p + 0.5 * sin(x); }, 1.0) != "");
  CHECK(message([](const auto& x, const auto& p) { return exp(x) * p; }, 1.0) != "");
  // A double root has no derivative.
  const auto twice = [](const auto& x, const auto& p) { return x * x * (1 + 0 * p); };
  CHECK(message(twice, 1.0) != "");
  CHECK_THROWS_AS((void)implicit_function<1>(twice, 1.0, 1.0, {.max_iterations = 500}),
                  duet::no_convergence);
  // Residuals that vanish but do not depend on x have no derivative either.
  const auto flat = [](const auto& x, const auto& p) { return 0 * x + p - 1; };
  CHECK(message(flat, 1.0).find("met a singular Jacobian") != std::string::npos);
  CHECK(message([](const auto& x, const auto& p) { return log(x - 5) + p; }, 1.0) != "");

  const auto dependent = [](const auto& x, const auto& p) {
    return duet::make_vector(x[0] + x[1] - p, 2 * x[0] + 2 * x[1] - 2 * p);
  };
  CHECK_THROWS_AS(static_cast<void>(implicit_function<1>(dependent, Eigen::Vector2d(1, 2), 5.0)),
                  duet::no_convergence);
  const auto slow = [](const auto& x, const auto& p) { return x * x * x - p; };
  CHECK_THROWS_AS(static_cast<void>(implicit_function<1>(slow, 1e9, 1.0, {.max_iterations = 5})),
                  duet::no_convergence);
}

} // namespace
} // namespace test_derivative_implicit_function
