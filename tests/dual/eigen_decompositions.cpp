// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/identical.hpp"
#include "support/random.hpp"

#include <duet/dual/eigen_traits.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <Eigen/SparseCholesky>
#include <doctest/doctest.h>

#include <cmath>

// Eigen's iterative decompositions over dual numbers, on dense matrices, against the closed forms
// of their derivatives. (Where off-diagonal entries vanish they lose derivatives, see
// dual/eigen_solvers.hpp; duet::symmetric_eigen does not.)

namespace test_dual_eigen_decompositions {

using duet::dual;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

template <class D, int Size>
using matrix = Eigen::Matrix<D, Size, Size>;

MatrixXd random_matrix(duet_test::random_source& random, Eigen::Index n) {
  MatrixXd a(n, n);
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    a(i) = random.uniform(-1, 1);
  }
  return a;
}

template <int Size>
matrix<dual<double>, Size> moving(const MatrixXd& a, const MatrixXd& rate) {
  matrix<dual<double>, Size> m(a.rows(), a.cols());
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    m(i) = dual<double>(a(i), rate(i));
  }
  return m;
}

/// dσ = uᵀ dA v
void check_singular_values(const MatrixXd& a, const MatrixXd& rate) {
  const auto m = moving<Eigen::Dynamic>(a, rate);
  const Eigen::JacobiSVD<matrix<dual<double>, Eigen::Dynamic>> svd(m);
  const Eigen::JacobiSVD<MatrixXd> plain(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const double expected = plain.matrixU().col(i).dot(rate * plain.matrixV().col(i));
    CHECK(std::abs(svd.singularValues()[i].value() - plain.singularValues()[i]) < 1e-14 * 12);
    CHECK(std::abs(svd.singularValues()[i].epsilon() - expected) < 1e-11);
  }
}

/// dλ = vᵀ dA v, and A v = λ v with vᵀ v = 1 including the derivatives.
template <int Size>
void check_symmetric(const MatrixXd& a, const MatrixXd& rate) {
  const MatrixXd symmetric = a + a.transpose();
  const MatrixXd symmetric_rate = rate + rate.transpose();
  const auto m = moving<Size>(symmetric, symmetric_rate);
  const Eigen::SelfAdjointEigenSolver<matrix<dual<double>, Size>> solver(m);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> plain(symmetric);
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const VectorXd v = plain.eigenvectors().col(i);
    CHECK(std::abs(solver.eigenvalues()[i].value() - plain.eigenvalues()[i]) < 1e-13);
    CHECK(std::abs(solver.eigenvalues()[i].epsilon() - v.dot(symmetric_rate * v)) < 1e-11);
    const auto& w = solver.eigenvectors();
    dual<double> square = 0;
    for (Eigen::Index k = 0; k < a.rows(); ++k) {
      dual<double> residual = -solver.eigenvalues()[i] * w(k, i);
      for (Eigen::Index l = 0; l < a.rows(); ++l) {
        residual += m(k, l) * w(l, i);
      }
      CHECK(std::abs(residual.value()) < 1e-13);
      CHECK(std::abs(residual.epsilon()) < 1e-10);
      square += w(k, i) * w(k, i);
    }
    CHECK(std::abs(square.epsilon()) < 1e-11);
  }
}

} // namespace

TEST_CASE("singular values") {
  duet_test::random_source random(1);
  for (const Eigen::Index n : {2, 3, 5, 8, 12}) {
    const MatrixXd a = random_matrix(random, n);
    const MatrixXd rate = random_matrix(random, n);
    check_singular_values(a, rate);
  }
}

TEST_CASE("symmetric eigenvalues and eigenvectors") {
  duet_test::random_source random(2);
  for (const Eigen::Index n : {2, 3, 5, 8, 12}) {
    const MatrixXd a = random_matrix(random, n);
    const MatrixXd rate = random_matrix(random, n);
    check_symmetric<Eigen::Dynamic>(a, rate);
    if (n == 3) {
      check_symmetric<3>(a, rate);
    }
  }
}

// The QR iteration stops as soon as the values have converged; the derivatives are one step behind,
// which docs/dual_numbers.md says.
TEST_CASE("eigenvalues of a general matrix: their sums of powers are traces") {
  duet_test::random_source random(3);
  for (const Eigen::Index n : {2, 3, 5, 8, 12}) {
    const auto m = moving<Eigen::Dynamic>(random_matrix(random, n), random_matrix(random, n));
    const Eigen::EigenSolver<matrix<dual<double>, Eigen::Dynamic>> solver(m, false);
    dual<double> sum = 0;
    dual<double> sum_of_squares = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto lambda = solver.eigenvalues()[i];
      sum += lambda.real();
      sum_of_squares += lambda.real() * lambda.real() - lambda.imag() * lambda.imag();
    }
    const auto trace = m.trace();
    const auto trace_of_square = m.lazyProduct(m).trace();
    CHECK(std::abs((sum - trace).value()) < 1e-12);
    const double behind = 1e-3 + duet_test::if_fused(3e-3);
    CHECK(std::abs((sum - trace).epsilon()) < behind);
    CHECK(std::abs((sum_of_squares - trace_of_square).value()) < 1e-12);
    CHECK(std::abs((sum_of_squares - trace_of_square).epsilon()) < behind);
  }
}

TEST_CASE("sparse Cholesky") {
  duet_test::random_source random(4);
  for (const Eigen::Index n : {2, 5, 12}) {
    // Tridiagonal and positive definite, every entry moving.
    Eigen::SparseMatrix<dual<double>> a(n, n);
    Eigen::Matrix<dual<double>, Eigen::Dynamic, 1> b(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      a.insert(i, i) = dual<double>(4 + random.unit(), random.uniform(-1, 1));
      b[i] = dual<double>(random.uniform(-1, 1), random.uniform(-1, 1));
      if (i > 0) {
        const dual<double> beside(random.uniform(-1, 1), random.uniform(-1, 1));
        a.insert(i, i - 1) = beside;
        a.insert(i - 1, i) = beside;
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

} // namespace test_dual_eigen_decompositions
