// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/eigen_problems.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <Eigen/QR>

namespace test_dual_eigen_least_squares {

using duet::dual, duet_test::check_solution, duet_test::linear_problem, duet_test::seeded,
    Eigen::Dynamic, Eigen::MatrixXd;

TEST_CASE("Eigen over dual: least squares satisfy AᵀA x = Aᵀb with derivatives") {
  duet_test::random_source random(5);
  const auto draw = [&](int rows, int columns) -> MatrixXd {
    return MatrixXd::NullaryExpr(rows, columns, [&] { return random.uniform(-1, 1); });
  };
  for (const bool triangular : {false, true}) {
    MatrixXd a = draw(6, 3);
    const MatrixXd a_slope = draw(6, 3);
    if (triangular) {
      a = MatrixXd(a.triangularView<Eigen::Upper>());
    }
    const MatrixXd b = draw(6, 1);
    const MatrixXd b_slope = draw(6, 1);
    linear_problem normal;
    normal.a = a.transpose() * a;
    normal.a_slope = a_slope.transpose() * a + a.transpose() * a_slope;
    normal.b = a.transpose() * b;
    normal.b_slope = a_slope.transpose() * b + a.transpose() * b_slope;
    const auto dual_a = seeded<dual<double>, Dynamic, Dynamic>(a, a_slope);
    const auto dual_b = seeded<dual<double>, Dynamic, 1>(b, b_slope);
    check_solution(dual_a.householderQr().solve(dual_b).eval(), normal);
    check_solution(dual_a.colPivHouseholderQr().solve(dual_b).eval(), normal);
  }
}

} // namespace test_dual_eigen_least_squares
