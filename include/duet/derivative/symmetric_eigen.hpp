// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/structure.hpp>
#include <duet/derivative/matrix_parts.hpp>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

/// \file
/// Eigenvalues and eigenvectors of symmetric matrices, differentiated by their own equations
/// instead of through rotations that skip zeros.

namespace duet {

/// A = V diag(λ) Vᵀ: the eigenvalues ascend, and column i of `vectors` belongs to the i-th.
template <class Values, class Vectors>
struct symmetric_eigen_result {
  Values values = detail::zero_initialized<Values>();    ///< λ, ascending, a column
  Vectors vectors = detail::zero_initialized<Vectors>(); ///< V, unit eigenvectors as columns

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("values", values);
    f("vectors", vectors);
  }
};
template <class Values, class Vectors>
symmetric_eigen_result(Values, Vectors) -> symmetric_eigen_result<Values, Vectors>;

namespace detail {

/// \throws invalid_input if two of the ascending eigenvalues are equal to round-off.
template <class Values>
void require_distinct(const Values& values) {
  using std::abs;
  using R = typename Values::Scalar;
  const Eigen::Index n = values.size();
  const R low = abs(values[0]);
  const R high = abs(values[n - 1]);
  const R rounding = R(4 * n) * std::numeric_limits<R>::epsilon() * std::max(low, high);
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    const R gap = values[i + 1] - values[i];
    require(!(gap <= rounding), "duet: symmetric_eigen: eigenvalues ", i, " and ", i + 1, ", both ",
            values[i], " with a gap of ", gap, ", have no derivatives, as A is not constant");
  }
}

/// Residual of the bordered equations of one eigenpair y = (v, λ):
///
///   A v − λ v = 0,  (1 − vᵀv)/2 = 0.
///
/// Reads the lower triangle of A.
template <class A, class Y>
[[nodiscard]] Y eigen_residual(const A& a, const Y& y) {
  using S = typename Y::Scalar;
  const Eigen::Index n = a.rows();
  Y r(n + 1);
  S square = S(1);
  for (Eigen::Index i = 0; i < n; ++i) {
    r[i] = -(y[n] * y[i]);
    for (Eigen::Index j = 0; j < n; ++j) {
      r[i] += (i >= j ? a(i, j) : a(j, i)) * y[j];
    }
    square -= y[i] * y[i];
  }
  r[n] = square / 2;
  return r;
}

/// Correction of eigenpair j for a real residual: in the basis of the eigenvectors the only entries
/// of the bordered matrix are λ_i − λ_j on its diagonal and the border.
template <class Solver, class Y>
[[nodiscard]] Y eigen_step(const Solver& solver, Eigen::Index j, const Y& residual) {
  using R = typename Y::Scalar;
  const auto& vectors = solver.eigenvectors();
  const auto& values = solver.eigenvalues();
  const Eigen::Index n = values.size();
  constexpr int size = std::decay_t<decltype(values)>::RowsAtCompileTime;
  auto v = (vectors.transpose() * residual.template head<size>(n)).eval();
  Y step(n + 1);
  step[n] = v[j];
  for (Eigen::Index i = 0; i < n; ++i) {
    v[i] = i == j ? residual[n] : R(v[i] / R(values[j] - values[i]));
  }
  step.template head<size>(n) = vectors * v;
  return step;
}

} // namespace detail

/// Eigenvalues, ascending, and unit eigenvectors of a symmetric matrix.
///
/// \param a  A, of which the lower triangle is read, as Eigen does
///
/// The values are those of `Eigen::SelfAdjointEigenSolver` over real numbers, to the last bit, also
/// the signs of the vectors. The derivatives follow from A v = λ v and vᵀv = 1,
///
///   dλ_j = v_jᵀ dA v_j,  dv_j = Σ_{i≠j} v_i (v_iᵀ dA v_j)/(λ_j − λ_i),
///
/// and so on order by order: each step of Newton's method in the algebra of the infinitesimals,
/// with the bordered matrix of the values, makes one more order exact. Their relative error is
/// about ε max|λ|/gap for vectors, and grows with every order by another such factor.
///
/// A repeated eigenvalue has neither unique vectors nor derivatives: where it splits, its vectors
/// jump. If a gap is at most 4nε max|λ|, and so only round-off, A must be a constant: all its
/// infinitesimal parts zero.
///
/// \return `symmetric_eigen_result`
/// \throws invalid_input if A is not square or has entries that are not finite, and at a repeated
///   eigenvalue of a matrix that is not constant.
/// \throws no_convergence if Eigen's solver does not converge.
template <class A>
[[nodiscard]] auto symmetric_eigen(const Eigen::MatrixBase<A>& a) {
  using S = detail::common_scalar_t<A, A>;
  using R = real_type_t<S>;
  detail::require_square("symmetric_eigen", a);
  const auto& matrix = a.eval();
  const auto lower =
      detail::real_values<R>(a.template triangularView<Eigen::Lower>().toDenseMatrix());
  detail::require_finite("symmetric_eigen", lower);
  const Eigen::SelfAdjointEigenSolver<std::remove_const_t<decltype(lower)>> solver(lower);
  if (solver.info() != Eigen::Success) {
    detail::raise(no_convergence("duet: symmetric_eigen: Eigen's solver did not converge"));
  }
  symmetric_eigen_result result{detail::converted<S>(solver.eigenvalues()),
                                detail::converted<S>(solver.eigenvectors())};
  if constexpr (scalar_traits<S>::order > 0) {
    if (detail::is_constant(a.template triangularView<Eigen::Lower>().toDenseMatrix())) {
      return result;
    }
    detail::require_distinct(solver.eigenvalues());
    constexpr int size = decltype(result.values)::RowsAtCompileTime;
    const Eigen::Index n = a.rows();
    for (Eigen::Index j = 0; j < n; ++j) {
      Eigen::Matrix<S, size == Eigen::Dynamic ? Eigen::Dynamic : size + 1, 1> pair(n + 1);
      pair.head(n) = result.vectors.col(j);
      pair[n] = result.values[j];
      for (int order = 1; order <= scalar_traits<S>::order; ++order) {
        detail::correct_infinitesimals(
            pair, [&](const auto& residual) { return detail::eigen_step(solver, j, residual); },
            detail::eigen_residual(matrix, pair));
      }
      result.vectors.col(j) = pair.head(n);
      result.values[j] = pair[n];
    }
  }
  return result;
}

} // namespace duet
