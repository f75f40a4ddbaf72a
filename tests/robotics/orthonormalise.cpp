// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/random.hpp"

#include "../../src/robotics/branches/orthonormalise.hpp"

#include <doctest/doctest.h>

#include <Eigen/Core>

#include <cmath>
#include <complex>
#include <type_traits>

namespace test_robotics_orthonormalise {
namespace {

template <class M>
M random_matrix(duet_test::random_source& random, Eigen::Index rows, Eigen::Index columns) {
  M result(rows, columns);
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    auto& x = result.data()[i];
    if constexpr (std::is_same_v<typename M::Scalar, double>) {
      x = random.normal();
    } else {
      x = {random.normal(), random.normal()};
    }
  }
  return result;
}

/// Checks J x = e for Jacobians whose last row is nearly the sum of two others, and that x is
/// orthogonal to the null space.
template <int Joints>
void check_min_norm_solution() {
  using columns = Eigen::Matrix<double, 6, Joints>;
  duet_test::random_source random(4);
  for (const double independence : {1., 1e-3, 1e-6, 1e-9, 1e-12}) {
    CAPTURE(independence);
    for (int k = 0; k < 20; ++k) {
      columns j = random_matrix<columns>(random, 6, Joints);
      j.row(5) = j.row(0) + j.row(3) + independence * j.row(5);
      const Eigen::Matrix<double, Joints, 1> rates =
          random_matrix<Eigen::Matrix<double, Joints, 1>>(random, Joints, 1);
      const Eigen::Matrix<double, 6, 1> e = j * rates;
      const Eigen::Matrix<double, Joints, 1> x = duet::detail::least_solution(j, e);
      CHECK((j * x - e).norm() < 1e-14 * (1 + j.norm() * x.norm()));
      // The difference from x is in the null space and orthogonal to x.
      const Eigen::Matrix<double, Joints, 1> rest = rates - x;
      CHECK((j * rest).norm() < 1e-14 * (1 + j.norm() * x.norm()));
      CHECK(std::abs(rest.dot(x)) < 1e-14 / independence * (1 + rates.squaredNorm()) * 100);
    }
  }
}

} // namespace

TEST_CASE(
    "orthonormalise: columns become orthonormal, and the operations are applied to other columns") {
  using square = Eigen::MatrixXcd;
  duet_test::random_source random(3);
  for (Eigen::Index n = 1; n <= 6; ++n) {
    CAPTURE(n);
    const auto factor = random_matrix<square>(random, n, n);
    auto m = random_matrix<square>(random, n, n);
    square other = factor * m;
    duet::detail::orthonormalise(m, other);
    CHECK((m.adjoint() * m - square::Identity(n, n)).norm() < 1e-10);
    CHECK((other - factor * m).norm() < 1e-10);
  }
}

TEST_CASE("least_solution: minimum-norm solutions of six equations are accurate, also if these "
          "are nearly dependent") {
  check_min_norm_solution<6>();
  check_min_norm_solution<7>();
}

} // namespace test_robotics_orthonormalise
