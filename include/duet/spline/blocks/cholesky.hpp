// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <vector>

/// \file
/// Symmetric positive definite block-banded linear systems in O(n), for which Eigen has no solver.

namespace duet::detail {

/// Symmetric matrix of N×N blocks that are zero farther than `Band` from the diagonal.
template <class R, int N, std::size_t Band>
class block_band_matrix {
public:
  using block = Eigen::Matrix<R, N, N>;
  using vector = Eigen::Matrix<R, Eigen::Dynamic, 1>;

  /// Sets the matrix to zero, with this number of block rows.
  void set_zero(std::size_t rows) { blocks_.assign(rows * (Band + 1), block::Zero()); }

  [[nodiscard]] std::size_t rows() const { return blocks_.size() / (Band + 1); }
  /// Block (i, j), i − Band ≤ j ≤ i; only the lower half of diagonal blocks is used.
  [[nodiscard]] block& at(std::size_t i, std::size_t j) { return blocks_[i * (Band + 1) + i - j]; }
  [[nodiscard]] const block& at(std::size_t i, std::size_t j) const {
    return blocks_[i * (Band + 1) + i - j];
  }

  /// Multiplies the diagonal by a factor.
  void scale_diagonal(const R& factor) {
    for (std::size_t i = 0; i < rows(); ++i) {
      at(i, i).diagonal() *= factor;
    }
  }

  /// Replaces the matrix by its lower Cholesky factor; false if it is not positive definite.
  [[nodiscard]] bool factorise() {
    for (std::size_t i = 0; i < rows(); ++i) {
      const std::size_t first = first_of(i);
      for (std::size_t j = first; j <= i; ++j) {
        block& a = at(i, j);
        for (std::size_t k = std::max(first, first_of(j)); k < j; ++k) {
          a.noalias() -= at(i, k).lazyProduct(at(j, k).transpose());
        }
        if (j < i) {
          at(j, j)
              .template triangularView<Eigen::Lower>()
              .transpose()
              .template solveInPlace<Eigen::OnTheRight>(a);
        } else {
          const Eigen::LLT<block> factor(a);
          if (factor.info() != Eigen::Success) {
            return false;
          }
          a = factor.matrixL();
        }
      }
    }
    return true;
  }

  /// Solves in place, with the factors.
  void solve(vector& x) const {
    const auto part = [&x](std::size_t i) { return x.template segment<N>(Eigen::Index(i) * N); };
    for (std::size_t i = 0; i < rows(); ++i) {
      for (std::size_t k = first_of(i); k < i; ++k) {
        part(i) -= at(i, k).lazyProduct(part(k));
      }
      auto y = part(i);
      at(i, i).template triangularView<Eigen::Lower>().solveInPlace(y);
    }
    for (std::size_t i = rows(); i-- > 0;) {
      auto y = part(i);
      at(i, i).template triangularView<Eigen::Lower>().transpose().solveInPlace(y);
      for (std::size_t k = first_of(i); k < i; ++k) {
        part(k) -= at(i, k).transpose().lazyProduct(y);
      }
    }
  }

private:
  [[nodiscard]] static std::size_t first_of(std::size_t i) { return i - std::min(i, Band); }

  std::vector<block> blocks_;
};

} // namespace duet::detail
