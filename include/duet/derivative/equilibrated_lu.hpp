// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include <limits>

/// \file
/// Linear systems whose equations and unknowns have units of their own.

namespace duet::detail {

/// LU with full pivoting of R J C, where the diagonal matrices R and C bring the largest entry of
/// every row, then of every column to 1: whether J counts as singular does not depend on units.
template <int N>
class equilibrated_lu {
public:
  using vector = Eigen::Matrix<double, N, 1>;
  using matrix = Eigen::Matrix<double, N, N>;

  void compute(const matrix& jacobian) {
    row_scale_ = jacobian.cwiseAbs().rowwise().maxCoeff().unaryExpr(&inverse_of_size);
    matrix scaled = row_scale_.asDiagonal() * jacobian;
    column_scale_ = scaled.cwiseAbs().colwise().maxCoeff().transpose().unaryExpr(&inverse_of_size);
    scaled = scaled * column_scale_.asDiagonal();
    lu_.compute(scaled);
  }

  [[nodiscard]] bool is_invertible() const { return lu_.isInvertible(); }

  [[nodiscard]] double determinant() const {
    return lu_.determinant() / (row_scale_.prod() * column_scale_.prod());
  }

  /// x with J x = right
  [[nodiscard]] vector solve(const vector& right) const {
    return column_scale_.cwiseProduct(lu_.solve(row_scale_.cwiseProduct(right)));
  }

  [[nodiscard]] matrix inverse() const {
    return column_scale_.asDiagonal() * lu_.inverse() * row_scale_.asDiagonal();
  }

private:
  /// 1/x, and 1 for what cannot be scaled: zero, infinite or not a number.
  static double inverse_of_size(double x) {
    const bool is_usable = x >= std::numeric_limits<double>::min() && x - x == 0;
    return is_usable ? 1 / x : 1.0;
  }

  vector row_scale_, column_scale_;
  Eigen::FullPivLU<matrix> lu_;
};

} // namespace duet::detail
