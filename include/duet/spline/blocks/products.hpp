// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <cmath>

/// \file
/// Sums and products of small matrices as plain loops, which compile faster than Eigen's
/// expressions.

namespace duet::detail {

/// Adds factor · a to y, in place.
template <class M, class R>
void add_multiple(M& y, const R& factor, const M& a) {
  for (int column = 0; column < M::ColsAtCompileTime; ++column) {
    for (int i = 0; i < M::RowsAtCompileTime; ++i) {
      y(i, column) += factor * a(i, column);
    }
  }
}

/// Adds factor · a x to y, in place; x and y over any scalar above that of a.
template <class Y, class R, class A, class X>
void add_product(Y& y, const R& factor, const A& a, const X& x) {
  for (int column = 0; column < X::ColsAtCompileTime; ++column) {
    for (int j = 0; j < A::ColsAtCompileTime; ++j) {
      const typename X::Scalar multiple = factor * x(j, column);
      for (int i = 0; i < A::RowsAtCompileTime; ++i) {
        y(i, column) += a(i, j) * multiple;
      }
    }
  }
}

/// Product a b of square matrices.
template <class M>
[[nodiscard]] M product(const M& a, const M& b) {
  M result;
  for (int column = 0; column < M::ColsAtCompileTime; ++column) {
    for (int i = 0; i < M::RowsAtCompileTime; ++i) {
      typename M::Scalar sum = a(i, 0) * b(0, column);
      for (int j = 1; j < M::ColsAtCompileTime; ++j) {
        sum += a(i, j) * b(j, column);
      }
      result(i, column) = sum;
    }
  }
  return result;
}

/// Length of three components of a vector, from `first` on.
template <class V>
[[nodiscard]] typename V::Scalar length(const V& v, int first = 0) {
  using std::sqrt;
  return sqrt(v[first] * v[first] + v[first + 1] * v[first + 1] + v[first + 2] * v[first + 2]);
}

} // namespace duet::detail
