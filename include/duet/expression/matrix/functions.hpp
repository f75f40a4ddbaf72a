// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/derivative/linear_solve.hpp>
#include <duet/expression/arithmetic.hpp>
#include <duet/expression/elementary_functions.hpp>
#include <duet/expression/matrix/block.hpp>
#include <duet/expression/matrix/product.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/latex_arithmetic.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/tree/printed.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

/// \file
/// Dot products, norms, trace, determinant, adjugate and inverse of matrices, and solutions of
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

/// Determinant by cofactors, which is differentiable everywhere. Elimination would divide by pivots
/// and have no derivative where A is singular.
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

/// adj A, with A adj A = det A times the identity.
struct adjugate {
  static constexpr detail::function_name name = {"adjugate", "\\operatorname{adj}"};
  static constexpr kind kind_of(kind m) { return m; }
  static constexpr auto simplified(auto m) {
    return m.of_kind() == kind::scalar  ? m.at(1)
           : m.template is<transpose>() ? apply<transpose>(apply<adjugate>(m.operand(0)))
                                        : m.none();
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
  /// Derivative for 2 x 2, where adj A is linear in the entries.
  static constexpr auto differential(auto m, auto dm) {
    return rows_of(m.of_kind()) == 2 ? apply<adjugate>(dm) : m.none();
  }
};

/// det A
struct determinant {
  static constexpr detail::function_name name = {"determinant", "\\det"};
  static constexpr kind kind_of(kind) { return kind::scalar; }
  static constexpr auto simplified(auto m) {
    return m.of_kind() == kind::scalar  ? m
           : m.is_zero()                ? m.at(0)
           : m.template is<transpose>() ? apply<determinant>(m.operand(0))
                                        : m.none();
  }
  static auto value(const auto& m) { return detail::determinant_of(m); }
  static constexpr auto differential(auto m, auto dm) {
    return apply<trace_of_product>(apply<adjugate>(m), dm);
  }
};

/// A⁻¹
struct inverse {
  static constexpr detail::function_name name = {"inverse", "#^{-1}"};
  static constexpr kind kind_of(kind m) { return m; }
  static constexpr auto simplified(auto m) {
    return m.of_kind() == kind::scalar ? whole<1> / m : m.none();
  }
  template <class M>
  static auto value(const M& m) {
    return M(duet::solve(m, M(M::Identity())));
  }
  static constexpr auto differential(auto m, auto dm) {
    return -(apply<inverse>(m) * dm * apply<inverse>(m));
  }
};

/// A⁻¹ b, by elimination; its derivatives share one inverse.
struct solution {
  static constexpr kind kind_of(kind, kind b) { return b; }
  static constexpr auto simplified(auto a, auto b) {
    return a.of_kind() == kind::scalar ? b / a : b.is_zero() ? b : a.none();
  }
  template <class A, class B>
  static auto value(const A& a, const B& b) {
    using S = promote_t<typename A::Scalar, typename B::Scalar>;
    return Eigen::Matrix<S, B::RowsAtCompileTime, B::ColsAtCompileTime>(duet::solve(a, b));
  }
  static constexpr auto differential(auto a, auto b, auto da, auto db) {
    return apply<inverse>(a) * (db - da * apply<solution>(a, b));
  }
  static printed print(notation style, const printed& a, const printed& b) {
    return style != notation::text
               ? product::print(
                     style,
                     detail::latex_of_kind(detail::printed_operation<inverse>(style, a), false), b)
               : printed{"solve(" + a.text + ", " + b.text + ")"};
  }
};

} // namespace op

namespace detail {

template <class T>
concept ScalarOrMatrix = ScalarTerm<T> || MatrixTerm<T>;

template <class M>
constexpr void require_square_matrix() {
  constexpr kind k = kind_of_operand<M>();
  static_assert(rows_of(k) == columns_of(k),
                "duet: trace, determinant, adjugate, inverse and solve take a square matrix");
}

template <class Operation, class M>
[[nodiscard]] constexpr auto apply_to_square(const M& m) {
  require_square_matrix<M>();
  return apply<Operation>(m);
}

} // namespace detail

/// Σ A_ij B_ij of two matrices of equal size: xᵀ y of columns, tr(Aᵀ B) of others.
template <class A, detail::SizedOperands<A> B, class Tag = decltype([](op::inverse*) {})>
[[nodiscard]] constexpr auto dot(const A& a, const B& b) {
  static_assert(detail::kind_of_operand<A>() == detail::kind_of_operand<B>(),
                "duet: dot(A, B) takes two vectors or matrices of one size");
  return apply<op::trace>(apply<op::transpose>(detail::term<Tag>(a)) * detail::term<Tag>(b));
}
/// √(Σ A_ij²), the Euclidean norm of a column and the Frobenius norm of a matrix. The squares must
/// not overflow. Not differentiable at 0.
template <Term M>
  requires(is_sized_matrix(detail::kind_of_term<M>()))
[[nodiscard]] constexpr auto norm(const M& m) { return sqrt(dot(m, m)); }

/// tr A, the sum of the diagonal of a square matrix.
[[nodiscard]] constexpr auto trace(const detail::ScalarOrMatrix auto& m) {
  return detail::apply_to_square<op::trace>(m);
}
/// det A of a square matrix, with the derivative tr(adj(A) dA), even if A is singular.
[[nodiscard]] constexpr auto determinant(const detail::ScalarOrMatrix auto& m) {
  return detail::apply_to_square<op::determinant>(m);
}
/// adj A, the transposed cofactors of a square matrix: A adj A is det A times the identity, even if
/// A is singular.
[[nodiscard]] constexpr auto adjugate(const detail::ScalarOrMatrix auto& m) {
  return detail::apply_to_square<op::adjugate>(m);
}
/// A⁻¹ of a square matrix, with the derivative −A⁻¹ dA A⁻¹. Its evaluation throws `invalid_input`
/// if A is singular or not finite, as `duet::solve` does.
[[nodiscard]] constexpr auto inverse(const detail::ScalarOrMatrix auto& m) {
  return detail::apply_to_square<op::inverse>(m);
}
/// The solution x of A x = b for a square matrix A and a vector or matrix b with as many rows. Its
/// derivative is A⁻¹(db − dA x). Its evaluation throws `invalid_input` if A is singular or not
/// finite, as `duet::solve` does.
template <class A, Operands<A> B, class Tag = decltype([](op::inverse*) {})>
[[nodiscard]] constexpr auto solve(const A& a, const B& b) {
  detail::require_square_matrix<A>();
  static_assert(rows_of(detail::kind_of_operand<A>()) == rows_of(detail::kind_of_operand<B>()),
                "duet: solve(A, b): b must have as many rows as A");
  return apply<op::solution>(detail::term<Tag>(a), detail::term<Tag>(b));
}

} // namespace duet::expression
