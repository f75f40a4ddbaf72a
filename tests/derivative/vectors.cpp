// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/identical.hpp"
#include "support/test.hpp"

#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>

#include <Eigen/LU>

// gradient, jacobian and hessian: vectors of every kind and size.

namespace test_derivative_vectors {
namespace {

using duet::gradient, duet::hessian, duet::jacobian;

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
  CHECK(std::abs(y - quadratic{}(x)) <= duet_test::if_fused(1e-15 * double(x.size()) * y));
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

// Up to 32 components in one pass, beyond in several, the last of them not full.
TEST_CASE("gradient, jacobian and hessian: the point may be given in braces") {
  const auto f = [](const auto& x) { return x[0] * x[0] * x[1]; };
  static_assert(std::is_same_v<decltype(gradient(f, {3, 2.0}).gradient), Eigen::Vector2d>);
  CHECK(gradient(f, {3, 2.0}).gradient == Eigen::Vector2d(12, 9));
  CHECK(gradient([](const auto& x) { return x[0] * x[0]; }, {3.0}).gradient[0] == 6);
  const auto single = gradient(f, Eigen::Vector2f(3, 2)).gradient;
  static_assert(std::is_same_v<decltype(single), const Eigen::Vector2f>);
  CHECK(single == Eigen::Vector2f(12, 9));
  CHECK(hessian(f, {3, 2.0}).hessian == (Eigen::Matrix2d() << 4, 6, 6, 0).finished());
  const auto g = [&](const auto& x) { return std::array{f(x), x[1] * x[1]}; };
  CHECK(jacobian(g, {3, 2.0}).jacobian == (Eigen::Matrix2d() << 12, 9, 0, 4).finished());
}

TEST_CASE("gradient and jacobian: sizes known at compile time") {
  check_fixed_size<1>();
  check_fixed_size<2>();
  check_fixed_size<7>();
  check_fixed_size<32>();
  check_fixed_size<33>();
  check_fixed_size<40>();
}

TEST_CASE("gradient and jacobian: sizes from 1 to 40 known at run time") {
  for (int n = 1; n <= 40; ++n) {
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(n, 1, 1 + 0.5 * n);
    check_gradient(x);
    if (n > 1) {
      check_jacobian(x);
    }
  }
}

TEST_CASE("gradient and jacobian: a vector without components throws invalid_input") {
  const Eigen::VectorXd none;
  DUET_CHECK_REFUSED(
      "duet: gradient: the function has no variables",
      gradient([](const auto& x) { return typename std::decay_t<decltype(x)>::Scalar(1); }, none));
  DUET_CHECK_REFUSED("duet: jacobian: the function has no variables",
                     jacobian([](const auto& x) { return x; }, none));
}

TEST_CASE("gradient and jacobian: rows, expressions, maps, arrays and integers as arguments") {
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

TEST_CASE("gradient and jacobian: blocks, references and matrix entries inside the function") {
  Eigen::VectorXd x(4);
  x << 2, 3, 5, 7;
  const Eigen::MatrixXd m = x * x.transpose();
  const auto f = [](const auto& v) { return v[0] * v[1]; };
  const auto check = [&](const auto& at, double first, double second) {
    CHECK(gradient(f, at).gradient.head(2) == Eigen::Vector2d(second, first));
    CHECK(hessian(f, at).hessian(0, 1) == 1);
    CHECK(jacobian([](const auto& v) { return v; }, at).jacobian(1, 1) == 1);
  };
  check(x.head(2), 2, 3);
  check(x.segment<2>(1), 3, 5);
  check(x.tail<2>(), 5, 7);
  check(m.col(1), 6, 9);
  check(m.row(2).head<2>(), 10, 15);
  check(Eigen::Ref<const Eigen::VectorXd>(x), 2, 3);
  check(Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 8, 1>(x), 2, 3);
  const Eigen::Matrix2d a{{1, 2}, {3, 4}};
  const auto determinant = [](const auto& v) { return v.reshaped(2, 2).eval().determinant(); };
  CHECK(gradient(determinant, a.reshaped()).gradient == Eigen::Vector4d(4, -2, -3, 1));
}

TEST_CASE("jacobian: result of a size known at run time, argument of fixed size") {
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

TEST_CASE("hessian: values, gradient and matrix equal the closed form") {
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

/// Σ sin(x_i) x_j x_j over all i < j: no second derivative is zero.
struct all_pairs {
  template <class X>
  auto operator()(const X& x) const {
    using std::sin;
    auto sum = 0.0 * x[0];
    for (std::size_t j = 1; j < std::size_t(x.size()); ++j) {
      for (std::size_t i = 0; i < j; ++i) {
        sum += sin(x[i]) * x[j] * x[j];
      }
    }
    return sum;
  }
};

template <class X>
void check_hessian(const X& x) {
  const auto n = Eigen::Index(x.size());
  const auto [y, g, H] = hessian(all_pairs{}, x);
  REQUIRE(H.rows() == n);
  REQUIRE(H.cols() == n);
  CHECK(y == doctest::Approx(all_pairs{}(x)).epsilon(1e-14));
  const auto expected = gradient(all_pairs{}, x).gradient;
  for (Eigen::Index i = 0; i < n; ++i) {
    CHECK(g[i] == doctest::Approx(expected[i]).epsilon(1e-13));
    for (Eigen::Index j = 0; j <= i; ++j) {
      const auto xi = x[std::size_t(i)], xj = x[std::size_t(j)];
      double second = 2 * std::cos(xj) * xi;
      if (i == j) {
        second = 0;
        for (Eigen::Index k = 0; k < n; ++k) {
          const double xk = x[std::size_t(k)];
          second += k < i ? 2 * std::sin(xk) : k > i ? -std::sin(xi) * xk * xk : 0.0;
        }
      }
      CHECK(H(i, j) == doctest::Approx(second).epsilon(1e-13));
      CHECK(H(j, i) == H(i, j));
    }
  }
}

template <int N>
void check_fixed_hessian() {
  const Eigen::Matrix<double, N, 1> x = Eigen::Matrix<double, N, 1>::LinSpaced(N, 0.3, 1.9);
  check_hessian(x);
}

TEST_CASE("hessian: any size in blocks of eight equals the closed form") {
  for (const int n : {1, 2, 7, 8, 9, 16, 17, 40}) {
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(n, 0.3, 1.9);
    check_hessian(x);
    check_hessian(std::vector<double>(x.begin(), x.end()));
  }
  check_fixed_hessian<32>();
  check_fixed_hessian<33>();
  DUET_CHECK_REFUSED("duet: hessian: the function has no variables",
                     hessian(quadratic{}, std::vector<double>{}));
}

TEST_CASE("hessian: evaluates the function once per pair of blocks") {
  int calls = 0;
  const auto counted = [&calls](const auto& x) {
    ++calls;
    return all_pairs{}(x);
  };
  static_cast<void>(hessian(counted, Eigen::Matrix<double, 32, 1>::Ones().eval()));
  CHECK(calls == 1);
  calls = 0;
  static_cast<void>(hessian(counted, Eigen::VectorXd::Ones(17).eval()));
  CHECK(calls == 6); // three blocks, six pairs of them
}

TEST_CASE("gradient and jacobian: standard vectors as arguments and results") {
  const std::vector<double> x{1, 2, 3};
  const auto squares = [](const auto& v) {
    auto result = v;
    for (auto& each : result) {
      each *= each;
    }
    return result;
  };
  const auto [y, J] = jacobian(squares, x);
  static_assert(std::is_same_v<decltype(y), const std::vector<double>>);
  CHECK(y == std::vector<double>{1, 4, 9});
  CHECK(J == Eigen::Matrix3d(Eigen::Vector3d(2, 4, 6).asDiagonal()));
  CHECK(gradient(quadratic{}, std::vector{1, 2}).gradient == Eigen::Vector2d(2, 5));

  const auto moved = duet::directional_derivative(squares, x, std::vector<double>{1, 0, -1});
  CHECK(moved.derivative == std::vector<double>{2, 0, -6});
}

TEST_CASE("gradient, jacobian and hessian: functions of several arguments") {
  const auto f = [](const auto& x, const auto& k, const auto& list) {
    return k * x[0] * x[1] + k * k * list[2];
  };
  const std::tuple at(Eigen::Vector2d(2, 3), 5, std::vector<double>{7, 8, 9});
  const auto [y, g] = gradient(f, at);
  CHECK(y == 255);
  REQUIRE(g.size() == 6);
  CHECK(g == (Eigen::VectorXd(6) << 15, 10, 96, 0, 0, 25).finished());
  const auto H = hessian(f, at).hessian;
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(6, 6);
  expected(0, 1) = expected(1, 0) = 5;
  expected(0, 2) = expected(2, 0) = 3;
  expected(1, 2) = expected(2, 1) = 2;
  expected(2, 2) = 18;
  expected(2, 5) = expected(5, 2) = 10;
  CHECK(H == expected);

  // Of sizes known at compile time so is the result; a tuple may be taken as one argument.
  const auto of_tuple = [](const auto& both) {
    const auto& [x, k] = both;
    return (x * k).eval();
  };
  const auto [product, J] = jacobian(of_tuple, std::tuple(Eigen::Vector2d(2, 3), 5.0));
  static_assert(std::is_same_v<decltype(J), const Eigen::Matrix<double, 2, 3>>);
  CHECK(product == Eigen::Vector2d(10, 15));
  CHECK(J == (Eigen::Matrix<double, 2, 3>() << 5, 0, 2, 0, 5, 3).finished());

  const auto direction = std::tuple(Eigen::Vector2d(1, 0), 1.0, std::vector<double>{0, 0, 1});
  CHECK(duet::directional_derivative(f, at, direction).derivative == 15 + 96 + 25);
  CHECK(duet::hessian_vector_product(f, at, direction).product ==
        expected.col(0) + expected.col(2) + expected.col(5));
}

} // namespace
} // namespace test_derivative_vectors
