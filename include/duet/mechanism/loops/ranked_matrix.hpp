// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <Eigen/Core>
#include <Eigen/SVD>

/// \file
/// Which rows and columns of a matrix depend on others. For those who extend duet.

namespace duet::detail {

/// A matrix whose singular values tell which rows and columns depend on others.
class ranked_matrix {
public:
  explicit ranked_matrix(const Eigen::MatrixXd& a)
      : u_(Eigen::MatrixXd::Identity(a.rows(), a.rows())),
        v_(Eigen::MatrixXd::Identity(a.cols(), a.cols())) {
    if (a.size() > 0) { // Eigen has no singular values of nothing
      // Full pivots, as that takes compilers a third of the time.
      const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::FullPivHouseholderQRPreconditioner> svd(
          a, Eigen::ComputeFullU | Eigen::ComputeFullV);
      u_ = svd.matrixU();
      v_ = svd.matrixV();
      s_ = svd.singularValues();
    }
    while (rank_ < s_.size() && s_[rank_] > least * s_[0]) {
      ++rank_;
    }
  }

  /// Singular values below this part of the largest one count as zero: near a singular position
  /// they are as far from it as q, and q where equations are singular is known to half the digits.
  static constexpr double least = 1e-6;

  [[nodiscard]] Eigen::Index rank() const { return rank_; }
  [[nodiscard]] const Eigen::VectorXd& singular_values() const { return s_; }
  /// U and V of U S Vᵀ.
  [[nodiscard]] const Eigen::MatrixXd& left() const { return u_; }
  [[nodiscard]] const Eigen::MatrixXd& right() const { return v_; }
  /// Orthonormal columns that span the image.
  [[nodiscard]] Eigen::MatrixXd image() const { return u_.leftCols(rank_); }
  /// Orthonormal columns across the image.
  [[nodiscard]] Eigen::MatrixXd cokernel() const { return u_.rightCols(u_.cols() - rank_); }
  /// Orthonormal columns that it takes to zero.
  [[nodiscard]] Eigen::MatrixXd kernel() const { return v_.rightCols(v_.cols() - rank_); }
  /// The shortest of the x with A x nearest to b, where A is taken to have a rank.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b, Eigen::Index rank) const {
    const Eigen::VectorXd y = u_.leftCols(rank).transpose() * b;
    return v_.leftCols(rank) * y.cwiseQuotient(s_.head(rank));
  }
  /// V (σ / (σ² + λ)) Uᵀ b
  [[nodiscard]] Eigen::VectorXd damped_solve(const Eigen::VectorXd& b, double lambda) const {
    const Eigen::VectorXd y = u_.leftCols(s_.size()).transpose() * b;
    const auto damped = [&](double sigma, double x) {
      return sigma * x / (sigma * sigma + lambda);
    };
    return v_.leftCols(s_.size()) * s_.binaryExpr(y, damped);
  }

private:
  Eigen::MatrixXd u_, v_;
  Eigen::VectorXd s_;
  Eigen::Index rank_ = 0;
};

} // namespace duet::detail
