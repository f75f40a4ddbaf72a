// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/matrix_parts.hpp>

#include <Eigen/Core>
#include <Eigen/QR>

#include <type_traits>

/// \file
/// Linear least squares, differentiated by the normal equations but computed without them.

namespace duet {
namespace detail {

/// \throws invalid_input if A x = b is not a valid least-squares problem.
template <class A, class B>
void require_tall(const A& a, const B& b) {
  static_assert(int(A::RowsAtCompileTime) >= int(A::ColsAtCompileTime) ||
                    A::RowsAtCompileTime == Eigen::Dynamic,
                "duet: least_squares: A must have as many rows as columns, or more");
  static_assert(can_be_same(A::RowsAtCompileTime, B::RowsAtCompileTime),
                "duet: least_squares: b must have as many rows as A");
  require(a.rows() >= a.cols(), "duet: least_squares: A is ", a.rows(), " x ", a.cols(),
          ": fewer equations than unknowns");
  require(a.cols() > 0, "duet: least_squares: A is empty");
  require(a.rows() == b.rows(), "duet: least_squares: A has ", a.rows(), " rows, but b ", b.rows());
}

/// qr.solve(b) for A of full rank, the same operations as Eigen's with fewer than 48 columns: one
/// Householder reflection after the other. The blocked products for more columns take compilers
/// longer than all else here.
template <class QR, class B>
[[nodiscard]] auto solve_by_reflections(const QR& qr, const B& b) {
  using R = typename B::Scalar;
  constexpr int size = QR::ColsAtCompileTime, columns = B::ColsAtCompileTime;
  const Eigen::Index m = qr.rows(), n = qr.cols();
  B c = b;
  Eigen::Matrix<R, 1, columns> workspace(b.cols());
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Block<B, Eigen::Dynamic, Eigen::Dynamic> below(c, k, 0, m - k, b.cols());
    below.applyHouseholderOnTheLeft(qr.matrixQR().col(k).tail(m - k - 1), qr.hCoeffs()[k],
                                    workspace.data());
  }
  qr.matrixQR()
      .template topLeftCorner<size, size>(n, n)
      .template triangularView<Eigen::Upper>()
      .solveInPlace(c.template topRows<size>(n));
  return (qr.colsPermutation() * c.template topRows<size>(n)).eval();
}

/// (AᵀA)⁻¹ g = P R⁻¹R⁻ᵀPᵀ g for A P = Q R.
template <class QR, class G>
[[nodiscard]] G solve_normal_equations(const QR& qr, const G& g) {
  const Eigen::Index n = qr.cols();
  constexpr int size = QR::ColsAtCompileTime;
  const auto r = qr.matrixQR().template topLeftCorner<size, size>(n, n);
  G x = qr.colsPermutation().transpose() * g;
  r.template triangularView<Eigen::Upper>().transpose().solveInPlace(x);
  r.template triangularView<Eigen::Upper>().solveInPlace(x);
  return qr.colsPermutation() * x;
}

/// Every entry times a real number; infinite entries have no part 0 · ∞.
template <class Derived, class R>
[[nodiscard]] auto times(const Eigen::MatrixBase<Derived>& a, const R& factor) {
  using S = typename Derived::Scalar;
  return a.unaryExpr([&](const S& x) { return S(x * factor); }).eval();
}

/// (A − A₀)ᵀ r, A₀ the values of A
template <class S, class A, class X>
[[nodiscard]] auto transposed_slope_times(const A& a, const X& r) {
  Eigen::Matrix<S, A::ColsAtCompileTime, X::ColsAtCompileTime,
                A::ColsAtCompileTime == 1 && X::ColsAtCompileTime != 1 ? Eigen::RowMajor
                                                                       : Eigen::ColMajor>
      g(a.cols(), r.cols());
  for (Eigen::Index j = 0; j < r.cols(); ++j) {
    for (Eigen::Index k = 0; k < a.cols(); ++k) {
      g(k, j) = S(0);
      for (Eigen::Index i = 0; i < a.rows(); ++i) {
        g(k, j) += S((a(i, k) - innermost(a(i, k))) * r(i, j));
      }
    }
  }
  return g;
}

} // namespace detail

/// The x that minimises ‖A x − b‖, over the scalars that those of A and b promote to.
///
/// \param a  A, m × n of rank n
/// \param b  a vector, or a matrix of right-hand sides
///
/// The values are those of `Eigen::ColPivHouseholderQR` over real numbers: of Eigen 3.4 to the last
/// bit, if b is a vector or A has fewer than 48 columns and the compiler does not fuse products and
/// sums. The derivatives follow from Aᵀ(b − A x) = 0,
///
///   dx = A⁺(db − dA x) + (AᵀA)⁻¹dAᵀ(b − A x),
///
/// and so on order by order with the one factorisation A₀P = QR of the values: each step
/// x ← x + (A₀ᵀA₀)⁻¹Aᵀ(b − A x) in the algebra of the infinitesimals makes one more order exact.
/// A₀ᵀ(b − A x) is never formed, so that the square of the condition number cond(A) multiplies only
/// the residual of b.
///
/// \throws invalid_input if sizes do not match, if A has entries that are not finite, and if the
///   rank that Eigen finds is not n. Columns whose sizes differ by 1/ε count as dependent: choose
///   the units of the unknowns accordingly.
template <class A, class B>
[[nodiscard]] auto least_squares(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  using S = detail::common_scalar_t<A, B>;
  static_assert(!std::is_same_v<S, detail::no_promotion>,
                "duet: least_squares: the scalars of A and b have no common type");
  using R = real_type_t<S>;
  detail::require_tall(a, b);
  auto matrix = detail::real_values<R>(a);
  detail::require_finite("least_squares", matrix);
  const R scale = detail::scale_of<R>(matrix); // exact, so that no bit of a result depends on it
  matrix *= scale;
  const Eigen::ColPivHouseholderQR<decltype(matrix)> qr(matrix);
  detail::require(qr.rank() == a.cols(), "duet: least_squares: A has rank ", qr.rank(),
                  ", less than its ", a.cols(), " columns");
  const auto values = detail::solve_by_reflections(qr, detail::real_values<R>(b));
  if constexpr (scalar_traits<S>::order == 0) {
    return (values * scale).eval();
  } else {
    auto x = detail::converted<S>(values);
    const bool is_constant = detail::is_constant(a);
    if (is_constant && detail::is_constant(b)) {
      return detail::times(x, scale);
    }
    using coefficient = promote_t<detail::differentiable_t<typename A::Scalar>, R>;
    const auto coefficients = detail::times(detail::converted<coefficient>(a), scale);
    const auto right = detail::converted<S>(b);
    for (int order = 1; order <= scalar_traits<S>::order; ++order) {
      const auto r = detail::residual(coefficients, right, x);
      detail::correct_infinitesimals(
          x, [&](const auto& column) { return detail::solve_by_reflections(qr, column); }, r);
      if (!is_constant) {
        detail::correct_infinitesimals(
            x, [&](const auto& g) { return detail::solve_normal_equations(qr, g); },
            detail::transposed_slope_times<S>(coefficients, r));
      }
    }
    return detail::times(x, scale);
  }
}

/// The part of a desired joint step that does not move the tip: the projection
/// (1 − Jᵀ(J Jᵀ)⁻¹J) z onto the null space of J, with derivatives with respect to both.
///
/// Computed as the residual of `least_squares(Jᵀ, z)`, without squares of the condition number.
///
/// \param jacobian  J, m × n of rank m, as the Jacobian of a redundant arm
/// \param z         desired step of n coordinates
/// \return a column of n coordinates
/// \throws invalid_input if sizes do not match, or J loses rank, at a singularity or with m > n
template <class J, class Z>
[[nodiscard]] auto null_space_step(const Eigen::MatrixBase<J>& jacobian,
                                   const Eigen::MatrixBase<Z>& z) {
  const auto across = jacobian.transpose().eval();
  const auto x = least_squares(across, z);
  using S = typename std::decay_t<decltype(x)>::Scalar;
  return (detail::converted<S>(z) - detail::converted<S>(across) * x).eval();
}

} // namespace duet
