// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: the matrix A must be square

#include <duet/derivative/linear_solve.hpp>

int main() {
#ifdef DUET_MUST_FAIL
  const Eigen::Matrix<double, 2, 3> a = Eigen::Matrix<double, 2, 3>::Identity();
#else
  const Eigen::Matrix<double, 2, 2> a = Eigen::Matrix<double, 2, 2>::Identity();
#endif
  return duet::solve(a, Eigen::Vector2d(1, 1))[0] == 1 ? 0 : 1;
}
