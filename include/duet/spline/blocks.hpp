// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// Products of small matrices, and block-banded linear systems in O(n), for which Eigen has no
/// solver.

namespace duet::detail {

/// Adds factor · a to y, in place.
template <class M, class R>
void add_multiple(M& y, const R& factor, const M& a) {
  for (int column = 0; column < M::ColsAtCompileTime; ++column) {
    for (int i = 0; i < M::RowsAtCompileTime; ++i) {
      y(i, column) += factor * a(i, column);
    }
  }
}

/// Adds factor · a x to y, in place; x and y over any scalar above that of a.
template <class Y, class R, class A, class X>
void add_product(Y& y, const R& factor, const A& a, const X& x) {
  for (int column = 0; column < X::ColsAtCompileTime; ++column) {
    for (int j = 0; j < A::ColsAtCompileTime; ++j) {
      const typename X::Scalar multiple = factor * x(j, column);
      for (int i = 0; i < A::RowsAtCompileTime; ++i) {
        y(i, column) += a(i, j) * multiple;
      }
    }
  }
}

/// Product a b of square matrices.
template <class M>
[[nodiscard]] M product(const M& a, const M& b) {
  M result;
  for (int column = 0; column < M::ColsAtCompileTime; ++column) {
    for (int i = 0; i < M::RowsAtCompileTime; ++i) {
      typename M::Scalar sum = a(i, 0) * b(0, column);
      for (int j = 1; j < M::ColsAtCompileTime; ++j) {
        sum += a(i, j) * b(j, column);
      }
      result(i, column) = sum;
    }
  }
  return result;
}

/// Length of three components of a vector, from `first` on.
template <class V>
[[nodiscard]] typename V::Scalar length(const V& v, int first = 0) {
  using std::sqrt;
  return sqrt(v[first] * v[first] + v[first + 1] * v[first + 1] + v[first + 2] * v[first + 2]);
}

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

  /// Multiplies all entries by a factor.
  void scale(const R& factor) {
    for (block& each : blocks_) {
      each *= factor;
    }
  }
  /// Multiplies the diagonal by a factor.
  void scale_diagonal(const R& factor) {
    for (std::size_t i = 0; i < rows(); ++i) {
      at(i, i).diagonal() *= factor;
    }
  }

  /// Calls f(i, j) for every block of the lower half.
  void for_each_block(const auto& f) const {
    for (std::size_t i = 0; i < rows(); ++i) {
      for (std::size_t j = first_of(i); j <= i; ++j) {
        f(i, j);
      }
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

  /// The blocks of the inverse in the band, with the factors L: selected inversion (Takahashi,
  /// Fagan and Chen, 1973). From the last row up,
  ///
  /// Σⱼᵢ = −Σₖ Σⱼₖ Lₖᵢ Lᵢᵢ⁻¹ for j > i, Σᵢᵢ = (Lᵢᵢ Lᵢᵢᵀ)⁻¹ − Σₖ Σₖᵢᵀ Lₖᵢ Lᵢᵢ⁻¹, k > i.
  [[nodiscard]] block_band_matrix selected_inverse() const {
    block_band_matrix inverse;
    inverse.set_zero(rows());
    for (std::size_t i = rows(); i-- > 0;) {
      block unit = block::Identity(); // Lᵢᵢ⁻¹
      at(i, i).template triangularView<Eigen::Lower>().solveInPlace(unit);
      const std::size_t last = std::min(i + Band, rows() - 1);
      inverse.at(i, i) = unit.transpose().lazyProduct(unit);
      for (std::size_t k = i + 1; k <= last; ++k) {
        const block factor = at(k, i).lazyProduct(unit);
        for (std::size_t j = i + 1; j <= last; ++j) {
          if (j >= k) {
            inverse.at(j, i).noalias() -= inverse.at(j, k).lazyProduct(factor);
          } else {
            inverse.at(j, i).noalias() -= inverse.at(k, j).transpose().lazyProduct(factor);
          }
        }
      }
      for (std::size_t k = i + 1; k <= last; ++k) {
        inverse.at(i, i).noalias() -=
            inverse.at(k, i).transpose().lazyProduct(at(k, i).lazyProduct(unit).eval());
      }
    }
    return inverse;
  }

private:
  [[nodiscard]] static std::size_t first_of(std::size_t i) { return i - std::min(i, Band); }

  std::vector<block> blocks_;
};

} // namespace duet::detail
