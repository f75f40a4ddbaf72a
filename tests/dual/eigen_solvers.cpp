// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/eigen_problems.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SparseCholesky>

// Eigen's decompositions over dual numbers solve their systems with all derivatives.

namespace test_dual_eigen_solvers {
namespace {

using duet::dual, duet::taylor, duet_test::check_solution, duet_test::linear_problem,
    duet_test::problems, duet_test::seeded, Eigen::Dynamic, Eigen::MatrixXd;

struct outer_tag;

template <int N>
using matrix = Eigen::Matrix<dual<double>, N, N>;
template <class Decomposition>
constexpr bool is_cholesky = std::is_same_v<Decomposition, Eigen::LLT<matrix<Dynamic>>> ||
                             std::is_same_v<Decomposition, Eigen::LDLT<matrix<Dynamic>>> ||
                             std::is_same_v<Decomposition, Eigen::LLT<matrix<3>>>;

template <class Decomposition, int N>
void check_decomposition(const linear_problem& p) {
  if (is_cholesky<Decomposition> && !p.positive) {
    return;
  }
  CAPTURE(p.name);
  const Decomposition decomposition(seeded<dual<double>, N, N>(p.a, p.a_slope));
  check_solution(decomposition.solve(seeded<dual<double>, N, 1>(p.b, p.b_slope)).eval(), p);
}

TEST_CASE_TEMPLATE("Eigen over dual: decompositions of dynamic size", Decomposition,
                   Eigen::PartialPivLU<matrix<Dynamic>>, Eigen::FullPivLU<matrix<Dynamic>>,
                   Eigen::LLT<matrix<Dynamic>>, Eigen::LDLT<matrix<Dynamic>>,
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

TEST_CASE("Eigen over dual: solutions and inverses of fixed size") {
  for (const auto& p : problems(3)) {
    check_decomposition<Eigen::PartialPivLU<matrix<3>>, 3>(p);
    check_decomposition<Eigen::LLT<matrix<3>>, 3>(p);
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
      const matrix<Dynamic> columns = b.replicate(1, 3);
      check_solution(a.partialPivLu().solve(columns).col(2).eval(), p);
    }
  }
}

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

// A x″ = b″ − 2A′x′ − A″x
TEST_CASE("Eigen over dual: second derivatives of solutions by Taylor numbers and nested duals") {
  using series = taylor<double, 2>;
  using nested = dual<dual<double>, 1, outer_tag>;
  const auto as_series = [](double v, double s) { return series({v, s, 0}); };
  const auto as_nested = [](double v, double s) { return nested({v, s}, dual<double>(s)); };
  for (const int n : {1, 2, 4}) {
    for (const auto& p : problems(n)) {
      CAPTURE(p.name);
      const Eigen::VectorXd x = p.x();
      const Eigen::VectorXd first = p.x_slope();
      const Eigen::VectorXd second = p.a.fullPivLu().solve(-2 * p.a_slope * first);
      const double tolerance = 1e-11 * (1 + x.norm() + first.norm() + second.norm());
      const auto a = p.a.binaryExpr(p.a_slope, as_series).eval();
      const auto b = p.b.binaryExpr(p.b_slope, as_series).eval();
      const auto lu = a.partialPivLu().solve(b).eval();
      const auto qr = a.householderQr().solve(b).eval();
      const auto nested_a = p.a.binaryExpr(p.a_slope, as_nested).eval();
      const auto nested_b = p.b.binaryExpr(p.b_slope, as_nested).eval();
      const auto nested_qr = nested_a.householderQr().solve(nested_b).eval();
      for (int i = 0; i < n; ++i) {
        CHECK(std::abs(lu(i).value() - x(i)) <= tolerance);
        CHECK(std::abs(lu(i).derivative(1) - first(i)) <= tolerance);
        CHECK(std::abs(lu(i).derivative(2) - second(i)) <= tolerance);
        CHECK(std::abs(qr(i).derivative(1) - first(i)) <= tolerance);
        CHECK(std::abs(qr(i).derivative(2) - second(i)) <= tolerance);
        CHECK(std::abs(nested_qr(i).epsilon().value() - first(i)) <= tolerance);
        CHECK(std::abs(nested_qr(i).epsilon().epsilon() - second(i)) <= tolerance);
      }
    }
  }
}

TEST_CASE("Eigen over dual: sparse Cholesky solves with derivatives") {
  duet_test::random_source random(4);
  for (const Eigen::Index n : {2, 5, 12}) {
    // Tridiagonal and positive definite, every entry moving.
    Eigen::SparseMatrix<dual<double>> a(n, n);
    Eigen::Matrix<dual<double>, Eigen::Dynamic, 1> b(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      a.insert(i, i) = dual<double>(4 + random.unit(), random.uniform(-1, 1));
      b[i] = dual<double>(random.uniform(-1, 1), random.uniform(-1, 1));
      if (i > 0) {
        const dual<double> off_diagonal(random.uniform(-1, 1), random.uniform(-1, 1));
        a.insert(i, i - 1) = off_diagonal;
        a.insert(i - 1, i) = off_diagonal;
      }
    }
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<dual<double>>> ldlt(a);
    const Eigen::SimplicialLLT<Eigen::SparseMatrix<dual<double>>> llt(a);
    for (const auto& x : {Eigen::Matrix<dual<double>, Eigen::Dynamic, 1>(ldlt.solve(b)),
                          Eigen::Matrix<dual<double>, Eigen::Dynamic, 1>(llt.solve(b))}) {
      const auto residual = (a * x - b).eval();
      for (Eigen::Index i = 0; i < n; ++i) {
        CHECK(std::abs(residual[i].value()) < 1e-14);
        CHECK(std::abs(residual[i].epsilon()) < 1e-14);
      }
    }
  }
}

} // namespace
} // namespace test_dual_eigen_solvers
