// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <Eigen/LU>

#include <cstddef>
#include <vector>

/// \file
/// Block-tridiagonal linear systems in O(n), which Eigen has no solver for.

namespace duet::detail {

/// Row i of the system: lower x_{i−1} + diagonal x_i + upper x_{i+1} = right.
template <class R, int N>
struct block_row {
  Eigen::Matrix<R, N, N> lower, diagonal, upper;
  Eigen::Matrix<R, N, 1> right;
};

/// Solves in place by block elimination with pivoting inside the blocks; each row's `right` becomes
/// x_i. Returns false where a pivot block is singular.
template <class R, int N>
[[nodiscard]] bool solve_block_tridiagonal(std::vector<block_row<R, N>>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    auto& row = rows[i];
    if (i > 0) {
      row.diagonal -= row.lower * rows[i - 1].upper;
      row.right -= row.lower * rows[i - 1].right;
    }
    const Eigen::FullPivLU<Eigen::Matrix<R, N, N>> lu(row.diagonal);
    if (!lu.isInvertible()) {
      return false;
    }
    row.upper = lu.solve(row.upper).eval();
    row.right = lu.solve(row.right).eval();
  }
  for (std::size_t i = rows.size() - 1; i-- > 0;) {
    rows[i].right -= rows[i].upper * rows[i + 1].right;
  }
  return true;
}

} // namespace duet::detail
