// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/matrix_parts.hpp>
#include <duet/derivative/svd.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

/// \file
/// The rotation nearest to a matrix (orthogonal Procrustes problem, polar decomposition),
/// differentiated by its own equation.

namespace duet {
namespace detail {

/// A real matrix A₀ = R₀S₀ with R₀ a rotation and S₀ = V diag(λ)Vᵀ, λ the singular values, of which
/// the last has the sign of det A₀.
template <class R, int N>
struct polar_decomposition {
  using matrix = Eigen::Matrix<R, N, N>;

  template <class A>
  polar_decomposition(const char* function, const A& a) {
    const real_svd<R, N, N> svd(function, a);
    const Eigen::Index last = a.rows() - 1;
    scale = scale_of<R>(a);
    v = svd.v;
    lambda = svd.values * scale;
    u = svd.u;
    if (R(u.determinant() * v.determinant()) < 0) {
      u.col(last) = -u.col(last);
      lambda[last] = -lambda[last];
    }
    rounding = svd.rounding();
    gap = last == 0 ? svd.values[0] : R((lambda[last - 1] + lambda[last]) / scale);
  }

  matrix u, v; ///< R₀ = u vᵀ
  R scale; ///< a power of two that brings A near 1, so that its residual keeps its digits beside 1
  Eigen::Matrix<R, N, 1> lambda; ///< λ times `scale`
  R gap; ///< smallest sum of two λ: 0 if the nearest rotation is not unique
  R rounding;

  /// The correction of R for a real residual of `polar_residual`, both as columns.
  template <class Column>
  [[nodiscard]] Column step(const Column& residual) const {
    const Eigen::Index n = lambda.size();
    matrix x = residual.reshaped(n, n);
    x = v.transpose().lazyProduct(x).eval().lazyProduct(v).eval();
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index i = 0; i < j; ++i) {
        const R symmetric = (x(i, j) + x(j, i)) / 2;
        const R skew =
            (x(i, j) - x(j, i) + symmetric * (lambda[j] - lambda[i])) / (lambda[i] + lambda[j]);
        x(i, j) = symmetric + skew;
        x(j, i) = symmetric - skew;
      }
    }
    x = u.lazyProduct(x).eval().lazyProduct(v.transpose()).eval();
    return x.reshaped();
  }
};

/// (RᵀA − AᵀR)/2 + (1 − RᵀR)/2 as a column, of which the skew and the symmetric part must vanish.
template <class A, class Column>
[[nodiscard]] Column polar_residual(const A& a, const Column& r) {
  using S = typename Column::Scalar;
  const Eigen::Index n = a.rows();
  Column result(n * n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i < n; ++i) {
      S sum(i == j ? 1 : 0);
      for (Eigen::Index k = 0; k < n; ++k) {
        sum += r[k + i * n] * (a(k, j) - r[k + j * n]) - a(k, i) * r[k + j * n];
      }
      result[i + j * n] = sum / 2;
    }
  }
  return result;
}

/// R over all of A's scalar, given the decomposition of the values.
template <class S, class Polar, class A>
[[nodiscard]] auto rotation_of(const Polar& polar, const A& a) {
  constexpr int n = A::RowsAtCompileTime;
  using R = real_type_t<S>;
  const Eigen::Matrix<R, n, n> values = polar.u.lazyProduct(polar.v.transpose());
  Eigen::Matrix<S, n == Eigen::Dynamic ? n : n * n, 1> r = converted<S>(values).reshaped();
  if constexpr (scalar_traits<S>::order > 0) {
    const Eigen::Matrix<S, n, n> scaled = a * polar.scale;
    for (int order = 1; order <= scalar_traits<S>::order; ++order) {
      correct_infinitesimals(
          r, [&](const auto& residual) { return polar.step(residual); }, polar_residual(scaled, r));
    }
  }
  return Eigen::Matrix<S, n, n>(r.reshaped(a.rows(), a.rows()));
}

} // namespace detail

/// Rotation R that minimises ‖A − R‖ (Frobenius norm), det R = +1: orthogonal Procrustes problem.
///
/// \param a  A, n × n
///
/// With the singular value decomposition A = U diag(σ)Vᵀ, R = U diag(1, …, 1, s)Vᵀ, s the sign of
/// det U det V; if det A > 0 it is the rotation of the polar decomposition A = RS. (S. Umeyama,
/// IEEE Trans. PAMI 13 (1991) 376–380.) The derivatives follow from RᵀA = AᵀR and RᵀR = 1, order by
/// order:
///
///   dR = R V W Vᵀ,  W_ij = (B_ij − B_ji)/(λ_i + λ_j),  B = VᵀRᵀdA V,  λ = (σ₁, …, s σ_n).
///
/// They exist wherever R is unique, also at equal singular values, as at A = 1, and at one that is
/// 0. R is unique if σ_{n−1} + s σ_n > 0: not for a reflection whose two smallest singular values
/// are equal, as −1, nor for a matrix of rank n − 2.
///
/// \return an n × n matrix; for n = 3 `from_rotation_matrix` converts it to a quaternion
/// \throws invalid_input if A is not square, empty or not finite, or if σ_{n−1} + s σ_n is at most
///   4nε σ₁
template <class A>
[[nodiscard]] auto nearest_rotation(const Eigen::MatrixBase<A>& a) {
  using S = detail::common_scalar_t<A, A>;
  using R = real_type_t<S>;
  detail::require_square("nearest_rotation", a);
  constexpr int n = detail::min_size(A::RowsAtCompileTime, A::ColsAtCompileTime);
  const Eigen::Matrix<typename A::Scalar, n, n> matrix = a;
  const detail::polar_decomposition<R, n> polar("nearest_rotation", detail::real_values<R>(matrix));
  detail::require(polar.gap > polar.rounding,
                  "duet: nearest_rotation: the nearest rotation is not unique: the smallest two "
                  "singular values, the last with the sign of det A, add up to ",
                  polar.gap);
  return detail::rotation_of<S>(polar, matrix);
}

} // namespace duet
