// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/dual.hpp>
#include <duet/dual/storage/structural_zero.hpp>
#include <duet/dual/taylor.hpp>

#include <Eigen/Core>

#include <algorithm>

/// \file
/// Eigen's solvers over dual and Taylor numbers, where an entry is zero but its derivative is not.
///
/// Eigen skips work for entries that compare equal to zero, and duals compare by value, so the
/// derivatives of such entries would be lost. Two places matter, and both are replaced here:
/// - substitution in triangular systems skips a zero entry of the right-hand side;
/// - a Householder reflector is left out where what it has to remove is zero already.
///
/// So LLT, LDLT, LU and every QR give the derivatives of what they solve, wherever the matrix is
/// regular. Householder reflectors differ from those over `double` in one way: one is made even
/// where the column is zero below the diagonal, which flips the sign of that row of R and column
/// of Q; HouseholderQR does so only where a derivative needs it, the pivoting QR always. At a
/// column that vanishes altogether Q has no derivative, and what Eigen does is kept.
///
/// Not covered: Jacobi and Givens rotations (SVD, eigenvalue solvers), which skip zeros by value
/// too. For symmetric matrices there is `symmetric_eigen`; else perturb the input or write the
/// derivative by hand where off-diagonal entries vanish. EigenSolver's derivatives are one step of
/// its iteration behind the values.

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

/// The imaginary part of a real number: zero, but it remembers whether the number is.
///
/// `makeHouseholder` leaves a reflector out where the tail of a column and the imaginary part of
/// its head are below a limit, and takes this part for nothing else.
template <Infinitesimal D>
struct imaginary_zero {
  bool head_vanishes;

  operator D() const { return D(0); }
  friend D abs(const imaginary_zero&) { return D(0); }
  friend bool operator==(const imaginary_zero&, const D& x) { return x == 0; }
};

/// |imaginary part|², below the limit only where no reflector can be made.
template <Infinitesimal D>
struct imaginary_zero_square {
  bool head_vanishes;

  operator D() const { return D(0); }
  friend bool operator<=(const imaginary_zero_square& x, const D&) { return x.head_vanishes; }
};

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

template <duet::Infinitesimal D>
struct imag_retval<D> {
  using type = duet::detail::imaginary_zero<D>;
};
template <duet::Infinitesimal D>
struct imag_impl<D> {
  static duet::detail::imaginary_zero<D> run(const D& x) { return {x == 0}; }
};
template <duet::Infinitesimal D>
struct abs2_retval<duet::detail::imaginary_zero<D>> {
  using type = duet::detail::imaginary_zero_square<D>;
};
template <duet::Infinitesimal D>
struct abs2_impl<duet::detail::imaginary_zero<D>> {
  static duet::detail::imaginary_zero_square<D> run(const duet::detail::imaginary_zero<D>& x) {
    return {x.head_vanishes};
  }
};

template <class Matrix, class Coefficients, class Scalar, bool InnerStrideIsOne>
struct householder_qr_inplace_blocked; // of Eigen/QR

/// Reflectors column by column, left out where the rest of the column is zero with all its
/// derivatives.
template <class Matrix, class Coefficients, duet::Infinitesimal Scalar, bool InnerStrideIsOne>
struct householder_qr_inplace_blocked<Matrix, Coefficients, Scalar, InnerStrideIsOne> {
  static void run(Matrix& matrix, Coefficients& coefficients, Index, Scalar* workspace) {
    const Index rows = matrix.rows();
    const Index columns = matrix.cols();
    for (Index k = 0; k < std::min(rows, columns); ++k) {
      bool triangular = true;
      for (Index i = k + 1; i < rows; ++i) {
        triangular = triangular && duet::detail::is_structural_zero(matrix.coeff(i, k));
      }
      if (triangular) {
        coefficients.coeffRef(k) = Scalar(0);
        continue;
      }
      Scalar pivot;
      matrix.col(k).tail(rows - k).makeHouseholderInPlace(coefficients.coeffRef(k), pivot);
      matrix.coeffRef(k, k) = pivot;
      matrix.bottomRightCorner(rows - k, columns - k - 1)
          .applyHouseholderOnTheLeft(matrix.col(k).tail(rows - k - 1), coefficients.coeffRef(k),
                                     workspace + k + 1);
    }
  }
};

} // namespace Eigen::internal
