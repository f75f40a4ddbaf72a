// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/eigen_problems.hpp"
#include "support/message.hpp"
#include "support/test.hpp"

#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/linear_solve.hpp>

#include <Eigen/LU>

// x with A x = b: values to the last bit, derivatives against closed forms and elimination over
// duals.

namespace test_derivative_linear_solve {
namespace {

using duet::dual, duet::solve, duet::taylor, duet_test::linear_problem, duet_test::problems,
    duet_test::seeded, Eigen::Dynamic, Eigen::MatrixXd, Eigen::VectorXd;

struct outer_tag;

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
  const Eigen::Matrix<double, N, 1> real_x = real_a.partialPivLu().solve(real_b).eval();
  CHECK((solve(real_a, real_b) == real_x));
  for (int i = 0; i < x.size(); ++i) {
    CHECK(x[i].value() == real_x[i]);
  }
}

MatrixXd hilbert(int n) {
  return MatrixXd::NullaryExpr(n, n, [](auto i, auto j) { return 1.0 / double(i + j + 1); });
}

template <class A, class B>
std::string message(const A& a, const B& b) {
  return duet_test::message_of([&] { static_cast<void>(solve(a, b)); });
}

// All fixed sizes here are 3: each size that Eigen factorises takes seconds to compile.
TEST_CASE("solve: fixed sizes give Eigen's values and the derivatives A⁻¹(b′ − A′x)") {
  for (const auto& p : problems(3)) {
    check<3>(p);
  }
}

TEST_CASE("solve: dynamic sizes give the same results") {
  for (int n = 1; n <= 12; ++n) {
    for (const auto& p : problems(n)) {
      check<Dynamic>(p);
    }
  }
}

// A x‴ = −3A′x″, A x″ = b″ − 2A′x′ with A″ = 0, b″ = 0.
TEST_CASE("solve: higher orders by Taylor numbers and nested duals") {
  using series = taylor<double, 3>;
  using nested = dual<dual<double>, 1, outer_tag>;
  for (const int n : {1, 2, 4, 12}) {
    for (const auto& p : problems(n)) {
      CAPTURE(p.name);
      VectorXd exact[] = {p.x(), p.x_slope(), {}, {}};
      exact[2] = -2 * p.solved(p.a_slope * exact[1]);
      exact[3] = -3 * p.solved(p.a_slope * exact[2]);
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

TEST_CASE("solve: scalars and shapes of A and b may differ") {
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
  const auto fixed_b = seeded<D, 3, 1>(p.b, p.b_slope);
  check_solution(solve(a.transpose().transpose(), fixed_b + 0 * fixed_b), p);

  // Two levels meet: the mixed derivative is −A⁻¹A′A⁻¹b′.
  using E = dual<double, 1, outer_tag>;
  const auto mixed = solve(a, seeded<E, 3, 1>(p.b, p.b_slope));
  const VectorXd cross = -p.solved(p.a_slope * p.solved(p.b_slope));
  for (int i = 0; i < 3; ++i) {
    const auto& inner = duet::detail::part<outer_tag>(mixed[i], 1);
    CHECK(std::abs(duet::detail::part<duet::derivative_tag<>>(inner, 1) - cross[i]) <= 1e-13);
  }

  // Several right-hand sides, and the inverse.
  const auto dynamic_a = seeded<D, Dynamic, Dynamic>(p.a, p.a_slope);
  const auto columns = solve(dynamic_a, b.replicate(1, 3));
  check_solution(columns.col(2), p);
  const auto x = solve(dynamic_a, MatrixXd::Identity(3, 3));
  for (int j = 0; j < 3; ++j) {
    const VectorXd inverse = p.solved(VectorXd::Unit(3, j));
    const VectorXd inverse_slope = -p.solved(p.a_slope * inverse);
    for (int i = 0; i < 3; ++i) {
      CHECK(std::abs(x(i, j).epsilon() - inverse_slope[i]) <= 1e-13 * inverse_slope.norm());
    }
  }

  const Eigen::Vector3d of_integers =
      solve(Eigen::Matrix3i{{2, 0, 0}, {0, 4, 0}, {0, 0, 1}}, Eigen::Vector3i(1, 1, 1));
  CHECK((of_integers == Eigen::Vector3d(0.5, 0.25, 1)));
  const Eigen::VectorXf of_floats =
      solve(Eigen::MatrixXf{{2, 1}, {0, 4}}, Eigen::VectorXf::Ones(2));
  CHECK((of_floats == Eigen::Vector2f(0.375F, 0.25F)));
  const auto l = solve(Eigen::Matrix<dual<long double>, 1, 1>(dual<long double>(4, 1)),
                       Eigen::Matrix<double, 1, 2>(2, 8));
  CHECK(l(0, 1).value() == 2);
  CHECK(l(0, 1).epsilon() == -0.5L);
}

TEST_CASE("solve: partials of variables without influence are zero") {
  using D = dual<double, 3>;
  const linear_problem p = duet_test::random_problem(3, false);
  const MatrixXd none = MatrixXd::Zero(3, 3);
  auto a = seeded<D, 3, 3>(p.a, none);
  const auto b = seeded<D, 3, 1>(p.b, none.col(0));
  const auto constant = solve(a, b);
  a(1, 2) = D::variable(p.a(1, 2), 1);
  const auto one = solve(a, b);
  for (int i = 0; i < 3; ++i) {
    CHECK(constant[i].partial(0) == 0);
    CHECK(constant[i].partial(1) == 0);
    CHECK(one[i].partial(0) == 0);
    CHECK(one[i].partial(1) != 0);
  }
  // Zero partials stay zero next to infinite entries.
  const double infinity = std::numeric_limits<double>::infinity();
  const Eigen::Matrix<D, Dynamic, Dynamic> two{{D(2)}};
  const Eigen::Matrix<D, Dynamic, 1> infinite_b{{D(infinity)}};
  const auto infinite = solve(two, infinite_b);
  CHECK(infinite[0].value() == infinity);
  CHECK(infinite[0].partial(0) == 0);
}

// Rows and columns differ by 200 orders of magnitude.
TEST_CASE("solve: solvability does not depend on units") {
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
  const MatrixXd tiny = 0x1p-500 * MatrixXd::Identity(2, 2);
  CHECK(message(tiny, VectorXd::Ones(2).eval()) == "");
}

TEST_CASE("solve: singular or invalid systems throw invalid_input") {
  const VectorXd b = VectorXd::Ones(3);
  CHECK(message(MatrixXd(3, 2), b) == "duet: solve: A is 3 x 2, but must be square");
  CHECK(message(MatrixXd(0, 0), VectorXd(0)) == "duet: solve: A is empty");
  CHECK(message(MatrixXd(2, 2), b) == "duet: solve: A has 2 rows, but b 3");
  MatrixXd a{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  CHECK(message(a, b).find("duet: solve: A is singular: pivot 3 of 3 is only round-off: ") == 0);
  a.col(1).setZero();
  CHECK(message(a, b) == "duet: solve: A is singular: pivot 2 of 3 is only round-off: 0");
  CHECK(message(a.cast<dual<float>>(), b) ==
        "duet: solve: A is singular: pivot 2 of 3 is only round-off: 0");
  a(2, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK(message(a, b) == "duet: solve: entry (2, 1) of A is not finite");
  // A nearly singular matrix is solved.
  CHECK(message(hilbert(12), VectorXd::Ones(12).eval()) == "");
}

} // namespace
} // namespace test_derivative_linear_solve
