// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/dual/eigen_traits.hpp>

#include <Eigen/SparseCholesky>

// Eigen's sparse solvers over dual numbers: they solve their systems with all derivatives.

namespace test_dual_eigen_sparse {

using duet::dual;

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

} // namespace test_dual_eigen_sparse
