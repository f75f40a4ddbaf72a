// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/evaluate/variables.hpp>
#include <duet/expression/matrix/block.hpp>
#include <duet/expression/matrix/entries.hpp>
#include <duet/expression/matrix/functions.hpp>
#include <duet/expression/matrix/product.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/expression/tree/node.hpp>

#include <cstddef>
#include <utility>

/// \file
/// Matrices as variables of formulas.

namespace duet::expression {

namespace detail {

template <name Name, int Rows, int Columns>
struct matrix_symbol_of {
  static_assert(1 <= Rows && Rows <= 6 && 1 <= Columns && Columns <= 6,
                "duet: a matrix symbol has 1 to 6 rows and columns");
  using type = symbol_of_kind<matrix_kind(Rows, Columns), Name>;
};

/// Each entry by itself, column by column.
template <class Symbol, class Frame, kind K>
  requires(is_sized_matrix(K))
struct directions<Symbol, Frame, K> {
  static constexpr int rows = rows_of(K);

  template <std::size_t... I>
  static constexpr auto make(std::index_sequence<I...>) {
    return motion_list<
        movement<moving<Symbol, unit_matrix<rows, columns_of(K), I % rows, I / rows>>>...>{};
  }
  using type = decltype(make(std::make_index_sequence<rows * columns_of(K)>{}));
};

} // namespace detail

/// A matrix of Rows x Columns, each from 1 to 6. One of 3 x 1 is a `vector_symbol`, one of 1 x 1 a
/// scalar `symbol`.
template <name Name, int Rows, int Columns>
using matrix_symbol = typename detail::matrix_symbol_of<Name, Rows, Columns>::type;

} // namespace duet::expression
