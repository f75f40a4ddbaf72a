// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/algebra/arithmetic.hpp>
#include <duet/expression/algebra/product.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/tree/printed.hpp>
#include <duet/expression/vector.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <string>
#include <tuple>
#include <type_traits>

/// \file
/// Blocks of matrices, transposed matrices, and matrices of zeros with a block, which derivatives
/// with respect to entries contain.

namespace duet::expression {

namespace op {

struct transpose;
template <int Rows, int Columns>
struct entries;

/// Matrix of zeros with a block X that begins at (I, J). It is never printed, as only derivatives
/// with respect to entries contain it.
template <int Rows, int Columns, int I, int J>
struct embedded_block : linear_operation {
  static constexpr kind kind_of(kind) { return matrix_kind(Rows, Columns); }
  template <class X>
  static constexpr auto simplified(X x) {
    if constexpr (rows_of(X::kind_of) == Rows && columns_of(X::kind_of) == Columns) {
      return x;
    } else if constexpr (Rows == 3 && Columns == 1 && X::kind_of == kind::scalar) {
      return x * unit_vector_node<kind::vector, I>{};
    }
  }
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

/// Block of a matrix outside of which all entries are known to be 0, such as X of `embedded_block`.
template <class M>
struct sparsity {
  static constexpr bool is_sparse = false;
};
template <int Rows, int Columns, int Row, int Column, class X>
struct sparsity<applied_node<op::embedded_block<Rows, Columns, Row, Column>, X>> {
  static constexpr bool is_sparse = true;
  using block = X;
  static constexpr int row = Row, column = Column;
  static constexpr int rows = rows_of(X::kind_of), columns = columns_of(X::kind_of);
};
template <int I>
struct sparsity<unit_vector_node<kind::vector, I>> {
  static constexpr bool is_sparse = true;
  using block = number_node<bits_of(1)>;
  static constexpr int row = I, column = 0, rows = 1, columns = 1;
};

[[nodiscard]] inline std::string printed_range(notation style, int begin, int size) {
  const int first = begin + (style != notation::text ? 1 : 0);
  return std::to_string(first) + (size == 1 ? "" : ":" + std::to_string(first + size - 1));
}

} // namespace detail

namespace op {

/// Block of Rows x Columns entries that begins at (I, J).
template <int I, int J, int Rows, int Columns>
struct block : linear_operation {
  static constexpr kind kind_of(kind) { return matrix_kind(Rows, Columns); }
  template <class M>
  static constexpr auto simplified(M m) {
    if constexpr (Rows == rows_of(M::kind_of) && Columns == columns_of(M::kind_of)) {
      return m;
    } else if constexpr (detail::is_scaled<M>) {
      return detail::scaled_outside(m, [](auto x) { return apply<block>(x); });
    } else if constexpr (is_applied<M, transpose>) {
      return apply<transpose>(apply<op::block<J, I, Columns, Rows>>(operand<0>(m)));
    } else if constexpr (detail::sparsity<M>::is_sparse) {
      return of_sparse<detail::sparsity<M>>();
    } else {
      return of(m);
    }
  }
  template <class M>
  static auto value(const M& m) {
    if constexpr (Rows == 1 && Columns == 1) {
      return typename M::Scalar(m(I, J));
    } else {
      return Eigen::Matrix<typename M::Scalar, Rows, Columns>(
          m.template block<Rows, Columns>(I, J));
    }
  }
  static printed print(notation style, const printed& m) {
    const std::string i = detail::printed_range(style, I, Rows);
    const std::string j = detail::printed_range(style, J, Columns);
    return style != notation::text ? detail::with_index(m, i + "," + j)
                                   : printed{m.inside(precedence::atom) + "(" + i + ", " + j + ")"};
  }

private:
  template <class M>
  static constexpr auto of(M) {
    if constexpr (Rows == 1 && Columns == 1 && columns_of(M::kind_of) == 1) {
      return applied_node<component<I>, M>{};
    }
  }
  template <int Row, int Column, int R, int C, class M>
  static constexpr auto of(applied_node<op::block<Row, Column, R, C>, M>) {
    return apply<op::block<I + Row, J + Column, Rows, Columns>>(M{});
  }
  template <int R, int C, class... X>
    requires(Rows == 1 && Columns == 1)
  static constexpr auto of(applied_node<entries<R, C>, X...>) {
    return std::tuple_element_t<std::size_t(I * C + J), std::tuple<X...>>{};
  }
  /// Intersection of this block with the one outside of which the matrix is 0.
  template <class S>
  static constexpr auto of_sparse() {
    constexpr int top = std::max(I, S::row), bottom = std::min(I + Rows, S::row + S::rows);
    constexpr int left = std::max(J, S::column),
                  right = std::min(J + Columns, S::column + S::columns);
    if constexpr (top >= bottom || left >= right) {
      return zero_of<matrix_kind(Rows, Columns)>();
    } else {
      return apply<embedded_block<Rows, Columns, top - I, left - J>>(
          apply<op::block<top - S::row, left - S::column, bottom - top, right - left>>(
              typename S::block{}));
    }
  }
};

/// Aᵀ
struct transpose : linear_operation {
  static constexpr detail::function_name name = {"transpose", "#^{\\top}"};
  static constexpr kind kind_of(kind m) { return matrix_kind(columns_of(m), rows_of(m)); }
  template <class M>
  static constexpr auto simplified(applied_node<transpose, M>) {
    return M{};
  }
  template <class M>
  static constexpr auto simplified(M m) {
    if constexpr (M::kind_of == kind::scalar) {
      return m;
    } else if constexpr (detail::is_scaled<M>) {
      return detail::scaled_outside(m, [](auto x) { return apply<transpose>(x); });
    } else if constexpr (detail::sparsity<M>::is_sparse) {
      using sparse = detail::sparsity<M>;
      return apply<
          embedded_block<columns_of(M::kind_of), rows_of(M::kind_of), sparse::column, sparse::row>>(
          apply<transpose>(typename sparse::block{}));
    }
  }
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
