// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/math.hpp>
#include <duet/core/config.hpp>
#include <duet/dual/eigen/structure.hpp>

#include <Eigen/Core>

/// \file
/// Systems of linear equations, one in every lane of batches.

namespace duet::detail {

/// What `Eigen::PartialPivLU` is to one matrix. Rows are exchanged by blending, so each lane has
/// the pivots that it would have alone.
template <class M>
class lane_lu {
public:
  using Scalar = typename M::Scalar;

  explicit lane_lu(const M& a) : factors_(a), pivot_rows_(a.rows()) {
    const Eigen::Index n = factors_.rows();
    for (Eigen::Index k = 0; k < n; ++k) {
      Scalar largest = abs(factors_(k, k));
      Scalar row(k);
      for (Eigen::Index i = k + 1; i < n; ++i) {
        const Scalar size = abs(factors_(i, k));
        const auto is_larger = largest < size;
        largest = blended(is_larger, size, largest);
        row = blended(is_larger, Scalar(i), row);
      }
      pivot_rows_[k] = row;
      exchange(factors_, k);
      // Where the pivot is zero, so is the column.
      const Scalar pivot = blended(largest == 0, Scalar(1), factors_(k, k));
      for (Eigen::Index i = k + 1; i < n; ++i) {
        factors_(i, k) /= pivot;
        for (Eigen::Index j = k + 1; j < n; ++j) {
          factors_(i, j) -= factors_(i, k) * factors_(k, j);
        }
      }
    }
  }

  [[nodiscard]] const M& matrixLU() const { return factors_; }

  template <class B>
  [[nodiscard]] B solve(const B& b) const {
    const Eigen::Index n = factors_.rows();
    B x = b;
    for (Eigen::Index k = 0; k < n; ++k) {
      exchange(x, k);
    }
    for (Eigen::Index j = 0; j < x.cols(); ++j) {
      for (Eigen::Index k = 0; k < n; ++k) {
        for (Eigen::Index i = k + 1; i < n; ++i) {
          x(i, j) -= factors_(i, k) * x(k, j);
        }
      }
      for (Eigen::Index k = n - 1; k >= 0; --k) {
        x(k, j) /= factors_(k, k);
        for (Eigen::Index i = 0; i < k; ++i) {
          x(i, j) -= factors_(i, k) * x(k, j);
        }
      }
    }
    return x;
  }

private:
  /// Row k and the row of the k-th pivot.
  template <class X>
  void exchange(X& x, Eigen::Index k) const {
    for (Eigen::Index i = k + 1; i < x.rows(); ++i) {
      const auto is_pivot = pivot_rows_[k] == Scalar(i);
      if (any(is_pivot)) {
        for (Eigen::Index j = 0; j < x.cols(); ++j) {
          const Scalar upper = x(k, j), lower = x(i, j);
          x(k, j) = blended(is_pivot, lower, upper);
          x(i, j) = blended(is_pivot, upper, lower);
        }
      }
    }
  }

  M factors_;
  Eigen::Matrix<Scalar, M::RowsAtCompileTime, 1> pivot_rows_;
};

} // namespace duet::detail
