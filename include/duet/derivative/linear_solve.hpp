// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/math.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/derivative/matrix_parts.hpp>
#include <duet/dual/eigen_traits.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <cmath>
#include <limits>
#include <type_traits>

/// \file
/// Systems of linear equations, differentiated by their own equation instead of through
/// elimination.

namespace duet {
namespace detail {

/// LU decomposition with partial pivoting of one matrix per lane, as `Eigen::PartialPivLU` for one
/// matrix. Rows are exchanged by blending, so each lane has the pivots that it would have alone.
template <class M>
class lane_lu {
public:
  using Scalar = typename M::Scalar;

  explicit lane_lu(const M& a) : factors_(a), pivot_rows_(a.rows()) {
    const Eigen::Index n = factors_.rows();
    for (Eigen::Index k = 0; k < n; ++k) {
      Scalar largest = abs(factors_(k, k));
      Scalar row(k);
      for (Eigen::Index i = k + 1; i < n; ++i) {
        const Scalar size = abs(factors_(i, k));
        const auto is_larger = largest < size;
        largest = blended(is_larger, size, largest);
        row = blended(is_larger, Scalar(i), row);
      }
      pivot_rows_[k] = row;
      exchange(factors_, k);
      // If the pivot is zero, so is the column.
      const Scalar pivot = blended(largest == 0, Scalar(1), factors_(k, k));
      for (Eigen::Index i = k + 1; i < n; ++i) {
        factors_(i, k) /= pivot;
        for (Eigen::Index j = k + 1; j < n; ++j) {
          factors_(i, j) -= factors_(i, k) * factors_(k, j);
        }
      }
    }
  }

  [[nodiscard]] const M& matrixLU() const { return factors_; }

  template <class B>
  [[nodiscard]] B solve(const B& b) const {
    const Eigen::Index n = factors_.rows();
    B x = b;
    for (Eigen::Index k = 0; k < n; ++k) {
      exchange(x, k);
    }
    for (Eigen::Index j = 0; j < x.cols(); ++j) {
      for (Eigen::Index k = 0; k < n; ++k) {
        for (Eigen::Index i = k + 1; i < n; ++i) {
          x(i, j) -= factors_(i, k) * x(k, j);
        }
      }
      for (Eigen::Index k = n - 1; k >= 0; --k) {
        x(k, j) /= factors_(k, k);
        for (Eigen::Index i = 0; i < k; ++i) {
          x(i, j) -= factors_(i, k) * x(k, j);
        }
      }
    }
    return x;
  }

private:
  /// Exchanges row k with the row of the k-th pivot.
  template <class X>
  void exchange(X& x, Eigen::Index k) const {
    for (Eigen::Index i = k + 1; i < x.rows(); ++i) {
      const auto is_pivot = pivot_rows_[k] == Scalar(i);
      if (any(is_pivot)) {
        for (Eigen::Index j = 0; j < x.cols(); ++j) {
          const Scalar upper = x(k, j), lower = x(i, j);
          x(k, j) = blended(is_pivot, lower, upper);
          x(i, j) = blended(is_pivot, upper, lower);
        }
      }
    }
  }

  M factors_;
  Eigen::Matrix<Scalar, M::RowsAtCompileTime, 1> pivot_rows_;
};

/// Rejects pivots that are only round-off.
///
/// The round-off of u_kk is that of the sum it is the remainder of, so neither the units of the
/// equations nor those of the unknowns matter. The factor 4 catches all but one in a hundred of
/// random singular matrices; LU alone, which waits for a zero, would pass half of them.
///
/// \throws invalid_input if a pivot is only round-off
template <class LU>
void require_regular(const LU& lu) {
  using std::abs;
  const auto& factors = lu.matrixLU();
  using R = typename LU::Scalar;
  const Eigen::Index n = factors.rows();
  for (Eigen::Index k = 0; k < n; ++k) {
    const R pivot = abs(factors(k, k));
    R terms = pivot;
    for (Eigen::Index j = 0; j < k; ++j) {
      terms += R(abs(R(factors(k, j) * factors(j, k))));
    }
    require(!surely_any(pivot <= R(R(4 * n) * std::numeric_limits<R>::epsilon() * terms)),
            "duet: solve: A is singular: pivot ", k + 1, " of ", n,
            " is only round-off: ", factors(k, k));
  }
}

template <class M>
using lu_of = std::conditional_t<Batched<typename M::Scalar>, lane_lu<M>, Eigen::PartialPivLU<M>>;

} // namespace detail

/// The x with A x = b, over the scalars that those of A and b promote to.
///
/// \param a  A, square
/// \param b  a vector, or a matrix of right-hand sides
///
/// The values are those of `Eigen::PartialPivLU` over real numbers, to the last bit; over batches
/// each lane has the pivots it would have alone. The derivatives follow from the equation itself,
///
///   dx = A⁻¹(db − dA x),
///
/// and so on order by order with the one factorisation of the values A₀: each step
/// x ← x + A₀⁻¹(b − A x) in the algebra of the infinitesimals makes one more order exact. Their
/// relative error is that of x, about cond(A) ε, with cond(A) the condition number, but may grow
/// with every order by another cond(A).
///
/// \throws invalid_input if sizes do not match, if A has entries that are not finite, and if A is
///   singular: if a pivot is at most 4nε times the sum of the absolute terms that it is the sum of.
///   A nearly singular (ill-conditioned) matrix passes, with a correspondingly large error.
template <class A, class B>
[[nodiscard]] auto solve(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  using S = detail::common_scalar_t<A, B>;
  static_assert(!std::is_same_v<S, detail::no_promotion>,
                "duet: solve: the scalars of A and b have no common type");
  using R = real_type_t<S>;
  detail::require_square("solve", a);
  static_assert(detail::can_be_same(A::RowsAtCompileTime, B::RowsAtCompileTime),
                "duet: solve: b must have as many rows as A");
  detail::require(a.rows() == b.rows(), "duet: solve: A has ", a.rows(), " rows, but b ", b.rows());
  const auto matrix = detail::real_values<R>(a);
  detail::require_finite("solve", matrix);
  const detail::lu_of<std::remove_const_t<decltype(matrix)>> lu(matrix);
  detail::require_regular(lu);
  const auto values = lu.solve(detail::real_values<R>(b)).eval();
  if constexpr (scalar_traits<S>::order == 0) {
    return values;
  } else {
    auto x = detail::converted<S>(values);
    if (detail::is_constant(a) && detail::is_constant(b)) {
      return x;
    }
    const auto& coefficients = a.eval();
    const auto right = detail::converted<S>(b);
    for (int order = 1; order <= scalar_traits<S>::order; ++order) {
      // A named type, which Eigen has already instantiated if b is a vector.
      detail::correct_infinitesimals(
          x, [&](const auto& column) { return lu.solve(column).eval(); },
          detail::residual(coefficients, right, x));
    }
    return x;
  }
}

} // namespace duet
