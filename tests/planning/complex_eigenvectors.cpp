// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/random.hpp"

#include <duet/planning/branches/complex_eigenvectors.hpp>
#include <duet/planning/branches/orthonormalise.hpp>

#include <doctest/doctest.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

namespace test_planning_complex_eigenvectors {
namespace {

using duet::detail::complex_eigenvectors;
using duet::detail::small_square;
using complex = std::complex<double>;

small_square random_matrix(duet_test::random_source& random, Eigen::Index n) {
  small_square result(n, n);
  for (complex& x : result.reshaped()) {
    x = {random.normal(), random.normal()};
  }
  return result;
}

/// A v = λ v for all of them, |v| = 1.
double residual(const small_square& a, const complex_eigenvectors& found) {
  double worst = 0;
  for (Eigen::Index k = 0; k < a.rows(); ++k) {
    const auto v = found.vectors.col(k);
    worst = std::max(
        {worst, (a * v - found.values[k] * v).norm() / (1 + a.norm()), std::abs(v.norm() - 1)});
  }
  return worst;
}

} // namespace

TEST_CASE("eigenvectors of random matrices, far from normal, and all eigenvalues") {
  duet_test::random_source random(1);
  for (Eigen::Index n = 1; n <= 12; ++n) {
    for (int k = 0; k < 20; ++k) {
      CAPTURE(n);
      small_square unitary = random_matrix(random, n), triangle = random_matrix(random, n);
      duet::detail::orthonormalise(unitary);
      triangle.triangularView<Eigen::StrictlyLower>().setZero();
      const small_square a = unitary * triangle * unitary.adjoint();
      const complex_eigenvectors found(a);
      CHECK(residual(a, found) < 1e-13);
      for (const complex& expected : triangle.diagonal()) {
        CHECK((found.values.array() - expected).abs().minCoeff() < 1e-6);
      }
      CHECK(std::abs(found.values.sum() - a.trace()) < 1e-13 * (1 + a.norm()) * double(n));
    }
  }
}

TEST_CASE("eigenvalues that are equal: as many vectors, or one of a Jordan block") {
  duet_test::random_source random(2);
  for (Eigen::Index n = 2; n <= 12; ++n) {
    CAPTURE(n);
    small_square block = small_square::Identity(n, n);
    const complex_eigenvectors one(block);
    CHECK((one.vectors - block).norm() < 1e-15);
    block.diagonal(1).setOnes();
    CHECK(residual(block, complex_eigenvectors(block)) < 1e-13);
    CHECK(residual(0 * block, complex_eigenvectors(0 * block)) < 1e-15);
  }
}

} // namespace test_planning_complex_eigenvectors
