// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <type_traits>

// gradient, jacobian and hessian: vectors of every kind and size.

namespace test_derivative_vectors {

using duet::gradient;
using duet::hessian;
using duet::jacobian;

namespace {

/// Σ i xᵢ² + x₀ x_last
struct quadratic {
  template <class X>
  auto operator()(const X& x) const {
    const auto n = std::size_t(x.size());
    auto sum = x[0] * x[n - 1];
    for (std::size_t i = 0; i < n; ++i) {
      sum += double(i) * x[i] * x[i];
    }
    return sum;
  }
};

template <class X>
double expected_partial(const X& x, std::size_t i) {
  const auto n = std::size_t(x.size());
  double g = 2 * double(i) * x[i];
  g += i == 0 ? x[n - 1] : 0;
  g += i == n - 1 ? x[0] : 0;
  return g;
}

template <class X>
void check_gradient(const X& x) {
  const auto [y, g] = gradient(quadratic{}, x);
  CHECK(y == quadratic{}(x));
  REQUIRE(std::size_t(g.size()) == std::size_t(x.size()));
  for (std::size_t i = 0; i < std::size_t(x.size()); ++i) {
    CHECK(g[int(i)] == expected_partial(x, i));
  }
}

/// Neighbours multiplied, n − 1 rows.
struct products {
  template <class T, int N>
  auto operator()(const Eigen::Matrix<T, N, 1>& x) const {
    constexpr int rows = N == Eigen::Dynamic ? N : N - 1;
    Eigen::Matrix<T, rows, 1> y(x.size() - 1);
    for (Eigen::Index i = 0; i + 1 < x.size(); ++i) {
      y[i] = x[i] * x[i + 1];
    }
    return y;
  }
};

template <class X>
void check_jacobian(const X& x) {
  const auto [y, J] = jacobian(products{}, x);
  REQUIRE(J.rows() == x.size() - 1);
  REQUIRE(J.cols() == x.size());
  CHECK(y == products{}(x));
  for (int i = 0; i + 1 < x.size(); ++i) {
    for (int j = 0; j < x.size(); ++j) {
      CHECK(J(i, j) == (j == i ? x[i + 1] : j == i + 1 ? x[i] : 0));
    }
  }
}

template <int N>
void check_fixed_size() {
  Eigen::Matrix<double, N, 1> x;
  std::array<double, std::size_t(N)> a{};
  for (int i = 0; i < N; ++i) {
    x[i] = a[std::size_t(i)] = 1 + 0.5 * i;
  }
  check_gradient(x);
  check_gradient(a);
  if constexpr (N > 1) {
    check_jacobian(x);
  }
}

} // namespace

// Up to 32 components in one pass, beyond in several, the last of them not full.
TEST_CASE("sizes known at compile time") {
  check_fixed_size<1>();
  check_fixed_size<2>();
  check_fixed_size<3>();
  check_fixed_size<7>();
  check_fixed_size<8>();
  check_fixed_size<31>();
  check_fixed_size<32>();
  check_fixed_size<33>();
  check_fixed_size<40>();
}

TEST_CASE("sizes known at run time, 1 to 40") {
  for (int n = 1; n <= 40; ++n) {
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(n, 1, 1 + 0.5 * n);
    check_gradient(x);
    if (n > 1) {
      check_jacobian(x);
    }
  }
}

TEST_CASE("a vector without components is refused") {
  const Eigen::VectorXd none;
  CHECK_THROWS_WITH_AS(
      static_cast<void>(gradient(
          [](const auto& x) { return typename std::decay_t<decltype(x)>::Scalar(1); }, none)),
      "duet: gradient of a function of no variables", duet::invalid_input);
  CHECK_THROWS_WITH_AS(static_cast<void>(jacobian([](const auto& x) { return x; }, none)),
                       "duet: jacobian of a function of no variables", duet::invalid_input);
}

TEST_CASE("rows, expressions, maps, arrays and integers") {
  const Eigen::RowVector3d row(1, 2, 3);
  const auto [y, g] = gradient([](const auto& x) { return x[0] * x[1] + x[2]; }, row);
  static_assert(std::is_same_v<decltype(g), const Eigen::Vector3d>);
  CHECK(g == Eigen::Vector3d(2, 1, 1));

  const Eigen::Vector2d v(1, 2);
  CHECK(gradient([](const auto& x) { return x[0] * x[1]; }, 2 * v).gradient ==
        Eigen::Vector2d(4, 2));
  const double memory[] = {3, 4};
  CHECK(
      gradient([](const auto& x) { return x[0] * x[1]; }, Eigen::Map<const Eigen::Vector2d>(memory))
          .gradient == Eigen::Vector2d(4, 3));
  CHECK(gradient([](const auto& x) { return x[0] * x[1]; }, Eigen::Vector2i(5, 6)).gradient ==
        Eigen::Vector2d(6, 5));
  CHECK(gradient([](const auto& x) { return x[0] * x[1]; }, std::array{5, 6}).gradient ==
        Eigen::Vector2d(6, 5));

  const auto [z, J] = jacobian(
      [](const auto& x) {
        return std::array{x[0] * x[1], x[0] / 2, 0 * x[1]};
      },
      std::array{5, 6});
  static_assert(std::is_same_v<decltype(z), const std::array<double, 3>>);
  CHECK(z == std::array{30.0, 2.5, 0.0});
  Eigen::Matrix<double, 3, 2> expected;
  expected << 6, 5, 0.5, 0, 0, 0;
  CHECK(J == expected);
}

TEST_CASE("results of a size known at run time, from an argument of fixed size") {
  const auto f = [](const auto& x) {
    using T = std::decay_t<decltype(x[0])>;
    Eigen::Matrix<T, Eigen::Dynamic, 1> y(4);
    y << x[0], x[1], x[0] * x[1], T(1);
    return y;
  };
  const auto [y, J] = jacobian(f, Eigen::Vector2d(2, 3));
  CHECK(J.rows() == 4);
  CHECK(J.row(2) == Eigen::RowVector2d(3, 2));
  CHECK(J.row(3) == Eigen::RowVector2d(0, 0));
}

TEST_CASE("Hessians") {
  const auto f = [](const auto& x) { return exp(x[0] * x[1]) + x[1] * x[1] * x[2]; };
  const Eigen::Vector3d x(0.5, 0.7, -1.1);
  const auto [y, g, H] = hessian(f, x);
  const double e = std::exp(0.35);
  CHECK(y == doctest::Approx(e - 1.1 * 0.49).epsilon(1e-15));
  CHECK((g - Eigen::Vector3d(0.7 * e, 0.5 * e - 2.2 * 0.7, 0.49)).norm() <= 1e-15);
  Eigen::Matrix3d expected;
  expected << 0.49 * e, 1.35 * e, 0, 1.35 * e, 0.25 * e - 2.2, 1.4, 0, 1.4, 0;
  CHECK((H - expected).norm() <= 2e-15);
  CHECK(H == H.transpose());
  CHECK(hessian(quadratic{}, std::array{1, 2, 3, 4}).hessian.diagonal() ==
        Eigen::Vector4d(0, 2, 4, 6));
  const auto [z, gz, Hz] =
      hessian([](const auto& v) { return v[0] * v[0]; }, Eigen::Matrix<double, 1, 1>(3));
  CHECK(Hz(0, 0) == 2);
}

TEST_CASE("gradients in single precision") {
  const auto [y, g] = gradient([](const auto& x) { return x[0] * x[1]; }, Eigen::Vector2f(2, 3));
  static_assert(std::is_same_v<decltype(g), const Eigen::Vector2f>);
  CHECK(g == Eigen::Vector2f(3, 2));
}

} // namespace test_derivative_vectors
