// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/eigen_problems.hpp"
#include "support/test.hpp"

#include <Eigen/QR>

namespace test_dual_eigen_qr {
namespace {

using duet::dual, duet_test::check_solution, duet_test::linear_problem, duet_test::problems,
    duet_test::seeded, Eigen::Dynamic;

template <class Decomposition, int N>
void check_decomposition(const linear_problem& p) {
  CAPTURE(p.name);
  const Decomposition decomposition(seeded<dual<double>, N, N>(p.a, p.a_slope));
  check_solution(decomposition.solve(seeded<dual<double>, N, 1>(p.b, p.b_slope)).eval(), p);
}

template <int N>
using matrix = Eigen::Matrix<dual<double>, N, N>;

TEST_CASE_TEMPLATE("Eigen over dual: QR of dynamic size", Decomposition,
                   Eigen::HouseholderQR<matrix<Dynamic>>,
                   Eigen::ColPivHouseholderQR<matrix<Dynamic>>,
                   Eigen::FullPivHouseholderQR<matrix<Dynamic>>,
                   Eigen::CompleteOrthogonalDecomposition<matrix<Dynamic>>) {
  for (const int n : {1, 2, 3, 12}) {
    for (const auto& p : problems(n)) {
      check_decomposition<Decomposition, Dynamic>(p);
    }
  }
}

} // namespace
} // namespace test_dual_eigen_qr
