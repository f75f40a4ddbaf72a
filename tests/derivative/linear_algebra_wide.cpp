// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/derivative/least_squares.hpp>
#include <duet/derivative/linear_solve.hpp>
#include <duet/derivative/symmetric_eigen.hpp>

// Systems, least squares and eigenvectors in 50 digits, and how far doubles are from that where the
// matrix is ill-conditioned.

namespace test_derivative_linear_algebra_wide {
namespace {

using duet::dual, Eigen::Dynamic, Eigen::MatrixXd;

// Every type of matrix that Eigen factorises takes seconds to compile: all are of dynamic size, and
// of the harder kind of 50 digits, that with expression templates.
using real_50 = duet_test::real_50_et;
template <class T>
using matrix = Eigen::Matrix<T, Dynamic, Dynamic>;
template <class T>
using vector = Eigen::Matrix<T, Dynamic, 1>;
using wide = matrix<real_50>;
using wide_dual = dual<real_50>;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

wide widened(const MatrixXd& m) {
  wide result(m.rows(), m.cols());
  for (int i = 0; i < m.size(); ++i) {
    result(i) = m(i);
  }
  return result;
}

template <class T>
matrix<dual<T>> moving(const MatrixXd& value, const MatrixXd& slope) {
  matrix<dual<T>> result(value.rows(), value.cols());
  for (int i = 0; i < value.size(); ++i) {
    result(i) = dual<T>(T(value(i)), T(slope(i)));
  }
  return result;
}

/// AᵀA
wide squares_of(const wide& a) {
  wide result = wide::Zero(a.cols(), a.cols());
  for (int i = 0; i < a.cols(); ++i) {
    for (int j = 0; j < a.cols(); ++j) {
      for (int k = 0; k < a.rows(); ++k) {
        result(i, j) += a(k, i) * a(k, j);
      }
    }
  }
  return result;
}

MatrixXd hilbert(int rows, int columns) {
  return MatrixXd::NullaryExpr(rows, columns,
                               [](auto i, auto j) { return 1.0 / double(i + j + 1); });
}

double condition(const MatrixXd& a) {
  const auto squares = duet::symmetric_eigen(squares_of(widened(a))).values;
  return double(real_50(sqrt(real_50(squares[squares.size() - 1] / squares[0]))));
}

MatrixXd draw(int rows, int columns, int seed) {
  duet_test::random_source random{std::uint64_t(seed)};
  return MatrixXd::NullaryExpr(rows, columns, [&] { return random.uniform(-1, 1); });
}

/// ‖computed − exact‖ / ‖exact‖ of values, then of slopes.
std::array<double, 2> relative_errors(const vector<dual<double>>& computed,
                                      const vector<wide_dual>& exact) {
  std::array<double, 2> result{};
  for (int k = 0; k < 2; ++k) {
    real_50 error = 0;
    real_50 norm = 0;
    for (int i = 0; i < exact.size(); ++i) {
      const real_50 reference = k == 0 ? exact(i).value() : exact(i).epsilon();
      const auto got = k == 0 ? computed(i).value() : computed(i).epsilon();
      error += pow(real_50(real_50(got) - reference), 2);
      norm += reference * reference;
    }
    result[std::size_t(k)] = double(real_50(sqrt(real_50(error / norm))));
  }
  return result;
}

// The condition reaches 1e13.
TEST_CASE("solve: Hilbert systems have errors below cond(A) ε / 10") {
  for (const int n : {2, 4, 6, 8, 10}) {
    CAPTURE(n);
    const MatrixXd a = hilbert(n, n);
    const MatrixXd a_slope = draw(n, n, n);
    const MatrixXd b = draw(n, 1, n + 100);
    const MatrixXd b_slope = draw(n, 1, n + 200);
    const vector<wide_dual> wide_b = moving<real_50>(b, b_slope);
    const auto exact = duet::solve(moving<real_50>(a, a_slope), wide_b);
    const vector<dual<double>> moving_b = moving<double>(b, b_slope);
    const auto computed = duet::solve(moving<double>(a, a_slope), moving_b);
    const auto errors = relative_errors(computed, exact);
    const double bound = condition(a) * epsilon / 10;
    CHECK(errors[0] <= bound);
    CHECK(errors[1] <= bound);
  }
}

// The residual of b brings the squared condition number into the error, but x is as much larger.
TEST_CASE("least_squares: Hilbert fits have errors below 2 cond(A) ε") {
  for (const int n : {2, 3, 4}) {
    CAPTURE(n);
    const MatrixXd a = hilbert(2 * n, n);
    const MatrixXd a_slope = draw(2 * n, n, n);
    const MatrixXd b = draw(2 * n, 1, n + 100);
    const MatrixXd b_slope = draw(2 * n, 1, n + 200);
    const vector<wide_dual> wide_b = moving<real_50>(b, b_slope);
    const auto exact = duet::least_squares(moving<real_50>(a, a_slope), wide_b);
    const vector<dual<double>> moving_b = moving<double>(b, b_slope);
    const auto computed = duet::least_squares(moving<double>(a, a_slope), moving_b);
    const auto errors = relative_errors(computed, exact);
    const double bound = 2 * condition(a) * epsilon;
    CHECK(errors[0] <= bound);
    CHECK(errors[1] <= bound);
  }
}

// Aᵀ(b − A x) = 0 by normal equations would lose the square of the condition here too.
TEST_CASE("least_squares: a fit with zero residual has errors below cond(A) ε / 10") {
  const int n = 6;
  const MatrixXd a = hilbert(2 * n, n);
  const MatrixXd none = MatrixXd::Zero(2 * n, n);
  const MatrixXd b = a.col(2);
  const MatrixXd b_slope = draw(2 * n, 1, 1);
  const vector<wide_dual> wide_b = moving<real_50>(b, b_slope);
  const auto exact = duet::least_squares(moving<real_50>(a, none), wide_b);
  const vector<dual<double>> moving_b = moving<double>(b, b_slope);
  const auto computed = duet::least_squares(a, moving_b);
  const auto errors = relative_errors(computed, exact);
  CHECK(errors[0] <= condition(a) * epsilon / 10);
  CHECK(errors[1] <= condition(a) * epsilon / 10);
}

TEST_CASE("symmetric_eigen: accurate if the smallest eigenvalue is 1e-9 of the largest") {
  const int n = 6;
  const MatrixXd a = hilbert(n, n);
  const MatrixXd half = draw(n, n, 3);
  const MatrixXd slope = half + half.transpose();
  const auto exact = duet::symmetric_eigen(moving<real_50>(a, slope));
  const auto computed = duet::symmetric_eigen(moving<double>(a, slope));
  for (int j = 0; j < n; ++j) {
    double max_abs_difference = 1;
    for (int i = 0; i < n; ++i) {
      if (i != j) {
        max_abs_difference =
            std::min(max_abs_difference,
                     double(abs(real_50(exact.values[i].value() - exact.values[j].value()))));
      }
    }
    const auto value_errors =
        relative_errors(computed.values.segment(j, 1), exact.values.segment(j, 1));
    const double sign =
        computed.vectors(0, j).value() * double(exact.vectors(0, j).value()) < 0 ? -1 : 1;
    const auto vector_errors =
        relative_errors(sign * computed.vectors.col(j), exact.vectors.col(j));
    CHECK(value_errors[1] <= 10 * epsilon / max_abs_difference);
    CHECK(vector_errors[0] <= 10 * epsilon / max_abs_difference);
    CHECK(vector_errors[1] <= 10 * epsilon / max_abs_difference);
  }
}

TEST_CASE("linear algebra: error messages print numbers of 50 digits") {
  const wide a = wide::Ones(2, 2);
  const vector<real_50> right = vector<real_50>::Ones(2);
  DUET_CHECK_REFUSED("duet: solve: A is singular: pivot 2 of 2 is only round-off: 0",
                     duet::solve(a, right));
  DUET_CHECK_REFUSED("duet: least_squares: A has rank 1, less than its 2 columns",
                     duet::least_squares(a, right));
  // These rows differ only in digits that doubles do not have.
  wide b = a;
  b(1, 1) += real_50(1e-30);
  CHECK(duet::solve(b, right).rows() == 2);
}

} // namespace
} // namespace test_derivative_linear_algebra_wide
