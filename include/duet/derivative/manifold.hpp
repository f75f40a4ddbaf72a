// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/promotion.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Tangent spaces: perturbation of an object by a small vector, and the tangent vector of its rate.
/// For those who extend duet.

namespace duet {

/// Tangent space of an X: the coordinates of its perturbations and rates.
///
/// - `dimension`: their number, `Eigen::Dynamic` if known only at run time
/// - `scalar`: the scalar of an X
/// - `plus(x, δ, frame)`: x moved by the tangent vector δ, whose scalar may be any
/// - `velocity(x, ẋ, frame)`: the tangent vector of the rate ẋ, an Eigen column
/// - `takes_rates_of_any_scalar`, if it does: ẋ over dual numbers, many rates at once
///
/// Scalars, vectors, arrays and tuples are defined here and ignore `frame`; rotations are
/// specialised separately, so that Newton's method and Jacobians never see redundant coordinates.
template <class X>
struct manifold;

template <class X>
  requires(Scalar<X> || Arithmetic<X>)
struct manifold<X> {
  static constexpr int dimension = 1;
  using scalar = detail::differentiable_t<X>;
  template <class Delta, class Frame = spatial_frame>
  [[nodiscard]] static auto plus(const X& x, const Delta& delta, Frame = {}) {
    return x + delta[0];
  }
  template <class Frame>
  [[nodiscard]] static Eigen::Matrix<X, 1, 1> velocity(const X&, const X& rate, Frame) {
    return Eigen::Matrix<X, 1, 1>(rate);
  }
};

template <class X>
  requires detail::EigenMatrix<X>
struct manifold<X> {
  static constexpr int dimension = X::SizeAtCompileTime;
  using scalar = detail::differentiable_t<typename X::Scalar>;
  template <class Delta, class Frame = spatial_frame>
  [[nodiscard]] static auto plus(const X& x, const Delta& delta, Frame = {}) {
    static_assert(dimension > 0, "duet: an unknown vector needs a size known at compile time");
    using S = std::decay_t<decltype(x.coeff(0) + delta[0])>;
    Eigen::Matrix<S, X::RowsAtCompileTime, X::ColsAtCompileTime> y;
    for (int i = 0; i < dimension; ++i) {
      y(i) = x(i) + delta[i];
    }
    return y;
  }
  template <class Frame>
  [[nodiscard]] static Eigen::Matrix<scalar, dimension, 1> velocity(const X&, const X& rate,
                                                                    Frame) {
    Eigen::Matrix<scalar, dimension, 1> result(rate.size());
    for (Eigen::Index i = 0; i < rate.size(); ++i) {
      result[i] = rate(i);
    }
    return result;
  }
};

/// Not moved as a whole, but in passes over the components.
template <class X>
  requires(Scalar<X> || Arithmetic<X>)
struct manifold<std::vector<X>> {
  static constexpr int dimension = Eigen::Dynamic;
  using scalar = detail::differentiable_t<X>;
  template <class Frame>
  [[nodiscard]] static Eigen::Matrix<scalar, dimension, 1>
  velocity(const std::vector<X>&, const std::vector<X>& rate, Frame) {
    Eigen::Matrix<scalar, dimension, 1> result(Eigen::Index(rate.size()));
    for (std::size_t i = 0; i < rate.size(); ++i) {
      result[Eigen::Index(i)] = rate[i];
    }
    return result;
  }
};

template <class X, std::size_t N>
  requires requires { manifold<X>::dimension; }
struct manifold<std::array<X, N>> {
  static constexpr int dimension =
      manifold<X>::dimension == Eigen::Dynamic ? Eigen::Dynamic : int(N) * manifold<X>::dimension;
  using scalar = typename manifold<X>::scalar;
  template <class Delta, class Frame = spatial_frame>
  [[nodiscard]] static auto plus(const std::array<X, N>& x, const Delta& delta, Frame frame = {}) {
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
      return std::array{
          manifold<X>::plus(x[I], delta.template segment<part>(int(I) * part), frame)...};
    }
    (std::make_index_sequence<N>{});
  }
  template <class Frame>
  [[nodiscard]] static auto velocity(const std::array<X, N>& x, const std::array<X, N>& rate,
                                     Frame frame) {
    Eigen::Matrix<scalar, dimension, 1> result;
    for (std::size_t i = 0; i < N; ++i) {
      result.template segment<part>(int(i) * part) = manifold<X>::velocity(x[i], rate[i], frame);
    }
    return result;
  }

private:
  static constexpr int part = manifold<X>::dimension;
};

template <class... X>
  requires(requires { manifold<X>::dimension; } && ...)
struct manifold<std::tuple<X...>> {
  static constexpr int dimension = ((manifold<X>::dimension == Eigen::Dynamic) || ...)
                                       ? Eigen::Dynamic
                                       : (manifold<X>::dimension + ...);
  using scalar = std::common_type_t<typename manifold<X>::scalar...>;

  template <class Delta, class Frame = spatial_frame>
  [[nodiscard]] static auto plus(const std::tuple<X...>& x, const Delta& delta, Frame frame = {}) {
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
      return std::make_tuple(manifold<X>::plus(
          std::get<I>(x), delta.template segment<manifold<X>::dimension>(offset<I>), frame)...);
    }
    (indices);
  }
  template <class Frame>
  [[nodiscard]] static auto velocity(const std::tuple<X...>& x, const std::tuple<X...>& rate,
                                     Frame frame) {
    Eigen::Matrix<scalar, dimension, 1> result;
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      ((result.template segment<manifold<X>::dimension>(offset<I>) =
            manifold<X>::velocity(std::get<I>(x), std::get<I>(rate), frame)
                .template cast<scalar>()),
       ...);
    }
    (indices);
    return result;
  }

private:
  static constexpr auto indices = std::index_sequence_for<X...>{};

  /// Index of the first coordinate of the I-th element.
  template <std::size_t I>
  static constexpr int offset = [] {
    constexpr int dimensions[] = {manifold<X>::dimension...};
    int sum = 0;
    for (std::size_t i = 0; i < I; ++i) {
      sum += dimensions[i];
    }
    return sum;
  }();
};

} // namespace duet
