// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// Block-banded linear systems that need pivoting, solved in O(n).

namespace duet::detail {

/// Gaussian elimination with partial pivoting. The unknowns are blocks of N numbers; an equation
/// contains those of a few neighbouring blocks, in a cyclic system also those of the last block.
template <class R, int N>
class block_band_lu {
public:
  using panel = Eigen::Matrix<R, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using block = Eigen::Matrix<R, N, 1>;

  /// Group of equations, one per row.
  struct equations {
    std::size_t first;  ///< first block in the equations
    std::size_t offset; ///< index of their first right side, counted in numbers
    panel coefficients; ///< coefficients of that block and its next neighbours, side by side
    panel of_last;      ///< coefficients of the last block, in a cyclic system
  };

  /// Factorises the matrix; false if it is singular.
  ///
  /// \param units   one for each unknown: unknowns are solved for in multiples of them
  /// \param groups  as many equations as unknowns
  [[nodiscard]] bool factorise(std::vector<block> units, std::vector<equations> groups,
                               bool is_cyclic) {
    units_ = std::move(units);
    is_cyclic_ = is_cyclic;
    steps_.clear();
    std::sort(groups.begin(), groups.end(), [](const equations& a, const equations& b) {
      return a.first != b.first ? a.first < b.first : a.offset < b.offset;
    });
    const std::size_t banded = units_.size() - (is_cyclic ? 1 : 0);
    const Eigen::Index border = is_cyclic ? N : 0;
    panel carried(0, border);
    std::size_t next = 0;
    for (std::size_t i = 0; i < banded; ++i) {
      const std::size_t from = next;
      Eigen::Index rows = carried.rows(),
                   width = std::max(Eigen::Index(N), carried.cols() - border);
      for (; next < groups.size() && groups[next].first == i; ++next) {
        rows += groups[next].coefficients.rows();
        width = std::max(width, groups[next].coefficients.cols());
      }
      step s;
      panel m = panel::Zero(rows, width + border);
      Eigen::Index at = carried.rows();
      m.topLeftCorner(at, carried.cols() - border) = carried.leftCols(carried.cols() - border);
      m.topRightCorner(at, border) = carried.rightCols(border);
      for (std::size_t g = from; g < next; ++g) {
        const equations e = std::move(groups[g]); // freed when done
        const Eigen::Index count = e.coefficients.rows();
        for (Eigen::Index c = 0; c < e.coefficients.cols(); ++c) {
          m.col(c).segment(at, count) = e.coefficients.col(c) * unit(i, c);
        }
        for (Eigen::Index c = 0; c < e.of_last.cols(); ++c) {
          m.col(width + c).segment(at, count) = e.of_last.col(c) * unit(banded, c);
        }
        for (Eigen::Index k = 0; k < count; ++k) {
          s.taken.push_back(e.offset + std::size_t(k));
        }
        at += count;
      }
      if (!eliminate(std::move(s), m, carried)) {
        return false;
      }
    }
    return !is_cyclic || eliminate({}, panel(carried), carried);
  }

  /// Solves in place, over any scalar above R: N right sides per element, N unknowns per element.
  template <class V>
  void solve(std::vector<V>& x) const {
    using S = typename V::Scalar;
    std::vector<V> result(x.size());
    std::vector<S> active;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const step& s = steps_[i];
      for (const std::size_t each : s.taken) {
        active.push_back(x[each / N][Eigen::Index(each % N)]);
      }
      for (std::size_t k = 0; k < N; ++k) {
        std::swap(active[k], active[s.pivots[k]]);
      }
      for (int k = 0; k < N; ++k) {
        for (std::size_t row = std::size_t(k) + 1; row < active.size(); ++row) {
          active[row] -= s.lower(Eigen::Index(row), k) * active[std::size_t(k)];
        }
        result[i][k] = active[std::size_t(k)];
      }
      active.erase(active.begin(), active.begin() + N);
    }
    for (std::size_t i = steps_.size(); i-- > 0;) {
      const auto& [taken, pivots, lower, upper] = steps_[i];
      const Eigen::Index banded = upper.cols() - (is_cyclic_ && i + 1 < steps_.size() ? N : 0);
      for (int k = N; k-- > 0;) {
        S& value = result[i][k];
        for (Eigen::Index c = 0; c < upper.cols(); ++c) {
          const V& other = c < banded ? result[i + 1 + std::size_t(c / N)] : result.back();
          value -= upper(k, c) * other[c % N];
        }
        for (int c = k + 1; c < N; ++c) {
          value -= lower(k, c) * result[i][c];
        }
        value /= lower(k, k);
      }
    }
    for (std::size_t i = 0; i < result.size(); ++i) {
      for (int k = 0; k < N; ++k) {
        x[i][k] = result[i][k] * units_[i][k];
      }
    }
  }

private:
  /// Elimination of one block.
  struct step {
    std::vector<std::size_t> taken;  ///< right sides that join those left over from before
    std::vector<std::size_t> pivots; ///< index of the row exchanged with row 0, 1 …
    panel lower;                     ///< first N columns: both factors
    panel upper;                     ///< remaining columns of the first N rows
  };

  [[nodiscard]] R unit(std::size_t first, Eigen::Index column) const {
    return units_[first + std::size_t(column / N)][column % N];
  }

  /// Eliminates the first N columns of m; `left` receives the rows that remain for the next block,
  /// without these columns.
  [[nodiscard]] bool eliminate(step s, panel m, panel& left) {
    if (m.rows() < N) {
      return false;
    }
    for (int k = 0; k < N; ++k) {
      Eigen::Index pivot = 0;
      const R largest = m.col(k).tail(m.rows() - k).cwiseAbs().maxCoeff(&pivot);
      if (!(largest > 0) || !(largest - largest == 0)) {
        return false;
      }
      s.pivots.push_back(std::size_t(k + pivot));
      m.row(k).swap(m.row(k + pivot));
      for (Eigen::Index row = k + 1; row < m.rows(); ++row) {
        const R factor = m(row, k) / m(k, k);
        m(row, k) = factor;
        for (Eigen::Index c = k + 1; c < m.cols() && factor != 0; ++c) {
          m(row, c) -= factor * m(k, c);
        }
      }
    }
    s.lower = m.leftCols(N);
    s.upper = m.topRightCorner(N, m.cols() - N);
    left = m.bottomRightCorner(m.rows() - N, m.cols() - N);
    steps_.push_back(std::move(s));
    return true;
  }

  std::vector<block> units_;
  std::vector<step> steps_;
  bool is_cyclic_ = false;
};

} // namespace duet::detail
