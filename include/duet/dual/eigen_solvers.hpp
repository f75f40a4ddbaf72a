// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/dual.hpp>
#include <duet/dual/storage/structural_zero.hpp>
#include <duet/dual/taylor.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

/// \file
/// Eigen's solvers over dual and Taylor numbers with entries that are zero but have derivatives.
///
/// Eigen skips work for entries that compare equal to zero, and duals compare by value, so the
/// derivatives of such entries would be lost. Two functions matter, and both are replaced here:
/// - substitution in triangular systems skips a zero entry of the right-hand side;
/// - a Householder reflector is omitted if the entries to be removed are zero already.
///
/// So LLT, LDLT, LU and every QR give the derivatives of their solutions, wherever the matrix is
/// regular, with Eigen 3.4 as with later ones. Householder reflectors differ from those over
/// `double` in one respect: if a column is zero below the diagonal but its derivatives are not,
/// there is one, which flips the sign of that row of R and column of Q. At a column that vanishes
/// altogether Q has no derivative, and Eigen's choice is kept: no reflector.
///
/// Not covered: reflectors of a vector that is not a block of another, `v.makeHouseholder(…)`.
/// Decompositions by Jacobi and Givens rotations are in dual/eigen_refused.hpp.
///
/// Eigen documents no means to replace the two. The specialised classes, `BlockImpl` and
/// `triangular_solve_vector`, are the same in 3.4, 5.0 and its main branch of August 2026; tests
/// with DUET_TEST_EIGEN (CONTRIBUTING.md) check others.

namespace duet::detail {

/// Solves a triangular system in place, column by column.
template <class Lhs, class Rhs, class Index, int Mode, bool Conjugate, bool RowMajor>
struct triangular_substitution {
  static void run(Index size, const Lhs* matrix, Index stride, Rhs* x) {
    constexpr bool lower = (Mode & Eigen::Lower) != 0;
    const auto at = [&](Index row, Index column) -> Lhs {
      const Lhs& entry = RowMajor ? matrix[row * stride + column] : matrix[row + column * stride];
      return Eigen::internal::conj_if<Conjugate>()(entry);
    };
    for (Index k = 0; k < size; ++k) {
      const Index i = lower ? k : size - 1 - k;
      if (is_structural_zero(x[i])) {
        continue;
      }
      if constexpr ((Mode & Eigen::UnitDiag) == 0) {
        x[i] /= at(i, i);
      }
      const Index begin = lower ? i + 1 : 0;
      const Index end = lower ? size : i;
      for (Index row = begin; row < end; ++row) {
        x[row] -= at(row, i) * x[i];
      }
    }
  }
};

template <class A, class B>
concept EitherInfinitesimal = Infinitesimal<A> || Infinitesimal<B>;

/// An expression of Eigen over dual or Taylor numbers; its type may be incomplete still.
template <class Expression>
concept InfinitesimalExpression =
    Infinitesimal<typename Eigen::internal::traits<Expression>::Scalar>;

/// Householder reflector H = 1 − τ v vᵀ with H x = (β, 0 … 0)ᵀ and v = (1, essential)ᵀ, as
/// `makeHouseholder` of Eigen:
///
///   β = −sign(x₀) ‖x‖,  essential = tail / (x₀ − β),  τ = (β − x₀) / β
///
/// H = 1 only if the tail of x is zero with all its derivatives, or if x vanishes. The essential
/// part may be the tail of x itself.
template <class Vector, class Essential, class Scalar>
void make_reflector(const Vector& x, Essential& essential, Scalar& tau, Scalar& beta) {
  using std::abs;
  using R = real_type_t<Scalar>;
  const Scalar head = x.coeff(0);
  R largest = abs(innermost(head));
  bool is_reduced = true;
  for (Eigen::Index i = 1; i < x.size(); ++i) {
    largest = std::max(largest, R(abs(innermost(x.coeff(i)))));
    is_reduced = is_reduced && is_structural_zero(x.coeff(i));
  }
  if (is_reduced || largest == R(0)) {
    tau = Scalar(0);
    beta = head;
    essential.setZero();
    return;
  }
  Scalar square(0); // of x / largest, which stays in range
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Scalar part = x.coeff(i) / largest;
    square += part * part;
  }
  const Scalar norm = sqrt(square) * largest;
  beta = head >= R(0) ? Scalar(-norm) : norm;
  for (Eigen::Index i = 1; i < x.size(); ++i) {
    essential.coeffRef(i - 1) = x.coeff(i) / (head - beta);
  }
  tau = (beta - head) / beta;
}

} // namespace duet::detail

namespace Eigen::internal {

template <class Lhs, class Rhs, class Index, int Mode, bool Conjugate>
  requires duet::detail::EitherInfinitesimal<Lhs, Rhs>
struct triangular_solve_vector<Lhs, Rhs, Index, OnTheLeft, Mode, Conjugate, ColMajor>
    : duet::detail::triangular_substitution<Lhs, Rhs, Index, Mode, Conjugate, false> {
};

template <class Lhs, class Rhs, class Index, int Mode, bool Conjugate>
  requires duet::detail::EitherInfinitesimal<Lhs, Rhs>
struct triangular_solve_vector<Lhs, Rhs, Index, OnTheLeft, Mode, Conjugate, RowMajor>
    : duet::detail::triangular_substitution<Lhs, Rhs, Index, Mode, Conjugate, true> {
};

} // namespace Eigen::internal

namespace Eigen {

/// Blocks of vectors of dual numbers, from which Eigen's decompositions make their reflectors: as
/// Eigen's own, but with reflectors that keep derivatives.
template <class Expression, int Rows, int Columns, bool InnerPanel>
  requires duet::detail::InfinitesimalExpression<Expression>
class BlockImpl<Expression, Rows, Columns, InnerPanel, Dense>
    : public internal::BlockImpl_dense<Expression, Rows, Columns, InnerPanel> {
public:
  using Base = internal::BlockImpl_dense<Expression, Rows, Columns, InnerPanel>;
  using Base::Base;
  EIGEN_INHERIT_ASSIGNMENT_OPERATORS(BlockImpl)

  template <class Essential, class Scalar>
  void makeHouseholder(Essential& essential, Scalar& tau, Scalar& beta) const {
    duet::detail::make_reflector(this->derived(), essential, tau, beta);
  }
  template <class Scalar>
  void makeHouseholderInPlace(Scalar& tau, Scalar& beta) {
    auto essential = this->tail(this->size() - 1);
    makeHouseholder(essential, tau, beta);
  }
};

} // namespace Eigen
