// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/expression/algebra/arithmetic.hpp>
#include <duet/expression/algebra/product.hpp>
#include <duet/expression/matrix/block.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/printed.hpp>
#include <duet/expression/vector.hpp>

#include <Eigen/Core>

#include <algorithm>

/// \file
/// Products of matrices and their traces. If a factor is 0 outside of a block, only those rows or
/// columns of the other one that meet the block are multiplied.

namespace duet::expression {

namespace detail {

/// A factor, converted to S if that is a field: products of dual numbers and their parts need none.
template <class S, class M>
[[nodiscard]] decltype(auto) factor_over(const M& m) {
  if constexpr (Field<S>) {
    return m.template cast<S>();
  } else {
    return (m);
  }
}

} // namespace detail

namespace op {

struct matrix_product {
  static constexpr kind kind_of(kind a, kind b) { return matrix_kind(rows_of(a), columns_of(b)); }
  template <class A, class B>
  static constexpr auto simplified(A a, B b) {
    static_assert(columns_of(A::kind_of) == rows_of(B::kind_of),
                  "duet: a product of matrices of sizes that do not fit: the first must have as "
                  "many columns as the second has rows");
    constexpr int rows = rows_of(A::kind_of), columns = columns_of(B::kind_of);
    if constexpr (is_zero<A> || is_zero<B>) {
      return zero_of<matrix_kind(rows, columns)>();
    } else if constexpr (detail::is_scaled<A>) {
      return detail::scaled_outside(a, [](auto x) { return x * B{}; });
    } else if constexpr (detail::is_scaled<B>) {
      return detail::scaled_outside(b, [](auto x) { return A{} * x; });
    } else if constexpr (detail::sparsity<A>::is_sparse) {
      using s = detail::sparsity<A>;
      return apply<embedded_block<rows, columns, s::row, 0>>(
          typename s::block{} * apply<block<s::column, 0, s::columns, columns>>(b));
    } else if constexpr (detail::sparsity<B>::is_sparse) {
      using s = detail::sparsity<B>;
      return apply<embedded_block<rows, columns, 0, s::column>>(
          apply<block<0, s::row, rows, s::rows>>(a) * typename s::block{});
    }
  }
  template <class A, class B>
  static auto value(const A& a, const B& b) {
    using S = promote_t<typename A::Scalar, typename B::Scalar>;
    constexpr int rows = A::RowsAtCompileTime, columns = B::ColsAtCompileTime;
    const Eigen::Matrix<S, rows, columns> result =
        detail::factor_over<S>(a).lazyProduct(detail::factor_over<S>(b));
    if constexpr (rows == 1 && columns == 1) {
      return S(result(0, 0));
    } else {
      return result;
    }
  }
  static constexpr auto differential(auto a, auto b, auto da, auto db) { return da * b + a * db; }
  static printed print(notation style, const printed& a, const printed& b) {
    return product::print(style, a, b);
  }
};

/// tr(A B), without computing A B.
struct trace_of_product : bilinear_operation {
  static constexpr kind kind_of(kind, kind) { return kind::scalar; }
  template <class A, class B>
  static constexpr auto simplified(A a, B b);
  template <class A, class B>
  static auto value(const A& a, const B& b) {
    using S = promote_t<typename A::Scalar, typename B::Scalar>;
    return S(detail::factor_over<S>(a).cwiseProduct(detail::factor_over<S>(b).transpose()).sum());
  }
  static printed print(notation style, const printed& a, const printed& b);
};

/// tr A
struct trace : linear_operation {
  static constexpr detail::function_name name = {"trace", "\\operatorname{tr}"};
  static constexpr kind kind_of(kind) { return kind::scalar; }
  template <class M>
  static constexpr auto simplified(M m) {
    if constexpr (M::kind_of == kind::scalar) {
      return m;
    } else if constexpr (detail::is_scaled<M>) {
      return detail::scaled_outside(m, [](auto x) { return apply<trace>(x); });
    } else if constexpr (is_applied<M, transpose>) {
      return apply<trace>(operand<0>(m));
    } else if constexpr (is_applied<M, matrix_product>) {
      return apply<trace_of_product>(operand<0>(m), operand<1>(m));
    } else if constexpr (detail::is_embedded_block<M>) {
      return of_sparse<detail::sparsity<M>>();
    }
  }
  template <class M>
  static auto value(const M& m) {
    return typename M::Scalar(m.trace());
  }

private:
  /// Trace of a matrix that is 0 outside of a block: that of the part of the block on the diagonal.
  template <class S>
  static constexpr auto of_sparse() {
    constexpr int begin = std::max(S::row, S::column);
    constexpr int size = std::min(S::row + S::rows, S::column + S::columns) - begin;
    if constexpr (size <= 0) {
      return whole<0>;
    } else {
      return apply<trace>(
          apply<block<begin - S::row, begin - S::column, size, size>>(typename S::block{}));
    }
  }
};

template <class A, class B>
constexpr auto trace_of_product::simplified(A a, B b) {
  if constexpr (detail::is_scaled<A> || detail::is_scaled<B> || detail::sparsity<A>::is_sparse) {
    return apply<trace>(a * b);
  } else if constexpr (detail::sparsity<B>::is_sparse) {
    return apply<trace>(b * a);
  }
}

inline printed trace_of_product::print(notation style, const printed& a, const printed& b) {
  return detail::printed_operation<trace>(style, matrix_product::print(style, a, b));
}

} // namespace op
} // namespace duet::expression
