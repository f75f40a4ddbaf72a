// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/derivative/implicit_function.hpp>
#include <duet/derivative/jacobian.hpp>

// Differentiation inside differentiated functions: no level may confuse another's infinitesimal
// with its own.

namespace test_derivative_nesting {
namespace {

using duet::derivative, duet::derivatives;

template <class X>
struct plus {
  X x;
  template <class Y>
  auto operator()(const Y& y) const {
    return x + y;
  }
};
struct times_slope_of_sum {
  template <class X>
  auto operator()(const X& x) const {
    return x * derivative(plus<X>{x}, 1.0).derivative;
  }
};

// d/dx (x · d/dy (x + y)|₁)|₁ = 1, not 2.
TEST_CASE("nested derivatives: perturbations are not confused") {
  const auto f = [](auto x) {
    return x * derivative([x](auto y) { return x + y; }, 1.0).derivative;
  };
  CHECK(derivative(f, 1.0).derivative == 1);
  const auto by_reference = [](const auto& x) {
    return x * derivative([&](const auto& y) { return x + y; }, 1.0).derivative;
  };
  CHECK(derivative(by_reference, 1.0).derivative == 1);
  CHECK(derivative(times_slope_of_sum{}, 1.0).derivative == 1);
  CHECK(derivatives<1>(f, 1.0)[1] == 1);
}

TEST_CASE("nested derivatives: an inner function may capture the outer variable or not") {
  // d/dx (x² · d/dy (x y²)|₃) = d/dx 6x³ = 18x²
  const auto captured = [](auto x) {
    return x * x * derivative([x](auto y) { return x * y * y; }, 3.0).derivative;
  };
  CHECK(derivative(captured, 2.0).derivative == 72);
  // d/dx (d/dy y³|ₓ) = 6x: the inner variable starts from the outer one.
  const auto at_x = [](auto x) {
    return derivative([](auto y) { return y * y * y; }, x).derivative;
  };
  CHECK(derivative(at_x, 2.0).derivative == 12);
  // d/dx (d/dy (x y³)|ₓ) = d/dx 3x³ = 9x²
  const auto both = [](auto x) {
    return derivative([x](auto y) { return x * y * y * y; }, x).derivative;
  };
  CHECK(derivative(both, 2.0).derivative == 36);
  // Two inner derivatives side by side.
  const auto two = [](auto x) {
    const auto a = derivative([x](auto y) { return x * y; }, 1.0).derivative;
    const auto b = derivative([x](auto z) { return x * x * z; }, 1.0).derivative;
    return a * b; // x³
  };
  CHECK(derivative(two, 2.0).derivative == 12);
}

TEST_CASE("nested derivatives: three levels give the product rule's result") {
  // x · d/dy (y x · d/dz (x y z)|₁)|₁ = x · d/dy (x² y²)|₁ = 2x³
  const auto f = [](auto x) {
    return x * derivative(
                   [x](auto y) {
                     return y * x *
                            derivative([x, y](auto z) { return x * y * z; }, 1.0).derivative;
                   },
                   1.0)
                   .derivative;
  };
  CHECK(derivative(f, 2.0).derivative == 24);
  CHECK(derivatives<3>(f, 2.0) == std::array{16.0, 24.0, 24.0, 12.0});
}

TEST_CASE("nested derivatives: gradient inside a derivative and derivative inside a gradient") {
  // |∇(x y₀ + y₁²)|² at y = (1, x) is x² + 4x²
  const auto f = [](auto x) {
    using T = decltype(x);
    const Eigen::Matrix<T, 2, 1> y(T(1), x);
    return duet::gradient([x](const auto& v) { return x * v[0] + v[1] * v[1]; }, y)
        .gradient.squaredNorm();
  };
  CHECK(derivative(f, 3.0).value == 45);
  CHECK(derivative(f, 3.0).derivative == 30);
  // ∂/∂v (d/dt (v₀ t² + v₁ t)|₂) = (4, 1)
  const auto g = [](const auto& v) {
    return derivative([&](const auto& t) { return v[0] * t * t + v[1] * t; }, 2.0).derivative;
  };
  CHECK(duet::gradient(g, Eigen::Vector2d(5, 6)).gradient == Eigen::Vector2d(4, 1));
  CHECK(duet::gradient(g, Eigen::VectorXd(Eigen::Vector2d(5, 6))).gradient ==
        Eigen::Vector2d(4, 1));
}

TEST_CASE("nested derivatives: the Jacobian of a gradient is the Hessian") {
  const auto f = [](const auto& x) { return sin(x[0]) * x[1] * x[1]; };
  const auto slope = [&](const auto& x) { return duet::gradient(f, x).gradient; };
  const Eigen::Vector2d x(0.4, 1.5);
  const Eigen::Matrix2d H = duet::hessian(f, x).hessian;
  CHECK((duet::jacobian(slope, x).jacobian - H).norm() <= 1e-15);
  // A Hessian inside a derivative.
  const auto trace = [](const auto& t) {
    using T = std::decay_t<decltype(t)>;
    return duet::hessian([&](const auto& v) { return t * v[0] * v[0] * v[1]; },
                         Eigen::Matrix<T, 2, 1>(T(1), t))
        .hessian.trace();
  };
  CHECK(derivative(trace, 3.0).derivative == 12); // 2t²
}

TEST_CASE(
    "nested derivatives: an implicit solution inside a derivative may capture the outer variable") {
  // y³ + y = x, so y′ = 1/(3y² + 1).
  const auto f = [](auto x) {
    return duet::implicit_solution([x](const auto& y, double) { return y * y * y + y - x; }, 1.0,
                                   0.0);
  };
  const auto [y, dy] = derivative(f, 10.0);
  CHECK(y == doctest::Approx(2).epsilon(1e-15));
  CHECK(dy == doctest::Approx(1.0 / 13).epsilon(1e-15));
  // And a derivative inside the equation: ∂/∂z (z² y) at z = y, i.e. 2y², equals x.
  const auto g = [](auto x) {
    return duet::implicit_solution(
        [x](const auto& z, double) {
          return derivative([&](const auto& w) { return w * w * z; }, z).derivative - x;
        },
        1.0, 0.0);
  };
  const auto ys = derivatives<2>(g, 8.0); // √(x/2)
  CHECK(ys[0] == doctest::Approx(2).epsilon(1e-15));
  CHECK(ys[1] == doctest::Approx(0.125).epsilon(1e-15));
  CHECK(ys[2] == doctest::Approx(-1.0 / 128).epsilon(1e-15));
}

TEST_CASE("nested derivatives: a user-defined tag separates two differentiations of one function") {
  struct inner;
  const auto cube = [](const auto& y) { return y * y * y; };
  const auto f = [&](const auto& x) { return derivative<inner>(cube, x).derivative; };
  CHECK(derivative(f, 2.0).derivative == 12);
  // Without it the levels are distinct as well, being of different functions.
  const auto g = [&](const auto& x) { return derivative(cube, x).derivative; };
  CHECK(derivative(g, 2.0).derivative == 12);
}

} // namespace
} // namespace test_derivative_nesting
