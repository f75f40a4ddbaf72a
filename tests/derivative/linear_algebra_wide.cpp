// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual/eigen_problems.hpp"
#include "support/multiprecision.hpp"

#include <duet/derivative/least_squares.hpp>
#include <duet/derivative/linear_solve.hpp>
#include <duet/derivative/symmetric_eigen.hpp>

#include <Eigen/SVD>
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

// Systems, least squares and eigenvectors in 50 digits, and how far doubles are from that where the
// matrix is ill-conditioned.

using duet::dual;
using duet::taylor;
using duet_test::real_50;
using duet_test::seeded;
using Eigen::Dynamic;
using Eigen::MatrixXd;

namespace {

using wide = Eigen::Matrix<real_50, Dynamic, Dynamic>;
using wide_dual = dual<real_50>;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

wide widened(const MatrixXd& m) {
  return m.unaryExpr([](double x) { return real_50(x); });
}

auto widened(const MatrixXd& value, const MatrixXd& slope) {
  const auto make = [](double v, double s) { return wide_dual(real_50(v), real_50(s)); };
  return value.binaryExpr(slope, make).eval();
}

MatrixXd hilbert(int rows, int columns) {
  return MatrixXd::NullaryExpr(rows, columns,
                               [](auto i, auto j) { return 1.0 / double(i + j + 1); });
}

double condition(const MatrixXd& a) {
  const auto singular = Eigen::JacobiSVD<MatrixXd>(a).singularValues().eval();
  return singular[0] / singular[singular.size() - 1];
}

MatrixXd draw(int rows, int columns, int seed) {
  duet_test::random_source random{std::uint64_t(seed)};
  return MatrixXd::NullaryExpr(rows, columns, [&] { return random.uniform(-1, 1); });
}

/// ‖computed − exact‖ / ‖exact‖ of values, then of slopes.
template <class X, class W>
std::array<double, 2> relative_errors(const X& computed, const W& exact) {
  std::array<double, 2> result{};
  for (int k = 0; k < 2; ++k) {
    real_50 error = 0;
    real_50 norm = 0;
    for (int i = 0; i < exact.size(); ++i) {
      const real_50 truth = k == 0 ? exact(i).value() : exact(i).epsilon();
      const auto got = k == 0 ? computed(i).value() : computed(i).epsilon();
      error += pow(real_50(real_50(got) - truth), 2);
      norm += truth * truth;
    }
    result[std::size_t(k)] = double(real_50(sqrt(real_50(error / norm))));
  }
  return result;
}

} // namespace

// The condition reaches 1e13.
TEST_CASE("Hilbert systems: errors below cond(A) ε / 10") {
  for (const int n : {2, 4, 6, 8, 10}) {
    CAPTURE(n);
    const MatrixXd a = hilbert(n, n);
    const MatrixXd a_slope = draw(n, n, n);
    const MatrixXd b = draw(n, 1, n + 100);
    const MatrixXd b_slope = draw(n, 1, n + 200);
    const auto exact = duet::solve(widened(a, a_slope), widened(b, b_slope));
    // In 50 digits it is the closed form A⁻¹(b′ − A′x).
    const auto lu = widened(a).partialPivLu();
    const wide x = lu.solve(widened(b));
    const wide slope = lu.solve(widened(b_slope) - widened(a_slope) * x);
    for (int i = 0; i < n; ++i) {
      CHECK(exact(i).value() == x(i));
      CHECK(abs(real_50(exact(i).epsilon() - slope(i))) <= 1e-35 * slope.norm());
    }
    const auto computed = duet::solve(seeded<dual<double>, Dynamic, Dynamic>(a, a_slope),
                                      seeded<dual<double>, Dynamic, 1>(b, b_slope));
    const auto errors = relative_errors(computed, exact);
    const double bound = condition(a) * epsilon / 10;
    CHECK(errors[0] <= bound);
    CHECK(errors[1] <= bound);
  }
}

// What is left of b brings the square of the condition into the error, but x is as much larger.
TEST_CASE("Hilbert fits: errors below 2 cond(A) ε") {
  for (const int n : {2, 3, 4}) {
    CAPTURE(n);
    const MatrixXd a = hilbert(2 * n, n);
    const MatrixXd a_slope = draw(2 * n, n, n);
    const MatrixXd b = draw(2 * n, 1, n + 100);
    const MatrixXd b_slope = draw(2 * n, 1, n + 200);
    const auto exact = duet::least_squares(widened(a, a_slope), widened(b, b_slope));
    const wide wide_a = widened(a);
    const wide wide_slope = widened(a_slope);
    const auto lu = wide(wide_a.transpose() * wide_a).partialPivLu();
    const wide x = lu.solve(wide_a.transpose() * widened(b));
    const wide slope = lu.solve(wide_slope.transpose() * (widened(b) - wide_a * x) +
                                wide_a.transpose() * (widened(b_slope) - wide_slope * x));
    for (int i = 0; i < n; ++i) {
      CHECK(abs(real_50(exact(i).value() - x(i))) <= 1e-35 * x.norm());
      CHECK(abs(real_50(exact(i).epsilon() - slope(i))) <= 1e-35 * slope.norm());
    }
    const auto computed = duet::least_squares(seeded<dual<double>, Dynamic, Dynamic>(a, a_slope),
                                              seeded<dual<double>, Dynamic, 1>(b, b_slope));
    const auto errors = relative_errors(computed, exact);
    const double bound = 2 * condition(a) * epsilon;
    CHECK(errors[0] <= bound);
    CHECK(errors[1] <= bound);
  }
}

// Aᵀ(b − A x) = 0 by normal equations would lose the square of the condition here too.
TEST_CASE("a fit that leaves nothing of b: errors below cond(A) ε / 10") {
  const int n = 6;
  const MatrixXd a = hilbert(2 * n, n);
  const MatrixXd none = MatrixXd::Zero(2 * n, n);
  const MatrixXd b = a.col(2);
  const MatrixXd b_slope = draw(2 * n, 1, 1);
  const auto exact = duet::least_squares(widened(a, none), widened(b, b_slope));
  const auto computed = duet::least_squares(a, seeded<dual<double>, Dynamic, 1>(b, b_slope));
  const auto errors = relative_errors(computed, exact);
  CHECK(errors[0] <= condition(a) * epsilon / 10);
  CHECK(errors[1] <= condition(a) * epsilon / 10);
}

TEST_CASE("eigenvalues and eigenvectors, the smallest 1e-9 of the largest") {
  const int n = 6;
  const MatrixXd a = hilbert(n, n);
  const MatrixXd half = draw(n, n, 3);
  const MatrixXd slope = half + half.transpose();
  const auto exact = duet::symmetric_eigen(widened(a, slope));
  const auto computed = duet::symmetric_eigen(seeded<dual<double>, Dynamic, Dynamic>(a, slope));
  for (int j = 0; j < n; ++j) {
    // By 50 digits: λ′ = vᵀA′v
    const wide v = exact.vectors.col(j).unaryExpr([](const auto& x) { return x.value(); });
    const real_50 rate = (v.transpose() * widened(slope) * v)(0, 0);
    CHECK(abs(real_50(exact.values[j].epsilon() - rate)) <= 1e-38);
    double gap = 1;
    for (int i = 0; i < n; ++i) {
      if (i != j) {
        gap =
            std::min(gap, double(abs(real_50(exact.values[i].value() - exact.values[j].value()))));
      }
    }
    const auto value_errors =
        relative_errors(computed.values.segment(j, 1).eval(), exact.values.segment(j, 1).eval());
    const auto vector_errors = relative_errors(
        (computed.vectors.col(j) * (computed.vectors(0, j).value() * double(v(0)) < 0 ? -1.0 : 1.0))
            .eval(),
        exact.vectors.col(j).eval());
    CHECK(value_errors[1] <= 10 * epsilon / gap);
    CHECK(vector_errors[0] <= 10 * epsilon / gap);
    CHECK(vector_errors[1] <= 10 * epsilon / gap);
  }
}

TEST_CASE("second order: Taylor numbers in 50 digits, and with expression templates") {
  const auto check = [](auto zero) {
    using R = decltype(zero);
    using series = taylor<R, 2>;
    const series t = series::variable(R(2));
    Eigen::Matrix<series, 2, 2> a;
    a << t, series(R(0)), series(R(1)), t * t;
    const Eigen::Matrix<series, 2, 1> b(series(R(1)), t);
    const auto close = [](const R& x, const R& y) { return abs(R(x - y)) <= 1e-45; };
    // x₀ = 1/t, x₁ = (t − 1/t)/t²
    const auto x = duet::solve(a, b);
    const auto y = duet::least_squares(a, b);
    const series exact = (t - 1 / t) / (t * t);
    // λ of the symmetric matrix with this lower triangle
    const auto e = duet::symmetric_eigen(a);
    const series root = sqrt((t - t * t) * (t - t * t) + 4);
    for (int k = 0; k <= 2; ++k) {
      CHECK(close(x[0].coefficient(k), series(1 / t).coefficient(k)));
      CHECK(close(x[1].coefficient(k), exact.coefficient(k)));
      CHECK(close(y[1].coefficient(k), exact.coefficient(k)));
      CHECK(close(e.values[1].coefficient(k), series((t + t * t + root) / 2).coefficient(k)));
    }
  };
  check(real_50(0));
  check(duet_test::real_50_et(0));
}

TEST_CASE("messages with numbers of 50 digits") {
  const wide a = wide::Ones(2, 2);
  CHECK_THROWS_WITH_AS(
      static_cast<void>(duet::solve(a, a)),
      "duet: solve: A is singular: of pivot 2 of 2 nothing but rounding remains, 0",
      duet::invalid_input);
  CHECK_THROWS_WITH_AS(static_cast<void>(duet::least_squares(a, a)),
                       "duet: least_squares: A has rank 1, less than its 2 columns",
                       duet::invalid_input);
  // More digits than doubles have tell these rows apart.
  wide b = a;
  b(1, 1) += real_50(1e-30);
  CHECK(duet::solve(b, a).rows() == 2);
}
