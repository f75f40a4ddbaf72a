// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <Eigen/Core>

/// \file
/// How far two matrices are apart.

namespace duet_test {

/// The largest difference of two entries.
template <class A, class B>
double gap(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

} // namespace duet_test
