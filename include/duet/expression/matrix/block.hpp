// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/arithmetic.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/tree/printed.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <string>
#include <type_traits>

/// \file
/// Blocks of matrices, transposed matrices, and matrices of zeros with a block, which derivatives
/// with respect to entries contain.

namespace duet::expression {

namespace op {

/// Matrix of zeros with a block X that begins at (I, J). It is never printed, as only derivatives
/// with respect to entries contain it.
template <int Rows, int Columns, int I, int J>
struct embedded_block {
  static constexpr kind kind_of(kind) { return matrix_kind(Rows, Columns); }
  template <class X>
  static auto value(const X& x) {
    using T = std::remove_cvref_t<decltype(detail::component_of(x, 0))>;
    Eigen::Matrix<T, Rows, Columns> m = Eigen::Matrix<T, Rows, Columns>::Zero();
    if constexpr (detail::EigenMatrix<X>) {
      m.template block<X::RowsAtCompileTime, X::ColsAtCompileTime>(I, J) = x;
    } else {
      m(I, J) = x;
    }
    return m;
  }
};

} // namespace op

namespace detail {

/// Matrix with 1 at (I, J) and 0 elsewhere.
template <int Rows, int Columns, int I, int J>
using unit_matrix = decltype(apply<op::embedded_block<Rows, Columns, I, J>>(whole<1>));

/// Block of a matrix of rows × columns entries that begins at (i, j).
[[nodiscard]] inline printed print_block(notation style, const printed& m, int i, int j,
                                         kind size) {
  const auto range = [&](int begin, int count) {
    const int first = begin + (style != notation::text ? 1 : 0);
    return std::to_string(first) + (count == 1 ? "" : ":" + std::to_string(first + count - 1));
  };
  const std::string rows = range(i, rows_of(size)), columns = range(j, columns_of(size));
  return style != notation::text
             ? with_index(m, rows + "," + columns)
             : printed{m.inside(precedence::atom) + "(" + rows + ", " + columns + ")"};
}

} // namespace detail

namespace op {

/// Block of Rows x Columns entries that begins at (I, J).
template <int I, int J, int Rows, int Columns>
struct block {
  static constexpr kind kind_of(kind) { return matrix_kind(Rows, Columns); }
  template <class M>
  static auto value(const M& m) {
    if constexpr (Rows == 1 && Columns == 1) {
      return typename M::Scalar(m(I, J));
    } else {
      return Eigen::Matrix<typename M::Scalar, Rows, Columns>(
          m.template block<Rows, Columns>(I, J));
    }
  }
};

/// Aᵀ
struct transpose {
  static constexpr detail::function_name name = {"transpose", "#^{\\top}"};
  static constexpr kind kind_of(kind m) { return matrix_kind(columns_of(m), rows_of(m)); }
  template <class M>
  static auto value(const M& m) {
    return Eigen::Matrix<typename M::Scalar, M::ColsAtCompileTime, M::RowsAtCompileTime>(
        m.transpose());
  }
};

} // namespace op

/// Aᵀ.
[[nodiscard]] constexpr auto transpose(const MatrixTerm auto& m) { return apply<op::transpose>(m); }

/// The Rows x Columns block that begins at (I, J), from 0.
template <int I, int J, int Rows, int Columns, MatrixTerm M>
[[nodiscard]] constexpr auto block(const M& m) {
  constexpr kind k = detail::kind_of_term<M>();
  static_assert(0 <= I && 0 <= J && 0 < Rows && 0 < Columns && I + Rows <= rows_of(k) &&
                    J + Columns <= columns_of(k),
                "duet: an entry or a block that is not in the matrix");
  return apply<op::block<I, J, Rows, Columns>>(m);
}
/// The entry A_IJ, counted from 0; J may be omitted for a column.
template <int I, int J = 0, MatrixTerm M>
[[nodiscard]] constexpr auto entry(const M& m) {
  return block<I, J, 1, 1>(m);
}
/// The I-th row, counted from 0.
template <int I, MatrixTerm M>
[[nodiscard]] constexpr auto row(const M& m) {
  return block<I, 0, 1, columns_of(detail::kind_of_term<M>())>(m);
}
/// The J-th column, counted from 0.
template <int J, MatrixTerm M>
[[nodiscard]] constexpr auto column(const M& m) {
  return block<0, J, rows_of(detail::kind_of_term<M>()), 1>(m);
}

} // namespace duet::expression
