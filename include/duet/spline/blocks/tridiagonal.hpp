// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include <cstddef>
#include <vector>

/// \file
/// Block-tridiagonal linear systems in O(n), which Eigen has no solver for.

namespace duet::detail {

/// Row i of the system: lower x_{i−1} + diagonal x_i + upper x_{i+1}. The block that would stand
/// outside has a place of its own: see `corners`.
template <class R, int N>
struct block_row {
  Eigen::Matrix<R, N, N> lower, diagonal, upper;

  /// By its place: 0 lower, 1 diagonal, 2 upper.
  [[nodiscard]] Eigen::Matrix<R, N, N>& at(std::size_t place) {
    return place == 0 ? lower : place == 1 ? diagonal : upper;
  }
};

/// Columns of the first row's `lower` and the last row's `upper`.
struct corners {
  std::size_t first, last;
};

/// Block elimination without exchanges between rows, as matrices of spline interpolation allow.
///
/// The first row's corner fills its column up to the diagonal, the last row's corner its row: with
/// corners n − 1 and 0 the system is cyclic, the border's elimination included; with 2 and n − 3
/// its band is wider at both ends.
template <class R, int N>
class block_tridiagonal {
public:
  using matrix = Eigen::Matrix<R, N, N>;

  /// To be filled before `factorise`, two rows or more: the storage is that of the last time.
  [[nodiscard]] std::vector<block_row<R, N>>& rows() { return rows_; }

  /// True where no pivot is singular.
  [[nodiscard]] bool factorise(const corners& at) {
    at_ = at;
    column_.clear();
    bottom_.clear();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      auto& row = rows_[i];
      const bool is_last = i + 1 == rows_.size();
      matrix fill = matrix::Zero();
      if (i == 0) {
        fill = row.lower;
      } else if (i <= column_.size()) {
        fill.noalias() = -row.lower * column_[i - 1];
      }
      if (is_last) {
        eliminate_bottom(row);
      }
      if (i > 0) {
        row.diagonal.noalias() -= row.lower * rows_[i - 1].upper;
      }
      if (i + 1 == at.first) {
        row.upper += fill;
      }
      const matrix inverse = row.diagonal.inverse();
      if (!inverse.allFinite()) {
        return false;
      }
      row.diagonal = inverse;
      if (!is_last) {
        row.upper = (inverse * row.upper).eval();
      }
      if (i + 1 < at.first) {
        column_.push_back(inverse * fill);
      }
    }
    return true;
  }

  /// Solves in place, over any scalar above R: elements of N rows, columns as they like.
  template <class V>
  void solve(std::vector<V>& x) const {
    const std::size_t last = x.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
      if (i > 0) {
        subtract(x[i], rows_[i].lower, x[i - 1]);
      }
      if (i == last) {
        for (std::size_t j = 0; j < bottom_.size(); ++j) {
          subtract(x[i], bottom_[j], x[at_.last + j]);
        }
      }
      V solved = V::Zero();
      subtract(solved, rows_[i].diagonal, x[i]);
      x[i] = -solved;
    }
    for (std::size_t i = last; i-- > 0;) {
      subtract(x[i], rows_[i].upper, x[i + 1]);
      if (i < column_.size()) {
        subtract(x[i], column_[i], x[at_.first]);
      }
    }
  }

private:
  /// The last row's corner, moved to the right column by column until it meets `lower`.
  void eliminate_bottom(block_row<R, N>& row) {
    matrix corner = row.upper;
    for (std::size_t j = at_.last; j + 2 < rows_.size(); ++j) {
      bottom_.push_back(corner);
      if (j < column_.size()) {
        row.diagonal.noalias() -= corner * column_[j];
      }
      corner = (-corner * rows_[j].upper).eval();
    }
    row.lower += corner;
  }

  /// y ← y − a x
  template <class V>
  static void subtract(V& y, const matrix& a, const V& x) {
    for (int column = 0; column < V::ColsAtCompileTime; ++column) {
      for (int i = 0; i < N; ++i) {
        for (int j = 0; j < N; ++j) {
          y(i, column) -= a(i, j) * x(j, column);
        }
      }
    }
  }

  std::vector<block_row<R, N>> rows_;
  std::vector<matrix> column_, bottom_;
  corners at_{};
};

} // namespace duet::detail
