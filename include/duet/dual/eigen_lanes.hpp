// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch_lanes.hpp>
#include <duet/core/config.hpp>
#include <duet/dual/lanes.hpp>

#include <Eigen/Core>

#include <concepts>
#include <type_traits>

/// \file
/// Batches as scalars of Eigen, and matrices of them taken apart into lanes.

namespace Eigen {

template <class T, int W>
struct NumTraits<duet::batch<T, W>> : NumTraits<T> {
  using number = duet::batch<T, W>;
  using Real = number;
  using NonInteger = number;
  using Nested = number;
  using Literal = T;
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

/// A matrix of the size and layout of M over another scalar.
template <class M, class S>
using matrix_over =
    Eigen::Matrix<S, M::RowsAtCompileTime, M::ColsAtCompileTime, M::PlainObject::Options,
                  M::MaxRowsAtCompileTime, M::MaxColsAtCompileTime>;

template <class R, class F>
[[nodiscard]] DUET_ALWAYS_INLINE R filled_matrix(Eigen::Index rows, Eigen::Index cols, const F& f) {
  R result(rows, cols);
  for (Eigen::Index j = 0; j < cols; ++j) {
    for (Eigen::Index i = 0; i < rows; ++i) {
      result(i, j) = f(i, j);
    }
  }
  return result;
}

} // namespace detail

template <class M>
  requires std::derived_from<M, Eigen::DenseBase<M>>
inline constexpr int lane_count<M> = lane_count<typename M::Scalar>;

template <class M>
  requires std::derived_from<M, Eigen::DenseBase<M>>
[[nodiscard]] DUET_ALWAYS_INLINE auto lane(const M& m, int k) {
  using S = std::decay_t<decltype(lane(m(0, 0), k))>;
  return detail::filled_matrix<detail::matrix_over<M, S>>(
      m.rows(), m.cols(),
      [&](Eigen::Index i, Eigen::Index j) DUET_INLINE_LAMBDA { return lane(m(i, j), k); });
}

template <int W, class M, class Get>
  requires std::derived_from<M, Eigen::DenseBase<M>>
[[nodiscard]] DUET_ALWAYS_INLINE auto joined_lanes(lane_width<W>, const M& pattern,
                                                   const Get& get) {
  const auto first = [&](int k) DUET_INLINE_LAMBDA { return get(k)(0, 0); };
  using S = std::decay_t<decltype(joined_lanes(lane_width<W>{}, pattern(0, 0), first))>;
  return detail::filled_matrix<detail::matrix_over<M, S>>(
      pattern.rows(), pattern.cols(), [&](Eigen::Index i, Eigen::Index j) DUET_INLINE_LAMBDA {
        return joined_lanes(lane_width<W>{}, pattern(i, j),
                            [&](int k) DUET_INLINE_LAMBDA { return get(k)(i, j); });
      });
}

template <class T, int W, class M>
  requires std::derived_from<M, Eigen::DenseBase<M>>
[[nodiscard]] DUET_ALWAYS_INLINE M blended(const lane_mask<T, W>& m, const M& a, const M& b) {
  return detail::filled_matrix<M>(a.rows(), a.cols(),
                                  [&](Eigen::Index i, Eigen::Index j)
                                      DUET_INLINE_LAMBDA { return blended(m, a(i, j), b(i, j)); });
}

} // namespace duet
