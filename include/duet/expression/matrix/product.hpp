// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/expression/arithmetic.hpp>
#include <duet/expression/matrix/block.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>

#include <Eigen/Core>

/// \file
/// Products of matrices and their traces.

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
};

/// tr(A B), without computing A B.
struct trace_of_product {
  static constexpr kind kind_of(kind, kind) { return kind::scalar; }
  template <class A, class B>
  static auto value(const A& a, const B& b) {
    using S = promote_t<typename A::Scalar, typename B::Scalar>;
    return S(detail::factor_over<S>(a).cwiseProduct(detail::factor_over<S>(b).transpose()).sum());
  }
};

/// tr A
struct trace {
  static constexpr detail::function_name name = {"trace", "\\operatorname{tr}"};
  static constexpr kind kind_of(kind) { return kind::scalar; }
  template <class M>
  static auto value(const M& m) {
    return typename M::Scalar(m.trace());
  }
};

} // namespace op
} // namespace duet::expression
