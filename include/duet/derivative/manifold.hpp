// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

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
/// - `dimension`: their number, `Eigen::Dynamic` if known only at run time, then `size(x)`
/// - `scalar`: the scalar of an X
/// - `plus(x, δ, frame)`: x moved by the tangent vector δ, whose scalar may be any
/// - `velocity(x, ẋ, frame)`: the tangent vector of the rate ẋ, an Eigen column
/// - `takes_rates_of_any_scalar`, if it does: ẋ over dual numbers, many rates at once
///
/// Scalars, vectors, arrays and tuples are defined here and ignore `frame`; rotations are
/// specialised separately, so that Newton's method and Jacobians never see redundant coordinates.
template <class X>
struct manifold;

namespace detail {

/// Number of tangent coordinates of x.
template <class X>
[[nodiscard]] constexpr Eigen::Index tangent_dimension(const X& x) {
  if constexpr (manifold<X>::dimension == Eigen::Dynamic) {
    return manifold<X>::size(x);
  } else {
    return manifold<X>::dimension;
  }
}

} // namespace detail

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
  [[nodiscard]] static Eigen::Index size(const X& x) { return x.size(); }
  template <class Delta, class Frame = spatial_frame>
  [[nodiscard]] static auto plus(const X& x, const Delta& delta, Frame = {}) {
    using S = std::decay_t<decltype(x.coeff(0) + delta[0])>;
    Eigen::Matrix<S, X::RowsAtCompileTime, X::ColsAtCompileTime> y;
    y.resize(x.rows(), x.cols());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      y(i) = x(i) + delta[i];
    }
    return y;
  }
  template <class Frame>
  [[nodiscard]] static Eigen::Matrix<scalar, dimension, 1> velocity(const X&, const X& rate,
                                                                    Frame) {
    return rate.reshaped();
  }
};

namespace detail {

/// Tangent space of an array, a `std::vector` or a tuple: that of its elements.
template <class X, int Dimension, class T>
struct manifold_of_elements {
  static constexpr int dimension = Dimension;
  using scalar = T;
  [[nodiscard]] static Eigen::Index size(const X& x) {
    Eigen::Index sum = 0;
    for_each_element([&](const auto& each) { sum += tangent_dimension(each); }, x);
    return sum;
  }
  template <class Delta, class Frame = spatial_frame>
  [[nodiscard]] static auto plus(const X& x, const Delta& delta, Frame frame = {}) {
    Eigen::Index first = 0;
    const auto moved = [&]<class Each>(const Each& each) {
      const Eigen::Index size = tangent_dimension(each), begin = std::exchange(first, first + size);
      return manifold<Each>::plus(
          each, delta.template segment<manifold<Each>::dimension>(begin, size), frame);
    };
    return map_elements(moved, x);
  }
  template <class Frame>
  [[nodiscard]] static auto velocity(const X& x, const X& rate, Frame frame) {
    Eigen::Matrix<scalar, dimension, 1> result;
    result.resize(tangent_dimension(x));
    Eigen::Index first = 0;
    for_each_element(
        [&]<class Each>(const Each& each, const Each& its_rate) {
          const auto velocity = manifold<Each>::velocity(each, its_rate, frame);
          constexpr int count = std::decay_t<decltype(velocity)>::SizeAtCompileTime;
          result.template segment<count>(std::exchange(first, first + velocity.size()),
                                         velocity.size()) = velocity.template cast<scalar>();
        },
        x, rate);
    return result;
  }
};

} // namespace detail

template <class X>
  requires requires { manifold<X>::dimension; }
struct manifold<std::vector<X>> : detail::manifold_of_elements<std::vector<X>, int(Eigen::Dynamic),
                                                               typename manifold<X>::scalar> {};

template <class X, std::size_t N>
  requires requires { manifold<X>::dimension; }
struct manifold<std::array<X, N>>
    : detail::manifold_of_elements<std::array<X, N>,
                                   manifold<X>::dimension == Eigen::Dynamic
                                       ? int(Eigen::Dynamic)
                                       : int(N) * manifold<X>::dimension,
                                   typename manifold<X>::scalar> {};

template <class... X>
  requires(requires { manifold<X>::dimension; } && ...)
struct manifold<std::tuple<X...>>
    : detail::manifold_of_elements<std::tuple<X...>,
                                   ((manifold<X>::dimension == Eigen::Dynamic) || ...)
                                       ? int(Eigen::Dynamic)
                                       : (manifold<X>::dimension + ...),
                                   std::common_type_t<typename manifold<X>::scalar...>> {};

} // namespace duet
