// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <Eigen/Core>

/// \file
/// Orthonormal columns by the Gram–Schmidt method, and minimum-norm solutions with them.

namespace duet::detail {
DUET_ABI_BEGIN

/// Orthonormalises columns one after the other by the modified Gram–Schmidt method, and applies the
/// same column operations to `others`. Columns of which little remains are orthogonalised again,
/// because of round-off in the direction of the previous ones.
template <class M, class... Others>
void orthonormalise(M& m, Others&... others) {
  for (Eigen::Index j = 0; j < m.cols(); ++j) {
    double before = 0, size = m.col(j).norm();
    do {
      for (Eigen::Index k = 0; k < j; ++k) {
        const auto part = m.col(k).dot(m.col(j));
        m.col(j) -= part * m.col(k);
        ((others.col(j) -= part * others.col(k)), ...);
      }
      before = size;
      size = m.col(j).norm();
    } while (size < before / 8);
    m.col(j) /= size;
    ((others.col(j) /= size), ...);
  }
}

/// Minimum-norm solution x of J x = e for a Jacobian J of six independent rows: Qᵀ(L⁻¹e)
/// with J = L Q. Faster than Householder reflections for matrices of this size.
template <int Joints>
[[nodiscard]] Eigen::Matrix<double, Joints, 1>
least_solution(const Eigen::Matrix<double, 6, Joints>& jacobian,
               const Eigen::Matrix<double, 6, 1>& e) {
  Eigen::Matrix<double, Joints, 6> rows = jacobian.transpose();
  Eigen::Matrix<double, 1, 6> parts = e.transpose();
  orthonormalise(rows, parts);
  return rows * parts.transpose();
}

DUET_ABI_END
} // namespace duet::detail
