// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/spline/blocks/tridiagonal.hpp>

#include <array>
#include <cstddef>
#include <vector>

/// \file
/// Block-tridiagonal systems whose first and last rows reach further than the others.

namespace duet::detail {

/// The first and the last row have blocks for the unknowns nearest to their end, up to `Reach`
/// knots away. The rows between serve to shorten them; then all is tridiagonal.
template <class R, int N, std::size_t Reach>
class wide_block_tridiagonal {
public:
  using matrix = Eigen::Matrix<R, N, N>;
  /// Blocks by their distance from the end.
  using end_row = std::array<matrix, Reach + 1>;

  /// To be filled before it is factorised.
  [[nodiscard]] std::vector<block_row<R, N>>& rows() { return tridiagonal_.rows(); }

  /// \param reach  the farthest block that counts, at least 1; the rows that far from the ends are
  ///               not ends themselves
  [[nodiscard]] bool factorise(std::array<end_row, 2> ends, std::size_t reach) {
    reach_ = reach;
    auto& rows = tridiagonal_.rows();
    const std::size_t last = rows.size() - 1;
    for (std::size_t q = reach; q >= 2; --q) {
      for (const bool at_start : {true, false}) {
        end_row& end = ends[at_start ? 0 : 1];
        const auto& row = rows[at_start ? q - 1 : last + 1 - q];
        const matrix& outer = at_start ? row.upper : row.lower;
        const matrix& inner = at_start ? row.lower : row.upper;
        const matrix m = end[q] * matrix(outer.inverse());
        end[q - 1] -= m * row.diagonal;
        end[q - 2] -= m * inner;
        multipliers_[at_start ? 0 : 1][q] = m;
      }
    }
    rows.front().diagonal = ends[0][0];
    rows.front().upper = ends[0][1];
    rows.back().diagonal = ends[1][0];
    rows.back().lower = ends[1][1];
    return tridiagonal_.factorise({1, last - 1});
  }
  [[nodiscard]] bool factorise_cyclic() {
    reach_ = 1;
    return tridiagonal_.factorise({tridiagonal_.rows().size() - 1, 0});
  }

  /// Solves in place, over any scalar above R.
  template <class V>
  void solve(std::vector<V>& x) const {
    const std::size_t last = x.size() - 1;
    for (std::size_t q = reach_; q >= 2; --q) {
      subtract(x[0], multipliers_[0][q], x[q - 1]);
      subtract(x[last], multipliers_[1][q], x[last + 1 - q]);
    }
    tridiagonal_.solve(x);
  }

private:
  /// y ← y − m x
  template <class V>
  static void subtract(V& y, const matrix& m, const V& x) {
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j < N; ++j) {
        y[i] -= m(i, j) * x[j];
      }
    }
  }

  block_tridiagonal<R, N> tridiagonal_;
  std::array<end_row, 2> multipliers_;
  std::size_t reach_ = 1;
};

} // namespace duet::detail
