// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/structure.hpp>
#include <duet/derivative/matrix_parts.hpp>

#include <Eigen/Core>
#include <Eigen/SVD>

#include <algorithm>
#include <limits>

/// \file
/// Singular value decomposition, differentiated by its own equations.

namespace duet {

/// A = U diag(σ) Vᵀ, thin: σ descends, and column i of `u` and of `v` belongs to σᵢ.
template <class U, class Values, class V>
struct singular_value_decomposition {
  U u = detail::zero_initialized<U>();                ///< U, unit left singular vectors as columns
  Values values = detail::zero_initialized<Values>(); ///< σ, descending, a column
  V v = detail::zero_initialized<V>();                ///< V, unit right singular vectors as columns

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("u", u);
    f("values", values);
    f("v", v);
  }
};
template <class U, class Values, class V>
singular_value_decomposition(U, Values, V) -> singular_value_decomposition<U, Values, V>;

namespace detail {

/// The smaller of two sizes at compile time.
[[nodiscard]] constexpr int min_size(int a, int b) {
  return a == Eigen::Dynamic || b == Eigen::Dynamic ? Eigen::Dynamic : std::min(a, b);
}

/// The thin decomposition of a real matrix of size Rows × Columns.
template <class R, int Rows, int Columns>
struct real_svd {
  static constexpr int rank = min_size(Rows, Columns);
  template <int Size>
  using vectors =
      Eigen::Matrix<R, Size, rank, Size == 1 && rank != 1 ? Eigen::RowMajor : Eigen::ColMajor>;

  /// \throws invalid_input if A is empty or not finite, no_convergence
  template <class A>
  real_svd(const char* function, const A& a) {
    require(a.size() > 0, "duet: ", function, ": A is empty");
    require_finite(function, a);
    // Padding with zeros to a square matrix adds no rotations. Thin matrices take compilers 7 s in
    // Eigen.
    constexpr int size = rank == Eigen::Dynamic ? Eigen::Dynamic : std::max(Rows, Columns);
    using matrix = Eigen::Matrix<R, size, size>;
    const Eigen::Index m = a.rows(), n = a.cols(), k = std::min(m, n);
    matrix square = matrix::Zero(std::max(m, n), std::max(m, n));
    square.template topLeftCorner<Rows, Columns>(m, n) = a;
    constexpr int full = int(Eigen::ComputeFullU) | int(Eigen::ComputeFullV);
#if EIGEN_MAJOR_VERSION >= 5
    const Eigen::JacobiSVD<matrix, full | int(Eigen::NoQRPreconditioner)> svd(square);
#else
    const Eigen::JacobiSVD<matrix, Eigen::NoQRPreconditioner> svd(square, full);
#endif
    if (svd.info() != Eigen::Success) {
      raise(no_convergence(message("duet: ", function, ": Eigen's solver did not converge")));
    }
    u = svd.matrixU().template topLeftCorner<Rows, rank>(m, k);
    values = svd.singularValues().template head<rank>(k);
    v = svd.matrixV().template topLeftCorner<Columns, rank>(n, k);
  }

  vectors<Rows> u;
  Eigen::Matrix<R, rank, 1> values;
  vectors<Columns> v;

  /// Distance between two singular values that is only round-off.
  [[nodiscard]] R rounding() const {
    return R(4 * std::max(u.rows(), v.rows())) * std::numeric_limits<R>::epsilon() * values[0];
  }

  /// The correction of y = (u_j, v_j, σ_j) for a real residual of `singular_residual`.
  template <class Residual>
  [[nodiscard]] auto step(Eigen::Index j, const Residual& residual) const {
    const Eigen::Index m = u.rows(), n = v.rows();
    const Eigen::Matrix<R, Rows, 1> r = residual.template head<Rows>(m);
    const Eigen::Matrix<R, Columns, 1> s = residual.template segment<Columns>(m, n);
    const Eigen::Matrix<R, rank, 1> rho = u.transpose().lazyProduct(r),
                                    varsigma = v.transpose().lazyProduct(s);
    Eigen::Matrix<R, rank, 1> a(values.size()), b(values.size());
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      const R gap = (values[j] - values[i]) * (values[j] + values[i]);
      a[i] = i == j ? residual[m + n] : R((values[j] * rho[i] + values[i] * varsigma[i]) / gap);
      b[i] = i == j ? residual[m + n + 1] : R((values[i] * rho[i] + values[j] * varsigma[i]) / gap);
    }
    constexpr int size =
        Rows == Eigen::Dynamic || Columns == Eigen::Dynamic ? Eigen::Dynamic : Rows + Columns + 1;
    Eigen::Matrix<R, size, 1> y(m + n + 1);
    y.template head<Rows>(m) = u.lazyProduct(a);
    y.template segment<Columns>(m, n) = v.lazyProduct(b);
    if (m > n) { // the rest lies in the complement of the columns of U, V
      y.template head<Rows>(m) += (r - u.lazyProduct(rho)) / values[j];
    } else if (n > m) {
      y.template segment<Columns>(m, n) += (s - v.lazyProduct(varsigma)) / values[j];
    }
    y[m + n] = (rho[j] + varsigma[j]) / 2;
    return y;
  }
};

/// The equations of one singular triple y = (u, v, σ): A v − σ u, Aᵀu − σ v, (1 − uᵀu)/2 and
/// (1 − vᵀv)/2.
template <class A, class Y>
[[nodiscard]] auto singular_residual(const A& a, const Y& y) {
  using S = typename Y::Scalar;
  const Eigen::Index m = a.rows(), n = a.cols();
  constexpr int size = Y::RowsAtCompileTime;
  Eigen::Matrix<S, size == Eigen::Dynamic ? size : size + 1, 1> r(m + n + 2);
  const S minus_sigma = -y[m + n];
  r[m + n] = r[m + n + 1] = S(1);
  for (Eigen::Index i = 0; i < m + n; ++i) {
    r[i] = minus_sigma * y[i];
    r[i < m ? m + n : m + n + 1] -= y[i] * y[i];
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i < m; ++i) {
      r[i] += a(i, j) * y[m + j];
      r[m + j] += a(i, j) * y[i];
    }
  }
  r[m + n] = r[m + n] / 2;
  r[m + n + 1] = r[m + n + 1] / 2;
  return r;
}

/// (u_j, v_j, σ_j) over all of A's scalar.
template <class S, class Svd, class A>
[[nodiscard]] auto singular_triple(const Svd& svd, Eigen::Index j, const A& a) {
  using R = real_type_t<S>;
  const Eigen::Index m = a.rows(), n = a.cols();
  auto real = svd.step(j, Eigen::Matrix<R, Eigen::Dynamic, 1>::Zero(m + n + 2).eval()); // its size
  real.head(m) = svd.u.col(j);
  real.segment(m, n) = svd.v.col(j);
  real[m + n] = svd.values[j];
  auto y = converted<S>(real);
  for (int order = 1; order <= scalar_traits<S>::order; ++order) {
    correct_infinitesimals(
        y, [&](const auto& residual) { return svd.step(j, residual); }, singular_residual(a, y));
  }
  return y;
}

/// True if σ_j has derivatives: it is neither 0 nor one with a neighbour, except for round-off.
template <class Svd>
[[nodiscard]] bool is_simple(const Svd& svd, Eigen::Index j) {
  const auto& s = svd.values;
  const auto rounding = svd.rounding();
  return s[j] > rounding && !(j > 0 && s[j - 1] - s[j] <= rounding) &&
         !(j + 1 < s.size() && s[j] - s[j + 1] <= rounding);
}

/// `value` with NaN for its derivative with respect to all that any entry of A depends on.
template <class S, class A>
[[nodiscard]] S without_derivatives(const real_type_t<S>& value, const A& a) {
  using R = real_type_t<S>;
  S result(value);
  for (const auto& entry : a.reshaped()) {
    bool is_value = true; // the value comes first
    result = result + map_reals(S(entry), [&](const R& part) {
               const R nan = std::numeric_limits<R>::quiet_NaN();
               const R added = is_value || part == 0 ? R(0) : nan;
               is_value = false;
               return added;
             });
  }
  return result;
}

template <class A>
using svd_of =
    real_svd<real_type_t<common_scalar_t<A, A>>, A::RowsAtCompileTime, A::ColsAtCompileTime>;

} // namespace detail

/// Singular values σ₁ ≥ σ₂ ≥ … ≥ 0 of a matrix; σ₁ is its spectral norm ‖A‖₂.
///
/// \param a  A, of any size m × n
///
/// Their derivatives are those of `svd`, dσ_j = u_jᵀ dA v_j. A singular value that is 0, or equal
/// to another within 4 max(m, n) ε σ₁, has none: its derivatives are NaN with respect to all that A
/// depends on. These functions of A are differentiable even there: Σσ² = ‖A‖², the product
/// |det A| where it is not 0, and Σσ = tr(RᵀA) with R = `nearest_rotation(A)` where det A > 0.
///
/// \return a column of min(m, n) scalars, descending
/// \throws invalid_input if A is empty or has entries that are not finite
template <class A>
[[nodiscard]] auto singular_values(const Eigen::MatrixBase<A>& a) {
  using S = detail::common_scalar_t<A, A>;
  const detail::svd_of<A> real("singular_values", detail::real_values<real_type_t<S>>(a));
  auto values = detail::converted<S>(real.values);
  if constexpr (scalar_traits<S>::order > 0) {
    const auto& matrix = a.eval();
    for (Eigen::Index j = 0; j < values.size() && !detail::is_constant(matrix); ++j) {
      values[j] = detail::is_simple(real, j)
                      ? S(detail::singular_triple<S>(real, j, matrix)[a.rows() + a.cols()])
                      : detail::without_derivatives<S>(real.values[j], matrix);
    }
  }
  return values;
}

/// Thin singular value decomposition A = U diag(σ) Vᵀ.
///
/// \param a  A, of any size m × n
///
/// The values are those of `Eigen::JacobiSVD` over real numbers, without preconditioning, also the
/// signs of the vectors; it takes time proportional to max(m, n)² min(m, n).
/// The derivatives follow from A v = σ u, Aᵀu = σ v, uᵀu = vᵀv = 1; with i ≠ j
///
///   dσ_j = u_jᵀ dA v_j,
///   u_iᵀ du_j = (σ_j u_iᵀ dA v_j + σ_i u_jᵀ dA v_i)/(σ_j² − σ_i²),
///   v_iᵀ dv_j = (σ_i u_iᵀ dA v_j + σ_j u_jᵀ dA v_i)/(σ_j² − σ_i²),
///
/// and order by order each step of Newton's method in the algebra of the infinitesimals makes one
/// more order exact. Vectors of equal singular values have no derivatives. (G. H. Golub,
/// C. F. Van Loan, Matrix Computations, 8.6.)
///
/// \return `singular_value_decomposition`: u is m × k, values k, v n × k with k = min(m, n)
/// \throws invalid_input if A is empty or has entries that are not finite, and, unless A is a
/// constant, at a singular value that is 0 or equal to another within 4 max(m, n) ε σ₁:
/// `singular_values` returns those that have derivatives.
template <class A>
[[nodiscard]] auto svd(const Eigen::MatrixBase<A>& a) {
  using S = detail::common_scalar_t<A, A>;
  const detail::svd_of<A> real("svd", detail::real_values<real_type_t<S>>(a));
  singular_value_decomposition result{detail::converted<S>(real.u),
                                      detail::converted<S>(real.values),
                                      detail::converted<S>(real.v)};
  if constexpr (scalar_traits<S>::order > 0) {
    const auto& matrix = a.eval();
    const Eigen::Index m = a.rows(), n = a.cols();
    for (Eigen::Index j = 0; j < real.values.size() && !detail::is_constant(matrix); ++j) {
      detail::require(detail::is_simple(real, j), "duet: svd: singular value ", j, ", ",
                      real.values[j],
                      ", has no derivatives, as it is 0 or equal to another and A "
                      "is not constant");
      const auto y = detail::singular_triple<S>(real, j, matrix);
      result.u.col(j) = y.head(m);
      result.v.col(j) = y.segment(m, n);
      result.values[j] = y[m + n];
    }
  }
  return result;
}

} // namespace duet
