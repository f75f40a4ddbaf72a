// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <cmath>

/// \file
/// The smallest singular value of a Jacobian of six joints.

namespace duet::detail {

/// The largest of the inverse: powers of J⁻¹J⁻ᵀ by squaring have its square as a ratio. 0 where J
/// is singular but for rounding.
template <class Jacobian>
[[nodiscard]] double smallest_singular_value(const Jacobian& jacobian) {
  using matrix = Eigen::Matrix<double, 6, 6>;
  const matrix j = jacobian;
  const matrix inverse = j.partialPivLu().inverse();
  const double size = inverse.norm();
  if (!(size < 1e16 / j.norm())) {
    return 0;
  }
  const matrix scaled = inverse / size, square = scaled * scaled.transpose();
  matrix power = square;
  for (int k = 0; k < 9; ++k) { // a second one that is smaller by a hundredth is gone
    power = power.lazyProduct(power).eval();
    power /= power.trace();
  }
  Eigen::Index largest = 0;
  power.diagonal().maxCoeff(&largest);
  const Eigen::Matrix<double, 6, 1> v = power.col(largest).normalized();
  return 1 / (size * (scaled.transpose() * v).norm());
}

} // namespace duet::detail
