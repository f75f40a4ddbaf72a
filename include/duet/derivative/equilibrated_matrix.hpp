// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

/// \file
/// Inverses of small matrices whose rows and columns have different units.

namespace duet::detail {

/// A matrix J and its inverse, by Gauss–Jordan elimination with full pivoting of R J C, where the
/// diagonal matrices R and C bring the largest entry of every row, then of every column to 1
/// (equilibration): whether J counts as singular does not depend on units. (g++ takes 1.5 s for
/// Eigen's FullPivLU, 0.2 s for this.)
template <int N>
class equilibrated_matrix {
public:
  using vector = Eigen::Matrix<double, N, 1>;
  using matrix = Eigen::Matrix<double, N, N>;

  void compute(const matrix& entries) {
    inverse_ = entries;
    vector row_scale, column_scale;
    for (int i = 0; i < N; ++i) {
      row_scale[i] = inverse_of_size(inverse_.row(i).cwiseAbs().maxCoeff());
      inverse_.row(i) *= row_scale[i];
    }
    for (int j = 0; j < N; ++j) {
      column_scale[j] = inverse_of_size(inverse_.col(j).cwiseAbs().maxCoeff());
      inverse_.col(j) *= column_scale[j];
    }
    eliminate();
    for (int i = 0; i < N; ++i) {
      determinant_ /= row_scale[i] * column_scale[i];
      for (int j = 0; j < N; ++j) {
        inverse_(i, j) *= column_scale[i] * row_scale[j];
      }
    }
  }

  /// True if the smallest pivot exceeds the round-off of a zero.
  [[nodiscard]] bool is_invertible() const { return is_invertible_; }
  [[nodiscard]] double determinant() const { return determinant_; }
  /// J⁻¹, infinite if a pivot is zero
  [[nodiscard]] const matrix& inverse() const { return inverse_; }
  /// x with J x = right
  [[nodiscard]] vector solve(const vector& right) const { return inverse_ * right; }

private:
  /// 1/x, or 1 for what cannot be scaled: zero, infinite or not a number.
  static double inverse_of_size(double x) {
    const bool is_usable = x >= std::numeric_limits<double>::min() && x - x == 0;
    return is_usable ? 1 / x : 1.0;
  }

  /// Elimination in place: with row and column k exchanged for those of the pivot p, column k
  /// becomes that of the unit matrix, which is then the inverse's.
  void eliminate() {
    std::array<int, std::size_t(N)> rows{}, columns{};
    double largest = 0, smallest = HUGE_VAL;
    determinant_ = 1;
    for (int k = 0; k < N; ++k) {
      int row = k, column = k;
      for (int j = k; j < N; ++j) {
        for (int i = k; i < N; ++i) {
          if (std::abs(inverse_(i, j)) > std::abs(inverse_(row, column))) {
            row = i, column = j;
          }
        }
      }
      exchange(inverse_.row(k), inverse_.row(row));
      exchange(inverse_.col(k), inverse_.col(column));
      rows[std::size_t(k)] = row;
      columns[std::size_t(k)] = column;
      const double pivot = inverse_(k, k);
      if (pivot == 0) { // all remaining pivots are zero too
        determinant_ = 0;
        is_invertible_ = false;
        inverse_.setConstant(HUGE_VAL);
        return;
      }
      determinant_ *= (row != k) == (column != k) ? pivot : -pivot;
      largest = std::max(largest, std::abs(pivot));
      if (!(std::abs(pivot) >= smallest)) { // or not a number
        smallest = std::abs(pivot);
      }
      inverse_(k, k) = 1;
      inverse_.row(k) /= pivot;
      for (int i = 0; i < N; ++i) {
        if (i != k) {
          const double factor = inverse_(i, k);
          inverse_(i, k) = 0;
          inverse_.row(i) -= factor * inverse_.row(k);
        }
      }
    }
    for (int k = N - 1; k >= 0; --k) { // P J Q = L, J⁻¹ = Q L⁻¹ P
      exchange(inverse_.col(k), inverse_.col(rows[std::size_t(k)]));
      exchange(inverse_.row(k), inverse_.row(columns[std::size_t(k)]));
    }
    is_invertible_ = smallest > N * std::numeric_limits<double>::epsilon() * largest;
  }

  template <class Line>
  static void exchange(Line&& a, Line&& b) {
    for (int i = 0; i < N; ++i) {
      std::swap(a[i], b[i]);
    }
  }

  matrix inverse_;
  double determinant_ = 0;
  bool is_invertible_ = false;
};

} // namespace duet::detail
