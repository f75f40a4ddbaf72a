// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/Jacobi>

#include <cmath>
#include <complex>

/// \file
/// Orthonormal columns, and eigenvectors of small complex matrices.

namespace duet::detail {

/// Of up to twelve rows.
using small_square =
    Eigen::Matrix<std::complex<double>, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 12, 12>;

/// Eigenvalues and unit eigenvectors, by Eigen's Schur decomposition. (Its ComplexEigenSolver took
/// g++ twelve seconds to compile: it makes the matrix one of Hessenberg's by blocks of reflections,
/// this by Givens rotations.)
struct complex_eigenvectors {
  Eigen::Matrix<std::complex<double>, Eigen::Dynamic, 1, Eigen::ColMajor, 12, 1> values;
  small_square vectors;

  explicit complex_eigenvectors(small_square a) {
    const Eigen::Index n = a.rows();
    small_square turns = small_square::Identity(n, n);
    for (Eigen::Index k = 0; k + 2 < n; ++k) {
      for (Eigen::Index i = n - 1; i > k + 1; --i) {
        Eigen::JacobiRotation<std::complex<double>> g;
        g.makeGivens(a(i - 1, k), a(i, k));
        a.applyOnTheLeft(i - 1, i, g.adjoint());
        a.applyOnTheRight(i - 1, i, g);
        turns.applyOnTheRight(i - 1, i, g);
      }
    }
    Eigen::ComplexSchur<small_square> schur(n);
    schur.computeFromHessenberg(a, turns);
    const small_square& t = schur.matrixT();
    values = t.diagonal();
    small_square x = small_square::Identity(n, n);
    const double tiny = 1e-15 * t.norm();
    for (Eigen::Index k = 0; k < n; ++k) {
      for (Eigen::Index i = k; i-- > 0;) {
        std::complex<double> sum = 0;
        for (Eigen::Index j = i + 1; j <= k; ++j) {
          sum -= t(i, j) * x(j, k);
        }
        const std::complex<double> gap = t(i, i) - values[k];
        x(i, k) = sum / (std::abs(gap) > tiny ? gap : std::complex<double>(tiny));
      }
      x.col(k)
          .stableNormalize(); // where eigenvalues are equal entries are up to 1e15 times as large
    }
    vectors = schur.matrixU().lazyProduct(x);
  }
};

} // namespace duet::detail
