// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/eigen_problems.hpp"

#include <Eigen/QR>
#include <doctest/doctest.h>

namespace test_dual_eigen_reflectors {

using duet::dual;
using duet_test::check_solution;
using duet_test::problems;
using duet_test::seeded;
using Eigen::Dynamic;
using Eigen::MatrixXd;

namespace {

using dual_matrix = Eigen::Matrix<dual<double>, Dynamic, Dynamic>;

MatrixXd values(const dual_matrix& m) {
  return m.unaryExpr([](const auto& x) { return x.value(); });
}
MatrixXd slopes(const dual_matrix& m) {
  return m.unaryExpr([](const auto& x) { return x.epsilon(); });
}

} // namespace

TEST_CASE("Q R = A and QᵀQ = 1 with their derivatives") {
  for (const int n : {2, 3, 12}) {
    for (const auto& p : problems(n)) {
      CAPTURE(p.name);
      const auto a = seeded<dual<double>, Dynamic, Dynamic>(p.a, p.a_slope);
      const Eigen::HouseholderQR<dual_matrix> qr(a);
      const dual_matrix q = qr.householderQ();
      const dual_matrix r = qr.matrixQR().triangularView<Eigen::Upper>();
      const dual_matrix product = q * r;
      const dual_matrix identity = q.transpose() * q;
      const double tolerance = 1e-13 * (1 + p.a.norm() + p.a_slope.norm());
      CHECK((values(product) - p.a).norm() <= tolerance);
      CHECK((slopes(product) - p.a_slope).norm() <= tolerance);
      CHECK((values(identity) - MatrixXd::Identity(n, n)).norm() <= tolerance);
      CHECK(slopes(identity).norm() <= tolerance);
    }
  }
}

TEST_CASE("HouseholderQR has the values it has over double") {
  for (const int n : {2, 3, 12}) {
    const auto p = duet_test::random_problem(n, false);
    const auto a = seeded<dual<double>, Dynamic, Dynamic>(p.a, p.a_slope);
    const MatrixXd expected = p.a.householderQr().matrixQR();
    CHECK((values(a.householderQr().matrixQR()) - expected).norm() <= 1e-14 * expected.norm());
    // What stays triangular needs no reflectors.
    const MatrixXd upper = p.a.triangularView<Eigen::Upper>();
    const auto dual_upper = seeded<dual<double>, Dynamic, Dynamic>(upper, MatrixXd::Zero(n, n));
    CHECK(values(dual_upper.householderQr().matrixQR()) == upper);
  }
}

TEST_CASE("fixed sizes, several partials and right-hand sides") {
  for (const auto& p : problems(2)) {
    CAPTURE(p.name);
    const auto a = seeded<dual<double, 3>, 2, 2>(p.a, p.a_slope, 3);
    const auto b = seeded<dual<double, 3>, 2, 1>(p.b, p.b_slope, 3);
    const Eigen::Matrix<dual<double, 3>, 2, 2> columns = b.replicate(1, 2);
    check_solution(a.householderQr().solve(columns).col(1).eval(), p, 3);
  }
}

} // namespace test_dual_eigen_reflectors
