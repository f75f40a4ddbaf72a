// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/derivative.hpp>
#include <duet/expression/evaluate/given.hpp>
#include <duet/expression/matrix/block.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/printed.hpp>
#include <duet/expression/vector.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <utility>

/// \file
/// Matrices put together from scalars.

namespace duet::expression {

namespace op {

/// The matrix of scalars, row by row.
template <int Rows, int Columns>
struct entries {
  template <class... Kinds>
  static constexpr kind kind_of(Kinds...) {
    return matrix_kind(Rows, Columns);
  }
  template <class... X>
  static constexpr auto simplified(X... x) {
    if constexpr ((is_zero<X> && ...)) {
      return zero_of<matrix_kind(Rows, Columns)>();
    } else if constexpr (Rows == 3 && Columns == 1) {
      return apply<column>(x...);
    } else {
      return applied_node<entries, X...>{};
    }
  }
  template <class... X>
  static auto value(const X&... x) {
    using T = typename detail::common_scalar<X...>::type;
    const T all[] = {T(x)...};
    Eigen::Matrix<T, Rows, Columns> m;
    for (int i = 0; i < Rows; ++i) {
      for (int j = 0; j < Columns; ++j) {
        m(i, j) = all[i * Columns + j];
      }
    }
    return m;
  }
  template <class... P>
  static printed print(notation style, const P&... x) {
    return detail::printed_matrix(style, Columns, {x.text...});
  }
};

} // namespace op

namespace detail {

template <int Rows, int Columns, class... X, class Motion>
struct rate<applied_node<op::entries<Rows, Columns>, X...>, Motion> {
  using type = decltype(apply<op::entries<Rows, Columns>>(rate_t<X, Motion>{}...));
};

template <class Tag, std::size_t I>
struct tag_of_entry {};

template <int Rows, int Columns, class Tag, std::size_t... I, class... X>
[[nodiscard]] constexpr auto assembled(std::index_sequence<I...>, const X&... x) {
  return apply<op::entries<Rows, Columns>>(term<tag_of_entry<Tag, I>>(x)...);
}

} // namespace detail

/// The Rows x Columns matrix of scalars, written row by row: `matrix<2, 2>(a, b, c, d)` has a and b
/// in its first row. 1 to 6 rows and columns.
template <int Rows, int Columns, class... X, class Tag = decltype([](op::entries<1, 2>*) {})>
  requires Operands<X...>
[[nodiscard]] constexpr auto matrix(const X&... x) {
  static_assert(1 <= Rows && Rows <= 6 && 1 <= Columns && Columns <= 6 && Rows * Columns > 1,
                "duet: a matrix in a formula has 1 to 6 rows and columns; of 1 x 1 it is a scalar");
  static_assert(sizeof...(X) == Rows * Columns,
                "duet: matrix<2, 4>(...) takes its 8 entries, row by row");
  return detail::assembled<Rows, Columns, Tag>(std::index_sequence_for<X...>{}, x...);
}

} // namespace duet::expression
