// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>

#include <Eigen/Core>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

/// \file
/// How loops are closed. For those who extend duet.

namespace duet::detail {

/// The numbers from 0 to n, without these.
[[nodiscard]] inline std::vector<int> all_but(int n, const std::vector<int>& these) {
  std::vector<int> result;
  for (const int i : these) {
    require(0 <= i && i < n, "duet: closed_tree: no coordinate ", i, " of ", n);
  }
  for (int i = 0; i < n; ++i) {
    if (std::find(these.begin(), these.end(), i) == these.end()) {
      result.push_back(i);
    }
  }
  return result;
}

/// A matrix whose singular values tell which rows and columns depend on others.
class ranked_matrix {
public:
  explicit ranked_matrix(const Eigen::MatrixXd& a)
      : u_(Eigen::MatrixXd::Identity(a.rows(), a.rows())),
        v_(Eigen::MatrixXd::Identity(a.cols(), a.cols())) {
    if (a.size() > 0) { // Eigen has no singular values of nothing
      const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
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

/// ∂F/∂q, each column per unit of its coordinate.
template <class Mechanism>
[[nodiscard]] ranked_matrix linearised(const Mechanism& of, const Eigen::VectorXd& q) {
  return ranked_matrix(of.constraint_jacobian(q) * of.units().asDiagonal());
}

/// Levenberg's and Marquardt's method for F(q) = 0.
template <class Mechanism>
class closing {
public:
  /// \param free  coordinates that may move
  closing(const Mechanism& of, const Eigen::VectorXd& guess, const std::vector<int>& free,
          int most_steps = 200)
      : of_(of), free_(free), q_(guess), f_(of.residuals(guess)), norm_(f_.norm()) {
    for (int i = 0; i < most_steps && norm_ > 0 && step(); ++i) {
    }
  }

  [[nodiscard]] bool has_closed() const {
    return norm_ <= 1e-12 * std::max(1.0, q_.cwiseQuotient(of_.units()).norm());
  }
  [[nodiscard]] double residual() const { return norm_; }
  [[nodiscard]] const Eigen::VectorXd& coordinates() const { return q_; }

private:
  /// One that reduces the residual; false where there is none.
  [[nodiscard]] bool step() {
    const Eigen::MatrixXd all = of_.constraint_jacobian(q_) * of_.units().asDiagonal();
    const Eigen::MatrixXd j = all(Eigen::indexing::all, free_);
    const ranked_matrix svd(j);
    for (int i = 0; i < 25; ++i) {
      Eigen::VectorXd dx = -svd.damped_solve(f_, damping_ * norm_);
      const double length = dx.norm();
      if (!(length > 1e-16)) {
        return false;
      }
      dx *= std::min(1.0, longest / length);
      Eigen::VectorXd next = q_;
      for (Eigen::Index k = 0; k < dx.size(); ++k) {
        next[free_[std::size_t(k)]] += dx[k] * of_.units()[free_[std::size_t(k)]];
      }
      const Eigen::VectorXd f = of_.residuals(next);
      const double norm = f.norm();
      if (norm < norm_) {
        const double foreseen = norm_ * norm_ - (f_ + j * dx).squaredNorm();
        const double gain = (norm_ * norm_ - norm * norm) / foreseen;
        damping_ = std::max(1e-8, damping_ * (gain > .75 ? .1 : gain < .25 ? 4 : 1));
        const bool goes_on = norm < (1 - 1e-5) * norm_;
        q_ = next;
        f_ = f;
        norm_ = norm;
        return goes_on;
      }
      if (norm_ < 1e-14) {
        return false; // rounding
      }
      damping_ *= 10;
    }
    return false;
  }

  static constexpr double longest = 1; ///< of a step
  const Mechanism& of_;
  std::vector<int> free_;
  Eigen::VectorXd q_, f_;
  double norm_;
  double damping_ = 1e-2;
};

} // namespace duet::detail
