// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/structure.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/parts.hpp>
#include <duet/dual/structural_zero.hpp>

#include <Eigen/Core>

#include <sstream>
#include <type_traits>

/// \file
/// Matrices of scalars as real matrices, one of the values and one of every infinitesimal part:
/// what is factorised once for the values serves all parts.

namespace duet::detail {

/// How many infinitesimal parts a scalar has, over all levels.
template <class S>
inline constexpr int infinitesimal_count = 0;
template <class T, int N, class Tag>
inline constexpr int infinitesimal_count<dual<T, N, Tag>> = (N + 1) * (infinitesimal_count<T> + 1) -
                                                            1;
template <class T, int K, class Tag>
inline constexpr int
    infinitesimal_count<taylor<T, K, Tag>> = (K + 1) * (infinitesimal_count<T> + 1) - 1;

/// The scalar that a matrix of A and one of B have in common; integers are differentiated as reals.
template <class A, class B>
using common_scalar_t =
    promote_t<differentiable_t<typename A::Scalar>, differentiable_t<typename B::Scalar>>;

/// Can sizes be the same, as far as they are known at compile time?
[[nodiscard]] constexpr bool can_be_same(int a, int b) {
  return a == b || a == Eigen::Dynamic || b == Eigen::Dynamic;
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

/// Are all infinitesimal parts exactly zero?
template <class Derived>
[[nodiscard]] bool is_constant(const Eigen::MatrixBase<Derived>& a) {
  using S = typename Derived::Scalar;
  bool result = true;
  if constexpr (Infinitesimal<S>) {
    for (Eigen::Index j = 0; j < a.cols(); ++j) {
      for (Eigen::Index i = 0; i < a.rows(); ++i) {
        bool is_value = true;
        auto check = [&](const real_type_t<S>& part) {
          result = result && (is_value || part == 0);
          is_value = false;
          return part;
        };
        static_cast<void>(map_reals(a(i, j), check));
      }
    }
  }
  return result;
}

/// A real-linear map of columns applied to all infinitesimal parts of x. The value part of the
/// result is zero: a correction made of it leaves values as they are.
///
/// \param map  takes and returns a real matrix of any number of columns
template <class Map, class Derived>
[[nodiscard]] auto mapped_infinitesimals(const Map& map, const Eigen::MatrixBase<Derived>& x) {
  using S = typename Derived::Scalar;
  using R = real_type_t<S>;
  constexpr int count = infinitesimal_count<S>;
  constexpr int rows = Derived::RowsAtCompileTime;
  constexpr int cols = Derived::ColsAtCompileTime;
  // Off the heap where the caller's matrices are, and little enough for the stack.
  constexpr bool is_small = rows > 0 && cols > 0 && rows * cols * count <= 1024;
  constexpr int all_cols = is_small ? cols * count : Eigen::Dynamic;
  constexpr int options = rows == 1 && all_cols != 1 ? Eigen::RowMajor : Eigen::ColMajor;
  Eigen::Matrix<R, rows, all_cols, options> columns(x.rows(), x.cols() * count);
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      Eigen::Index k = -1;
      auto read = [&](const R& part) {
        if (k >= 0) {
          columns(i, j * count + k) = part;
        }
        ++k;
        return part;
      };
      static_cast<void>(map_reals(x(i, j), read));
    }
  }
  const auto mapped = map(columns).eval();
  constexpr int mapped_rows = std::decay_t<decltype(mapped)>::RowsAtCompileTime;
  Eigen::Matrix<S, mapped_rows, cols,
                mapped_rows == 1 && cols != 1 ? Eigen::RowMajor : Eigen::ColMajor>
      result(mapped.rows(), x.cols());
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    for (Eigen::Index i = 0; i < mapped.rows(); ++i) {
      Eigen::Index k = -1;
      auto write = [&](const R&) {
        const R part = k >= 0 ? R(mapped(i, j * count + k)) : R(0);
        ++k;
        return part;
      };
      result(i, j) = map_reals(S(0), write);
    }
  }
  return result;
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

/// \throws invalid_input where a real matrix has an entry that is infinite or not a number.
template <class Derived>
void require_finite(const char* function, const Eigen::MatrixBase<Derived>& a) {
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      if (!is_all_finite(a(i, j))) {
        std::ostringstream message;
        message << "duet: " << function << ": entry (" << i << ", " << j << ") of A is not finite";
        throw invalid_input(message.str());
      }
    }
  }
}

} // namespace duet::detail
