// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/eigen_traits.hpp>

#include <Eigen/Core>

#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

/// \file
/// Tangent spaces: how an unknown is moved by a small vector.

namespace duet {

/// `manifold<X>::dimension` coordinates move an X: `plus(x, delta)` is x moved by the tangent
/// vector delta, whose scalar may be any. Scalars, vectors of fixed size and tuples are here;
/// rotations add their own, so that Newton's method and Jacobians never see redundant coordinates.
template <class X>
struct manifold;

template <Scalar X>
struct manifold<X> {
  static constexpr int dimension = 1;
  template <class Delta>
  [[nodiscard]] static auto plus(const X& x, const Delta& delta) {
    return x + delta[0];
  }
};

template <class X>
  requires std::derived_from<X, Eigen::MatrixBase<X>>
struct manifold<X> {
  static_assert(X::SizeAtCompileTime > 0, "duet: an unknown vector needs a size known at compile "
                                          "time");
  static constexpr int dimension = X::SizeAtCompileTime;
  template <class Delta>
  [[nodiscard]] static auto plus(const X& x, const Delta& delta) {
    using S = std::decay_t<decltype(x[0] + delta[0])>;
    Eigen::Matrix<S, X::RowsAtCompileTime, X::ColsAtCompileTime> y;
    for (int i = 0; i < dimension; ++i) {
      y[i] = x[i] + delta[i];
    }
    return y;
  }
};

template <class... X>
struct manifold<std::tuple<X...>> {
  static constexpr int dimension = (manifold<X>::dimension + ...);

  template <class Delta>
  [[nodiscard]] static auto plus(const std::tuple<X...>& x, const Delta& delta) {
    return plus_each(x, delta, std::index_sequence_for<X...>{});
  }

private:
  /// Where the coordinates of the I-th element start.
  template <std::size_t I>
  static constexpr int offset = [] {
    constexpr int dimensions[] = {manifold<X>::dimension...};
    int sum = 0;
    for (std::size_t i = 0; i < I; ++i) {
      sum += dimensions[i];
    }
    return sum;
  }();

  template <class Delta, std::size_t... I>
  [[nodiscard]] static auto plus_each(const std::tuple<X...>& x, const Delta& delta,
                                      std::index_sequence<I...>) {
    return std::make_tuple(manifold<X>::plus(
        std::get<I>(x), delta.template segment<manifold<X>::dimension>(offset<I>))...);
  }
};

} // namespace duet
