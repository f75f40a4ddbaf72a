// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/derivative/linear_solve.hpp>
#include <duet/expression/algebra/arithmetic.hpp>
#include <duet/expression/algebra/product.hpp>
#include <duet/expression/elementary_functions.hpp>
#include <duet/expression/evaluate/pushforward.hpp>
#include <duet/expression/matrix/block.hpp>
#include <duet/expression/matrix/product.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/function.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/tree/printed.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <type_traits>
#include <utility>

/// \file
/// Of matrices: dot products and norms, trace, determinant, adjugate and inverse, and solutions of
/// linear equations.

namespace duet::expression {

namespace detail {

/// A without its I-th row and J-th column.
template <class M>
[[nodiscard]] auto minor_of(const M& m, int i, int j) {
  constexpr int n = M::RowsAtCompileTime - 1;
  Eigen::Matrix<typename M::Scalar, n, n> result;
  for (int column = 0; column < n; ++column) {
    for (int row = 0; row < n; ++row) {
      result(row, column) = m(row + (row >= i), column + (column >= j));
    }
  }
  return result;
}

/// By products and sums alone: elimination would divide by pivots, and so have no derivative where
/// A is singular.
template <class M>
[[nodiscard]] auto determinant_of(const M& m) {
  using T = typename M::Scalar;
  if constexpr (M::RowsAtCompileTime <= 4) {
    return T(m.determinant());
  } else {
    T sum(0);
    for (int i = 0; i < int(M::RowsAtCompileTime); ++i) {
      const T term = m(i, 0) * determinant_of(minor_of(m, i, 0));
      sum = i % 2 == 0 ? T(sum + term) : T(sum - term);
    }
    return sum;
  }
}

} // namespace detail

namespace op {

/// adj A, of which A adj A = det A.
struct adjugate {
  static constexpr kind kind_of(kind m) { return m; }
  template <class M>
  static constexpr auto simplified(M m) {
    if constexpr (M::kind_of == kind::scalar) {
      return whole<1>;
    } else if constexpr (is_applied<M, transpose>) {
      return apply<transpose>(apply<adjugate>(operand<0>(m)));
    } else {
      return applied_node<adjugate, M>{};
    }
  }
  template <class M>
  static auto value(const M& m) {
    using T = typename M::Scalar;
    constexpr int n = M::RowsAtCompileTime;
    Eigen::Matrix<T, n, n> result;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const T cofactor = detail::determinant_of(detail::minor_of(m, i, j));
        result(j, i) = (i + j) % 2 == 0 ? cofactor : T(-cofactor);
      }
    }
    return result;
  }
  template <class M, class DM>
  static constexpr auto differential(M m, DM dm) {
    if constexpr (rows_of(M::kind_of) == 2) { // linear in its entries
      return apply<adjugate>(dm);
    } else {
      return apply<pushforward<adjugate, std::index_sequence<0>>>(m, dm);
    }
  }
  static printed print(notation style, const printed& m) {
    return detail::printed_call(style, {"adjugate", "\\operatorname{adj}"}, m.text);
  }
};

/// det A
struct determinant {
  static constexpr kind kind_of(kind) { return kind::scalar; }
  template <class M>
  static constexpr auto simplified(M m) {
    if constexpr (M::kind_of == kind::scalar) {
      return m;
    } else if constexpr (is_zero<M>) {
      return whole<0>;
    } else if constexpr (is_applied<M, transpose>) {
      return apply<determinant>(operand<0>(m));
    } else {
      return applied_node<determinant, M>{};
    }
  }
  template <class M>
  static auto value(const M& m) {
    return detail::determinant_of(m);
  }
  template <class M, class DM>
  static constexpr auto differential(M m, DM dm) {
    return apply<trace_of_product>(apply<adjugate>(m), dm);
  }
  static printed print(notation style, const printed& m) {
    return detail::printed_call(style, {"determinant", "\\det"}, m.text);
  }
};

/// A⁻¹
struct inverse {
  static constexpr kind kind_of(kind m) { return m; }
  template <class M>
  static constexpr auto simplified(M m) {
    if constexpr (M::kind_of == kind::scalar) {
      return whole<1> / m;
    } else {
      return applied_node<inverse, M>{};
    }
  }
  template <class M>
  static auto value(const M& m) {
    return M(duet::solve(m, M(M::Identity())));
  }
  template <class M, class DM>
  static constexpr auto differential(M m, DM dm) {
    return -(apply<inverse>(m) * dm * apply<inverse>(m));
  }
  static printed print(notation style, const printed& m) {
    return style == notation::latex
               ? printed{m.inside(precedence::atom) + "^{-1}", precedence::power}
               : printed{"inverse(" + m.text + ")"};
  }
};

/// A⁻¹ b, by elimination; its derivatives share one inverse.
struct solution {
  static constexpr kind kind_of(kind, kind b) { return b; }
  template <class A, class B>
  static constexpr auto simplified(A a, B b) {
    if constexpr (A::kind_of == kind::scalar) {
      return b / a;
    } else if constexpr (is_zero<B>) {
      return b;
    } else {
      return applied_node<solution, A, B>{};
    }
  }
  template <class A, class B>
  static auto value(const A& a, const B& b) {
    using S = promote_t<typename A::Scalar, typename B::Scalar>;
    return Eigen::Matrix<S, B::RowsAtCompileTime, B::ColsAtCompileTime>(duet::solve(a, b));
  }
  template <class A, class B, class DA, class DB>
  static constexpr auto differential(A a, B, DA da, DB db) {
    return apply<inverse>(a) * (db - da * applied_node<solution, A, B>{});
  }
  static printed print(notation style, const printed& a, const printed& b) {
    return style == notation::latex ? matrix_product::print(style, inverse::print(style, a), b)
                                    : printed{"solve(" + a.text + ", " + b.text + ")"};
  }
};

} // namespace op

namespace detail {

template <class T>
concept ScalarOrMatrix = ScalarTerm<T> || MatrixTerm<T>;

template <class M>
constexpr void require_square_matrix() {
  constexpr kind k = kind_of_term<M>();
  static_assert(rows_of(k) == columns_of(k),
                "duet: trace, determinant, adjugate, inverse and solve take a square matrix");
}

} // namespace detail

/// Σ A_ij B_ij of two matrices of one size: xᵀ y of columns, tr(Aᵀ B) of others.
template <class A, class B, class TagA = decltype([](op::inverse*) {}),
          class TagB = decltype([](op::inverse*) {})>
  requires detail::SizedOperands<A, B>
[[nodiscard]] constexpr auto dot(const A& a, const B& b) {
  static_assert(detail::kind_of_operand<A>() == detail::kind_of_operand<B>(),
                "duet: dot(A, B) takes two vectors or matrices of one size");
  return apply<op::trace>(apply<op::transpose>(detail::term<TagA>(a)) * detail::term<TagB>(b));
}
/// √(Σ A_ij²), the Euclidean norm of a column and the Frobenius norm of a matrix, whose squares
/// must not overflow. Not differentiable at 0.
template <Term M>
  requires(is_sized_matrix(detail::kind_of_term<M>()))
[[nodiscard]] constexpr auto norm(const M& m) { return sqrt(dot(m, m)); }

/// tr A, the sum of the diagonal of a square matrix.
template <detail::ScalarOrMatrix M>
[[nodiscard]] constexpr auto trace(const M& m) {
  detail::require_square_matrix<M>();
  return apply<op::trace>(m);
}
/// det A of a square matrix, a polynomial of its entries with the derivative tr(adj(A) dA), of
/// every matrix, singular ones included.
template <detail::ScalarOrMatrix M>
[[nodiscard]] constexpr auto determinant(const M& m) {
  detail::require_square_matrix<M>();
  return apply<op::determinant>(m);
}
/// adj A, the transposed cofactors of a square matrix: A adj A = det A, of every matrix.
template <detail::ScalarOrMatrix M>
[[nodiscard]] constexpr auto adjugate(const M& m) {
  detail::require_square_matrix<M>();
  return apply<op::adjugate>(m);
}
/// A⁻¹ of a square matrix, with the derivative −A⁻¹ dA A⁻¹. Its evaluation throws `invalid_input`
/// where A is singular or not finite, as `duet::solve` does.
template <detail::ScalarOrMatrix M>
[[nodiscard]] constexpr auto inverse(const M& m) {
  detail::require_square_matrix<M>();
  return apply<op::inverse>(m);
}
/// The x with A x = b, of a square matrix and a vector or matrix b of as many rows, with the
/// derivative A⁻¹(db − dA x). Its evaluation throws `invalid_input` where A is singular or not
/// finite, as `duet::solve` does.
template <class A, class B, class TagA = decltype([](op::inverse*) {}),
          class TagB = decltype([](op::inverse*) {})>
  requires Operands<A, B>
[[nodiscard]] constexpr auto solve(const A& a, const B& b) {
  const auto matrix = detail::term<TagA>(a);
  const auto right = detail::term<TagB>(b);
  using matrix_type = std::remove_const_t<decltype(matrix)>;
  using right_type = std::remove_const_t<decltype(right)>;
  detail::require_square_matrix<matrix_type>();
  static_assert(rows_of(detail::kind_of_term<matrix_type>()) ==
                    rows_of(detail::kind_of_term<right_type>()),
                "duet: solve(A, b): b must have as many rows as A");
  return apply<op::solution>(matrix, right);
}

} // namespace duet::expression
