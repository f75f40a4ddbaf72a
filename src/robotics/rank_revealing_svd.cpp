// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "loops/rank_revealing_svd.hpp"

#include <Eigen/SVD>

namespace duet::detail {
DUET_ABI_BEGIN

rank_revealing_svd::rank_revealing_svd(const Eigen::MatrixXd& a)
    : u_(Eigen::MatrixXd::Identity(a.rows(), a.rows())),
      v_(Eigen::MatrixXd::Identity(a.cols(), a.cols())) {
  if (a.size() > 0) { // Eigen has no singular values of empty matrices
    const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::FullPivHouseholderQRPreconditioner> svd(
        a, Eigen::ComputeFullU | Eigen::ComputeFullV);
    u_ = svd.matrixU();
    v_ = svd.matrixV();
    s_ = svd.singularValues();
  }
  while (rank_ < s_.size() && s_[rank_] > rank_tolerance * s_[0]) {
    ++rank_;
  }
}

Eigen::VectorXd rank_revealing_svd::solve(const Eigen::VectorXd& b, Eigen::Index rank) const {
  const Eigen::VectorXd y = u_.leftCols(rank).transpose() * b;
  return v_.leftCols(rank) * y.cwiseQuotient(s_.head(rank));
}

Eigen::VectorXd rank_revealing_svd::damped_solve(const Eigen::VectorXd& b, double lambda) const {
  const Eigen::VectorXd y = u_.leftCols(s_.size()).transpose() * b;
  const auto damped = [&](double sigma, double x) { return sigma * x / (sigma * sigma + lambda); };
  return v_.leftCols(s_.size()) * s_.binaryExpr(y, damped);
}
DUET_ABI_END
} // namespace duet::detail
