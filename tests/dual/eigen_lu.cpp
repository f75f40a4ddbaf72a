// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/eigen_problems.hpp"
#include "support/test.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace test_dual_eigen_lu {
namespace {

using duet::dual, duet_test::check_solution, duet_test::linear_problem, duet_test::problems,
    duet_test::random_problem, duet_test::seeded, Eigen::Dynamic;

template <int N>
using matrix = Eigen::Matrix<dual<double>, N, N>;

template <class Decomposition, int N>
void check_decomposition(const linear_problem& p) {
  CAPTURE(p.name);
  const Decomposition decomposition(seeded<dual<double>, N, N>(p.a, p.a_slope));
  check_solution(decomposition.solve(seeded<dual<double>, N, 1>(p.b, p.b_slope)).eval(), p);
}

TEST_CASE_TEMPLATE("Eigen over dual: LU of dynamic size", Decomposition,
                   Eigen::PartialPivLU<matrix<Dynamic>>, Eigen::FullPivLU<matrix<Dynamic>>) {
  for (const int n : {1, 2, 3, 12}) {
    for (const auto& p : problems(n)) {
      check_decomposition<Decomposition, Dynamic>(p);
    }
  }
}

TEST_CASE_TEMPLATE("Eigen over dual: Cholesky decompositions", Decomposition,
                   Eigen::LLT<matrix<Dynamic>>, Eigen::LDLT<matrix<Dynamic>>) {
  for (const int n : {1, 2, 3, 12}) {
    for (const auto& p : problems(n)) {
      if (p.positive) {
        check_decomposition<Decomposition, Dynamic>(p);
      }
    }
  }
}

TEST_CASE("Eigen over dual: solutions and inverses of fixed size") {
  for (const auto& p : problems(3)) {
    check_decomposition<Eigen::PartialPivLU<matrix<3>>, 3>(p);
    if (p.positive) {
      check_decomposition<Eigen::LLT<matrix<3>>, 3>(p);
    }
    const auto a = seeded<dual<double>, 3, 3>(p.a, p.a_slope);
    const auto b = seeded<dual<double>, 3, 1>(p.b, p.b_slope);
    check_solution((a.inverse() * b).eval(), p);
  }
}

TEST_CASE("Eigen over dual: several right-hand sides and systems larger than Eigen's blocks") {
  for (const int n : {2, 12, 50}) {
    for (const auto& p : problems(n)) {
      CAPTURE(p.name);
      const auto a = seeded<dual<double>, Dynamic, Dynamic>(p.a, p.a_slope);
      const auto b = seeded<dual<double>, Dynamic, 1>(p.b, p.b_slope);
      const Eigen::Matrix<dual<double>, Dynamic, Dynamic> columns = b.replicate(1, 3);
      check_solution(a.partialPivLu().solve(columns).col(2).eval(), p);
    }
  }
}

} // namespace
} // namespace test_dual_eigen_lu
