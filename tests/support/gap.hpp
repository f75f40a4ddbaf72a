// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/select.hpp>

#include <Eigen/Core>

#include <cmath>

/// \file
/// How far two matrices are apart.

namespace duet_test {

/// The largest difference of two entries.
template <class A, class B>
double max_abs_difference(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  const auto& x = a.eval();
  const auto& y = b.eval();
  double largest = 0;
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      largest = duet::detail::larger_or_nan(largest, std::abs(double(x(i, j) - y(i, j))));
    }
  }
  return largest;
}

} // namespace duet_test
