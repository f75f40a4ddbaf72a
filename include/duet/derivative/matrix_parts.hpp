// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/select.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual/partials.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

/// \file
/// Matrices of scalars as real matrices, one of the values and one of every infinitesimal part: one
/// factorisation of the values serves all parts.

namespace duet::detail {

/// Maximum number of infinitesimal parts of a scalar, over all nesting levels.
template <class S>
inline constexpr int infinitesimal_count = 0;
template <Infinitesimal S>
inline constexpr int infinitesimal_count<S> =
    (1 + infinitesimal_count<typename scalar_traits<S>::value_type>)*(S::part_count < 0
                                                                          ? -S::part_count
                                                                          : S::part_count) -
    1;

/// True if the number of parts of some nesting level depends on the number itself.
template <class S>
inline constexpr bool varies_in_parts = false;
template <Infinitesimal S>
inline constexpr bool varies_in_parts<S> =
    S::part_count < 0 || varies_in_parts<typename scalar_traits<S>::value_type>;

/// Common scalar of a matrix of A and one of B; integers are differentiated as reals.
template <class A, class B>
using common_scalar_t =
    promote_t<differentiable_t<typename A::Scalar>, differentiable_t<typename B::Scalar>>;

/// True if two sizes can be equal, as far as they are known at compile time.
[[nodiscard]] constexpr bool can_be_same(int a, int b) {
  return a == b || a == Eigen::Dynamic || b == Eigen::Dynamic;
}

/// \throws invalid_input unless A is square and not empty
template <class A>
void require_square(const char* function, const A& a) {
  static_assert(can_be_same(A::RowsAtCompileTime, A::ColsAtCompileTime),
                "duet: the matrix A must be square");
  require(a.rows() == a.cols(), "duet: ", function, ": A is ", a.rows(), " x ", a.cols(),
          ", but must be square");
  require(a.rows() > 0, "duet: ", function, ": A is empty");
}

/// Every entry converted to T; the layout is kept.
template <class T, class Derived>
[[nodiscard]] auto converted(const Eigen::MatrixBase<Derived>& a) {
  return a.unaryExpr([](const auto& x) { return static_cast<T>(x); }).eval();
}

/// The innermost value of every entry, as R; the layout is kept.
template <class R, class Derived>
[[nodiscard]] auto real_values(const Eigen::MatrixBase<Derived>& a) {
  return a.unaryExpr([](const auto& x) { return static_cast<R>(innermost(x)); }).eval();
}

/// True if all infinitesimal parts are exactly zero.
template <class Derived>
[[nodiscard]] bool is_constant(const Eigen::MatrixBase<Derived>& a) {
  using S = typename Derived::Scalar;
  bool result = true;
  for (const S& entry : a.eval().reshaped()) {
    result = result && all(is_constant(entry));
  }
  return result;
}

/// One real column for every infinitesimal part: not on the heap if their length is known and they
/// are small enough for the stack.
template <class R, int Rows, int Count>
using part_columns =
    Eigen::Matrix<R, Rows, (Rows > 0 && Rows * Count <= 1024) ? Count : Eigen::Dynamic,
                  Rows == 1 && Count != 1 ? Eigen::RowMajor : Eigen::ColMajor>;

/// Gives every entry of either matrix the parts that any entry has, if their number varies.
template <class X, class Residual>
void equalise_parts(X& x, Residual& r) {
  using S = typename X::Scalar;
  if constexpr (varies_in_parts<S>) {
    const auto zero = [](const S& entry) {
      return map_reals(entry, [](const auto&) { return real_type_t<S>(0); });
    };
    S zeros(0);
    for (const S& entry : x.reshaped()) {
      zeros = zeros + zero(entry);
    }
    for (const S& entry : r.reshaped()) {
      zeros = zeros + zero(entry);
    }
    x.array() += zeros;
    r.array() += zeros;
  }
}

/// Adds map(r) to the infinitesimal parts of x, where the real-linear map takes and returns a real
/// column. The values of x are unchanged, and so are parts that r does not have.
template <class X, class Map, class Residual>
void correct_infinitesimals(X& x, const Map& map, Residual r) {
  using R = real_type_t<typename X::Scalar>;
  equalise_parts(x, r);
  constexpr int count = infinitesimal_count<typename X::Scalar>;
  constexpr int rows = Residual::RowsAtCompileTime;
  part_columns<R, rows, count> parts(r.rows(), count);
  part_columns<R, X::RowsAtCompileTime, count> corrections(x.rows(), count);
  Eigen::Matrix<R, rows, 1> column(r.rows());
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    for (Eigen::Index i = 0; i < r.rows(); ++i) {
      int k = -1; // the value comes first
      static_cast<void>(map_reals(r(i, j), [&](const R& part) {
        if (k >= 0) {
          parts(i, k) = part;
        }
        ++k;
        return part;
      }));
    }
    for (int k = 0; k < count; ++k) {
      column = parts.col(k);
      bool is_zero = true;
      for (const R& part : column) {
        is_zero = is_zero && all(part == 0);
      }
      if (is_zero) {
        corrections.col(k).setZero();
      } else {
        corrections.col(k) = map(column);
      }
    }
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      int k = -1;
      x(i, j) = map_reals(x(i, j), [&](const R& part) {
        const R corrected = k >= 0 ? R(part + corrections(i, k)) : part;
        ++k;
        return corrected;
      });
    }
  }
}

/// b − A x, entry by entry: a matrix of constants is not widened to one of duals.
template <class A, class B, class X>
[[nodiscard]] B residual(const A& a, const B& b, const X& x) {
  using S = typename B::Scalar;
  B r = b;
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    for (Eigen::Index k = 0; k < a.cols(); ++k) {
      for (Eigen::Index i = 0; i < a.rows(); ++i) {
        r(i, j) = S(r(i, j) - S(a(i, k) * x(k, j)));
      }
    }
  }
  return r;
}

/// A power of two that brings the largest entry of a matrix near 1: squares then stay in range.
template <class R, class A>
[[nodiscard]] R scale_of(const A& a) {
  using std::frexp;
  using std::ldexp;
  int exponent = 0;
  static_cast<void>(frexp(R(a.cwiseAbs().maxCoeff()), &exponent));
  return ldexp(R(1), std::min(-exponent, std::numeric_limits<R>::max_exponent - 1));
}

/// \throws invalid_input if a real matrix has an entry that is infinite or not a number.
template <class Derived>
void require_finite(const char* function, const Eigen::MatrixBase<Derived>& a) {
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      require(all(is_all_finite(a(i, j))), "duet: ", function, ": entry (", i, ", ", j,
              ") of A is not finite");
    }
  }
}

} // namespace duet::detail
