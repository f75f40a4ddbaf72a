// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// What gradient.cpp does, by the Jet of Ceres.

#include <ceres/jet.h>

Eigen::Vector3d slope(const Eigen::Vector3d& x) {
  using number = ceres::Jet<double, 3>;
  const number p(x[0], 0), q(x[1], 1), r(x[2], 2);
  return (p * p * cos(q) + r).v;
}
