// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/config.hpp>
#include <duet/core/structure.hpp>

#include <Eigen/Core>

#include <type_traits>

/// \file
/// Matrices of Eigen as containers of scalars, and batches as scalars of Eigen.

namespace Eigen {

template <class T, int W>
struct NumTraits<duet::batch<T, W>> : NumTraits<T> {
  using number = duet::batch<T, W>;
  using Real = number;
  using NonInteger = number;
  using Nested = number;
  using Literal = T;
  // Copied by type: g++ warns of Eigen's memcpy, as a batch assigns itself.
  static constexpr int RequireInitialization = 1;
};

template <class T, int W, class Operation>
struct ScalarBinaryOpTraits<duet::batch<T, W>, T, Operation> {
  using ReturnType = duet::batch<T, W>;
};
template <class T, int W, class Operation>
struct ScalarBinaryOpTraits<T, duet::batch<T, W>, Operation> {
  using ReturnType = duet::batch<T, W>;
};

} // namespace Eigen

namespace duet {
namespace detail {

template <class Derived>
void take_matrix(const Eigen::MatrixBase<Derived>&);

/// A matrix or vector of Eigen, or an expression of them, including blocks of vectors, which are
/// not derived from the `MatrixBase` of their own type.
template <class M>
concept EigenMatrix = requires(const M& m) {
  take_matrix(m);
};

/// A matrix of the size and layout of M over another scalar.
template <class M, class S>
using matrix_over =
    Eigen::Matrix<S, M::RowsAtCompileTime, M::ColsAtCompileTime, M::PlainObject::Options,
                  M::MaxRowsAtCompileTime, M::MaxColsAtCompileTime>;

} // namespace detail

/// Visits the scalars of a matrix column by column.
template <class M>
  requires detail::EigenMatrix<M>
struct structure<M> {
  using scalar = typename M::Scalar;
  template <class F, class... Rest>
  [[nodiscard]] static auto map(F&& f, const M& m, const Rest&... rest) {
    using result = std::decay_t<decltype(f(m(0, 0), rest(0, 0)...))>;
    detail::matrix_over<M, result> y(m.rows(), m.cols());
    for (Eigen::Index j = 0; j < m.cols(); ++j) {
      for (Eigen::Index i = 0; i < m.rows(); ++i) {
        y(i, j) = f(m(i, j), rest(i, j)...);
      }
    }
    return y;
  }
};

} // namespace duet
