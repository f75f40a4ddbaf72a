// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <Eigen/Core>

/// \file
/// Rank-revealing singular value decomposition. For those who extend duet.

namespace duet::detail {
DUET_ABI_BEGIN

/// Singular value decomposition of a matrix with its numerical rank: the dependent
/// rows and columns.
class rank_revealing_svd {
public:
  explicit rank_revealing_svd(const Eigen::MatrixXd& a);

  /// Relative tolerance of the rank: singular values below this fraction of the largest one count
  /// as zero. Near a singular configuration they are as far from zero as q is from it, and q is
  /// known to half the digits where equations are singular.
  static constexpr double rank_tolerance = 1e-6;

  [[nodiscard]] Eigen::Index rank() const { return rank_; }
  [[nodiscard]] const Eigen::VectorXd& singular_values() const { return s_; }
  /// U and V of the decomposition U S Vᵀ.
  [[nodiscard]] const Eigen::MatrixXd& left() const { return u_; }
  [[nodiscard]] const Eigen::MatrixXd& right() const { return v_; }
  /// Orthonormal basis of the image (column space), as columns.
  [[nodiscard]] Eigen::MatrixXd image() const { return u_.leftCols(rank_); }
  /// Orthonormal basis of the orthogonal complement of the image, as columns.
  [[nodiscard]] Eigen::MatrixXd cokernel() const { return u_.rightCols(u_.cols() - rank_); }
  /// Orthonormal basis of the kernel (null space), as columns.
  [[nodiscard]] Eigen::MatrixXd kernel() const { return v_.rightCols(v_.cols() - rank_); }
  /// Minimum-norm least-squares solution of A x = b, where A is taken to have a given rank.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b, Eigen::Index rank) const;
  /// Damped least-squares solution V (σ / (σ² + λ)) Uᵀ b.
  [[nodiscard]] Eigen::VectorXd damped_solve(const Eigen::VectorXd& b, double lambda) const;

private:
  Eigen::MatrixXd u_, v_;
  Eigen::VectorXd s_;
  Eigen::Index rank_ = 0;
};

DUET_ABI_END
} // namespace duet::detail
