// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/matrix/block.hpp>
#include <duet/expression/matrix/functions.hpp>
#include <duet/expression/matrix/product.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/expression/tree/bindings.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/variables.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <utility>

/// \file
/// Matrix symbols, and matrices of scalar formulas.

namespace duet::expression {

namespace op {

/// Matrix of scalars, which are given row by row.
template <int Rows, int Columns>
struct entries {
  static constexpr kind kind_of(auto...) { return matrix_kind(Rows, Columns); }
  template <class... X>
  static auto value(const X&... x) {
    using T = detail::common_scalar_t<X...>;
    const T all[] = {T(x)...};
    Eigen::Matrix<T, Rows, Columns> m;
    for (int i = 0; i < Rows; ++i) {
      for (int j = 0; j < Columns; ++j) {
        m(i, j) = all[i * Columns + j];
      }
    }
    return m;
  }
};

} // namespace op

/// The Rows x Columns matrix of scalars, written row by row: `matrix<2, 2>(a, b, c, d)` has a and b
/// in its first row. 1 to 6 rows and columns.
template <int Rows, int Columns, class... X, class Tag = decltype([](op::entries<1, 2>*) {})>
  requires Operands<X...>
[[nodiscard]] constexpr auto matrix(const X&... x) {
  static_assert(1 <= Rows && Rows <= 6 && 1 <= Columns && Columns <= 6 && Rows * Columns > 1,
                "duet: a matrix in a formula has 1 to 6 rows and columns; of 1 x 1 it is a scalar");
  static_assert(sizeof...(X) == Rows * Columns,
                "duet: matrix<2, 4>(...) takes its 8 entries, row by row");
  return detail::apply_to<op::entries<Rows, Columns>, Tag>(std::index_sequence_for<X...>{}, x...);
}

namespace detail {

template <name Name, int Rows, int Columns>
struct matrix_symbol_of {
  static_assert(1 <= Rows && Rows <= 6 && 1 <= Columns && Columns <= 6,
                "duet: a matrix symbol has 1 to 6 rows and columns");
  using type = symbol_of_kind<matrix_kind(Rows, Columns), Name>;
};

/// Motions of one entry each, column by column.
template <class Symbol, class Frame, kind K>
  requires(is_sized_matrix(K))
struct directions<Symbol, Frame, K> {
  static constexpr int rows = rows_of(K);

  template <std::size_t... I>
  static constexpr auto make(std::index_sequence<I...>) {
    return motion_list<moving<Symbol, unit_matrix<rows, columns_of(K), I % rows, I / rows>>...>{};
  }
  using type = decltype(make(std::make_index_sequence<std::size_t(rows* columns_of(K))>{}));
};

} // namespace detail

/// A matrix of Rows x Columns, each from 1 to 6. One of 3 x 1 is a `vector_symbol`, one of 1 x 1 a
/// scalar `symbol`.
template <name Name, int Rows, int Columns>
using matrix_symbol = typename detail::matrix_symbol_of<Name, Rows, Columns>::type;

} // namespace duet::expression
