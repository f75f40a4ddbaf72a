// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/spline/blocks/products.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <vector>

/// \file
/// Block-tridiagonal linear systems in O(n), for which Eigen has no solver.

namespace duet::detail {

/// Row i of the system: lower x_{i−1} + diagonal x_i + upper x_{i+1}. The block that would stand
/// outside the matrix belongs to another column, see `corners`.
template <class R>
struct block_row {
  Eigen::Matrix<R, 3, 3> lower, diagonal, upper;

  /// Block at a position: 0 lower, 1 diagonal, 2 upper.
  [[nodiscard]] Eigen::Matrix<R, 3, 3>& at(std::size_t place) {
    return place == 0 ? lower : place == 1 ? diagonal : upper;
  }
};

/// Columns of the first row's `lower` and the last row's `upper`.
struct corners {
  std::size_t first, last;
};

/// Block elimination without row exchanges (block Thomas algorithm), as matrices of spline
/// interpolation allow.
///
/// The first and the last row may each have one block outside the band, their corner block. Fill-in
/// stays in the column of the first and in the row of the last one. With corners in columns n − 1
/// and 0 the system is cyclic; with 2 and n − 3 the band is wider at both ends (not-a-knot).
template <class R>
class block_tridiagonal {
public:
  using matrix = Eigen::Matrix<R, 3, 3>;

  /// Rows, two or more, to be filled before `factorise`; the storage is reused from the last time.
  [[nodiscard]] std::vector<block_row<R>>& rows() { return rows_; }

  /// Factorises the matrix; true if no pivot is singular.
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
        add_product(fill, R(-1), row.lower, column_[i - 1]);
      }
      if (is_last) {
        eliminate_bottom(row);
      }
      if (i > 0) {
        add_product(row.diagonal, R(-1), row.lower, rows_[i - 1].upper);
      }
      if (i + 1 == at.first) {
        add_multiple(row.upper, R(1), fill);
      }
      if (!invert(row.diagonal)) {
        return false;
      }
      if (!is_last) {
        row.upper = product(row.diagonal, row.upper);
      }
      if (i + 1 < at.first) {
        fill = product(row.diagonal, fill);
        column_.push_back(fill);
      }
    }
    return true;
  }

  /// Solves in place, for vectors of N over any scalar above R.
  template <class V>
  void solve(std::vector<V>& x) const {
    const std::size_t last = x.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
      if (i > 0) {
        add_product(x[i], R(-1), rows_[i].lower, x[i - 1]);
      }
      if (i == last) {
        for (std::size_t j = 0; j < bottom_.size(); ++j) {
          add_product(x[i], R(-1), bottom_[j], x[at_.last + j]);
        }
      }
      const V right = x[i];
      for (int k = 0; k < 3; ++k) {
        x[i][k] = typename V::Scalar(R(0));
      }
      add_product(x[i], R(1), rows_[i].diagonal, right);
    }
    for (std::size_t i = last; i-- > 0;) {
      add_product(x[i], R(-1), rows_[i].upper, x[i + 1]);
      if (i < column_.size()) {
        add_product(x[i], R(-1), column_[i], x[at_.first]);
      }
    }
  }

private:
  /// Moves the last row's corner to the right, column by column, until it meets `lower`.
  void eliminate_bottom(block_row<R>& row) {
    matrix corner = row.upper;
    for (std::size_t j = at_.last; j + 2 < rows_.size(); ++j) {
      bottom_.push_back(corner);
      if (j < column_.size()) {
        add_product(row.diagonal, R(-1), corner, column_[j]);
      }
      const matrix right = product(corner, rows_[j].upper);
      corner = matrix::Zero();
      add_multiple(corner, R(-1), right);
    }
    add_multiple(row.lower, R(1), corner);
  }

  /// Inverts in place by cofactors; false if the matrix is singular.
  [[nodiscard]] static bool invert(matrix& m) {
    matrix cofactors;
    for (int i = 0; i < 3; ++i) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
      for (int j = 0; j < 3; ++j) {
        const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        cofactors(i, j) = m(i1, j1) * m(i2, j2) - m(i1, j2) * m(i2, j1);
      }
    }
    const R scale =
        1 / (m(0, 0) * cofactors(0, 0) + m(0, 1) * cofactors(0, 1) + m(0, 2) * cofactors(0, 2));
    R sum(0);
    for (int i = 0; i < 9; ++i) {
      m(i / 3, i % 3) = cofactors(i % 3, i / 3) * scale;
      sum += m(i / 3, i % 3);
    }
    return sum - sum == 0;
  }

  std::vector<block_row<R>> rows_;
  std::vector<matrix> column_, bottom_;
  corners at_{};
};

} // namespace duet::detail
