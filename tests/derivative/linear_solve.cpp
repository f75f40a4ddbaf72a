// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual/eigen_problems.hpp"

#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/linear_solve.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <type_traits>

// x with A x = b: values to the last bit, derivatives against closed forms and elimination over
// duals.

using duet::dual;
using duet::solve;
using duet::taylor;
using duet_test::linear_problem;
using duet_test::problems;
using duet_test::seeded;
using Eigen::Dynamic;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

struct outer_tag;

template <class X>
MatrixXd values_of(const X& x) {
  return x.unaryExpr([](const auto& s) { return double(duet::innermost(s)); });
}

template <int N>
void check(const linear_problem& p) {
  CAPTURE(p.name);
  CAPTURE(p.a.rows());
  using D = dual<double, 3>;
  const auto a = seeded<D, N, N>(p.a, p.a_slope, 3);
  const auto b = seeded<D, N, 1>(p.b, p.b_slope, 3);
  const auto x = solve(a, b);
  static_assert(std::is_same_v<decltype(x), const Eigen::Matrix<D, N, 1>>);
  check_solution(x, p, 3);
  const Eigen::Matrix<double, N, N> real_a = p.a;
  const Eigen::Matrix<double, N, 1> real_b = p.b;
  CHECK(values_of(x) == real_a.partialPivLu().solve(real_b));
  CHECK(solve(real_a, real_b) == real_a.partialPivLu().solve(real_b));
}

MatrixXd hilbert(int n) {
  return MatrixXd::NullaryExpr(n, n, [](auto i, auto j) { return 1.0 / double(i + j + 1); });
}

template <class A, class B>
std::string message(const A& a, const B& b) {
  try {
    static_cast<void>(solve(a, b));
  } catch (const duet::invalid_input& e) {
    return e.what();
  }
  return "";
}

} // namespace

TEST_CASE("fixed sizes: Eigen's values, and the derivatives A⁻¹(b′ − A′x)") {
  const auto all = [](auto size) {
    for (const auto& p : problems(size())) {
      check<size()>(p);
    }
  };
  all(std::integral_constant<int, 2>());
  all(std::integral_constant<int, 3>());
}

TEST_CASE("dynamic sizes") {
  for (int n = 1; n <= 12; ++n) {
    for (const auto& p : problems(n)) {
      check<Dynamic>(p);
    }
  }
}

TEST_CASE("elimination over duals gives the same") {
  for (const auto& p : problems(12)) {
    CAPTURE(p.name);
    const auto a = seeded<dual<double>, Dynamic, Dynamic>(p.a, p.a_slope);
    const auto b = seeded<dual<double>, Dynamic, 1>(p.b, p.b_slope);
    const auto x = solve(a, b);
    const auto unrolled = a.fullPivLu().solve(b).eval();
    for (int i = 0; i < 12; ++i) {
      CHECK(std::abs(x[i].epsilon() - unrolled[i].epsilon()) <=
            1e-12 * (1 + p.x().norm() + p.x_slope().norm()));
    }
  }
}

// A x‴ = −3A′x″, A x″ = b″ − 2A′x′ with A″ = 0, b″ = 0.
TEST_CASE("higher orders, by Taylor numbers and nested duals") {
  using series = taylor<double, 3>;
  using nested = dual<dual<double>, 1, outer_tag>;
  for (const int n : {1, 2, 4, 12}) {
    for (const auto& p : problems(n)) {
      CAPTURE(p.name);
      const auto lu = p.a.fullPivLu();
      const VectorXd exact[] = {p.x(), p.x_slope(), lu.solve(-2 * p.a_slope * p.x_slope()),
                                lu.solve(-3 * p.a_slope * lu.solve(-2 * p.a_slope * p.x_slope()))};
      double size = 1;
      const auto as_series = [](double v, double d) { return series({v, d, 0, 0}); };
      const auto as_nested = [](double v, double d) { return nested({v, d}, dual<double>(d)); };
      const auto a = p.a.binaryExpr(p.a_slope, as_series);
      const auto b = p.b.binaryExpr(p.b_slope, as_series);
      const auto nested_a = p.a.binaryExpr(p.a_slope, as_nested);
      const auto nested_b = p.b.binaryExpr(p.b_slope, as_nested);
      const auto x = solve(a, b);
      const auto y = solve(nested_a, nested_b);
      for (int k = 0; k <= 3; ++k) {
        size += exact[k].norm();
        for (int i = 0; i < n; ++i) {
          CHECK(std::abs(x(i, 0).derivative(k) - exact[k][i]) <= 1e-12 * size);
        }
      }
      for (int i = 0; i < n; ++i) {
        CHECK(y(i, 0).value().value() == x(i, 0).value());
        CHECK(std::abs(y(i, 0).value().epsilon() - exact[1][i]) <= 1e-12 * size);
        CHECK(std::abs(y(i, 0).epsilon().value() - exact[1][i]) <= 1e-12 * size);
        CHECK(std::abs(y(i, 0).epsilon().epsilon() - exact[2][i]) <= 1e-12 * size);
      }
    }
  }
}

TEST_CASE("scalars and shapes of A and b may differ") {
  const linear_problem p = duet_test::random_problem(3, false);
  using D = dual<double>;
  const Eigen::Matrix3d real_a = p.a;
  const Eigen::Vector3d real_b = p.b;
  const auto a = seeded<D, 3, 3, Eigen::RowMajor>(p.a, p.a_slope);
  const auto b = seeded<D, Dynamic, 1>(p.b, p.b_slope);
  linear_problem only_a = p;
  only_a.b_slope.setZero();
  linear_problem only_b = p;
  only_b.a_slope.setZero();
  const auto by_a = solve(a, real_b);
  const auto by_b = solve(real_a, b);
  static_assert(std::is_same_v<decltype(by_b), const Eigen::Matrix<D, 3, 1>>);
  check_solution(by_a, only_a);
  check_solution(by_b, only_b);
  check_solution(solve(a.transpose().transpose(), b + 0 * b), p);

  // Two levels meet: the mixed derivative is −A⁻¹A′A⁻¹b′.
  using E = dual<double, 1, outer_tag>;
  const auto mixed = solve(a, seeded<E, 3, 1>(p.b, p.b_slope));
  const VectorXd cross = -p.a.fullPivLu().solve(p.a_slope * p.a.fullPivLu().solve(p.b_slope));
  for (int i = 0; i < 3; ++i) {
    const auto& inner = duet::detail::part<outer_tag>(mixed[i], 1);
    CHECK(std::abs(duet::detail::part<duet::derivative_tag<>>(inner, 1) - cross[i]) <= 1e-13);
  }

  // Several right-hand sides, and the inverse.
  const auto columns = solve(a, b.replicate(1, 3));
  check_solution(columns.col(2).eval(), p);
  const MatrixXd inverse = p.a.inverse();
  const MatrixXd inverse_slope = -inverse * p.a_slope * inverse;
  const auto x = solve(a, Eigen::Matrix3d::Identity());
  for (int k = 0; k < 9; ++k) {
    CHECK(std::abs(x(k).epsilon() - inverse_slope(k)) <= 1e-13 * inverse_slope.norm());
  }

  CHECK(solve(Eigen::Matrix2i{{2, 0}, {0, 4}}, Eigen::Vector2i(1, 1)) ==
        Eigen::Vector2d(0.5, 0.25));
  CHECK(solve(Eigen::Matrix2f{{2, 1}, {0, 4}}, Eigen::Vector2f(1, 1)) ==
        Eigen::Vector2f(0.375F, 0.25F));
  const auto l = solve(Eigen::Matrix<dual<long double>, 1, 1>(dual<long double>(4, 1)),
                       Eigen::Matrix<double, 1, 2>(2, 8));
  CHECK(l(0, 1).value() == 2);
  CHECK(l(0, 1).epsilon() == -0.5L);
}

TEST_CASE("inside a differentiated function") {
  const auto f = [](const auto& p) {
    using T = std::decay_t<decltype(p[0])>;
    Eigen::Matrix<T, 2, 2> a;
    a << p[0], p[1], p[1], 3.0;
    return solve(a, Eigen::Vector2d(1, 2));
  };
  const auto [x, J] = duet::jacobian(f, Eigen::Vector2d(2, 1)); // x = (3 − 2q, 2p − q)/(3p − q²)
  CHECK((x - Eigen::Vector2d(0.2, 0.6)).norm() <= 1e-16);
  const Eigen::Matrix2d expected{{-0.12, -0.32}, {0.04, 0.04}};
  CHECK((J - expected).norm() <= 1e-15);
}

TEST_CASE("what does not depend on a variable has zero partials") {
  using D = dual<double, 2>;
  const linear_problem p = duet_test::random_problem(5, false);
  const MatrixXd none = MatrixXd::Zero(5, 5);
  const auto constant = solve(seeded<D, 5, 5>(p.a, none), seeded<D, 5, 1>(p.b, none.col(0)));
  auto a = seeded<D, 5, 5>(p.a, none);
  a(1, 2) = D::variable(p.a(1, 2), 1);
  const auto one = solve(a, seeded<D, 5, 1>(p.b, none.col(0)));
  for (int i = 0; i < 5; ++i) {
    CHECK(constant[i].partial(0) == 0);
    CHECK(constant[i].partial(1) == 0);
    CHECK(one[i].partial(0) == 0);
    CHECK(one[i].partial(1) != 0);
  }
  // Nor are they poisoned by what is infinite.
  const auto infinite = solve(Eigen::Matrix<D, 1, 1>(D(2)),
                              Eigen::Matrix<double, 1, 1>(std::numeric_limits<double>::infinity()));
  CHECK(infinite[0].value() == std::numeric_limits<double>::infinity());
  CHECK(infinite[0].partial(0) == 0);
}

// Rows and columns differ by 200 orders of magnitude.
TEST_CASE("units do not matter") {
  const linear_problem p = duet_test::random_problem(3, false);
  const VectorXd rows = Eigen::Vector3d(0x1p300, 1, 0x1p-300);
  const VectorXd columns = Eigen::Vector3d(0x1p-30, 0x1p40, 1);
  linear_problem scaled = p;
  scaled.a = rows.asDiagonal() * p.a * columns.asDiagonal();
  scaled.a_slope = rows.asDiagonal() * p.a_slope * columns.asDiagonal();
  scaled.b = rows.asDiagonal() * p.b;
  scaled.b_slope = rows.asDiagonal() * p.b_slope;
  const auto x = solve(seeded<dual<double>, 3, 3>(scaled.a, scaled.a_slope),
                       seeded<dual<double>, 3, 1>(scaled.b, scaled.b_slope));
  for (int i = 0; i < 3; ++i) {
    CHECK(columns[i] * x[i].value() == doctest::Approx(p.x()[i]).epsilon(1e-13));
    CHECK(columns[i] * x[i].epsilon() == doctest::Approx(p.x_slope()[i]).epsilon(1e-13));
  }
  const Eigen::Matrix2d tiny{{0x1p-500, 0}, {0, 0x1p-500}};
  CHECK(message(tiny, Eigen::Vector2d(1, 1)) == "");
}

TEST_CASE("what cannot be solved is refused") {
  const VectorXd b = VectorXd::Ones(3);
  CHECK(message(MatrixXd(3, 2), b) == "duet: solve: A is 3 x 2, but must be square");
  CHECK(message(MatrixXd(0, 0), VectorXd(0)) == "duet: solve: A is empty");
  CHECK(message(MatrixXd(2, 2), b) == "duet: solve: A has 2 rows, but b 3");
  MatrixXd a{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  CHECK(message(a, b).find("duet: solve: A is singular: of pivot 3 of 3 nothing but rounding "
                           "remains, ") == 0);
  a.col(1).setZero();
  CHECK(message(a, b) ==
        "duet: solve: A is singular: of pivot 2 of 3 nothing but rounding remains, 0");
  CHECK(message(a.cast<dual<float>>(), b) ==
        "duet: solve: A is singular: of pivot 2 of 3 nothing but rounding remains, 0");
  a(2, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK(message(a, b) == "duet: solve: entry (2, 1) of A is not finite");
  // Nearly singular is another thing.
  CHECK(message(hilbert(12), VectorXd::Ones(12)) == "");
}
