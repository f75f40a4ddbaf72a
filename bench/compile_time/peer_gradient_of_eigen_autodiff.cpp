// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// What gradient.cpp does, by Eigen's AutoDiffScalar.

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

Eigen::Vector3d slope(const Eigen::Vector3d& x) {
  using number = Eigen::AutoDiffScalar<Eigen::Vector3d>;
  const number p(x[0], 3, 0), q(x[1], 3, 1), r(x[2], 3, 2);
  const number result = p * p * cos(q) + r;
  return result.derivatives();
}
