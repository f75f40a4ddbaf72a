// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/derivative/manifold.hpp>

#include <Eigen/Core>

#include <array>
#include <concepts>
#include <cstddef>
#include <limits>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Parameters of an estimation: scalars, vectors, rotations, poses and collections of them, as one
/// vector of tangent coordinates.

namespace duet::detail {

/// Tangent coordinates of the parameters in an X, those of `manifold<X>`:
///
/// - `at(x, first, coordinate)`: x where coordinate k has the value coordinate(value, first + k),
///   of any scalar; value is x's, for rotations and poses 0, which then move in body axes
/// - `values(x, v, first)`: writes the values of scalars and components of vectors into v from
///   `first` on; NaN for coordinates of rotations and poses
/// - `name(x, k)`: the name of coordinate k, such as "[2] rotation about x"
template <class X>
struct parameters;

template <class X>
concept ParameterSet = requires {
  sizeof(parameters<X>);
};

template <std::same_as<double> X>
struct parameters<X> {
  static auto at(const X& x, Eigen::Index first, const auto& coordinate) {
    return coordinate(x, first);
  }
  static void values(const X& x, Eigen::VectorXd& v, Eigen::Index first) { v[first] = x; }
  static std::string name(const X&, Eigen::Index) { return ""; }
};

template <EigenMatrix X>
  requires std::same_as<typename X::Scalar, double>
struct parameters<X> {
  static auto at(const X& x, Eigen::Index first, const auto& coordinate) {
    using D = std::decay_t<decltype(coordinate(0., first))>;
    Eigen::Matrix<D, fixed_length<D>(X::RowsAtCompileTime), fixed_length<D>(X::ColsAtCompileTime)>
        y(x.rows(), x.cols());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      y(i) = coordinate(x(i), first + i);
    }
    return y;
  }
  static void values(const X& x, Eigen::VectorXd& v, Eigen::Index first) {
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      v[first + i] = x(i);
    }
  }
  static std::string name(const X&, Eigen::Index k) { return message("[", k, "]"); }
};

/// Rotations and poses.
template <class X>
  requires(!VectorLike<X> && std::same_as<typename manifold<X>::scalar, double> &&
           requires { manifold<X>::takes_rates_of_any_scalar; })
struct parameters<X> {
  static constexpr int dimension = manifold<X>::dimension;
  static auto at(const X& x, Eigen::Index first, const auto& coordinate) {
    Eigen::Matrix<std::decay_t<decltype(coordinate(0., first))>, dimension, 1> delta;
    for (int k = 0; k < dimension; ++k) {
      delta[k] = coordinate(0., first + k);
    }
    return manifold<X>::plus(x, delta, frame::body);
  }
  static void values(const X&, Eigen::VectorXd& v, Eigen::Index first) {
    v.segment<dimension>(first).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  static std::string name(const X&, Eigen::Index k) {
    const bool is_translation = dimension == 6 && k < 3;
    return message(is_translation ? " translation along " : " rotation about ",
                   std::string(1, "xyz"[std::size_t(k % 3)]));
  }
};

/// Arrays, `std::vector`s and tuples.
template <class X>
struct parameters_of_elements {
  static auto at(const X& x, Eigen::Index first, const auto& coordinate) {
    return map_elements(
        [&]<class Each>(const Each& each) {
          return parameters<Each>::at(each, std::exchange(first, first + tangent_dimension(each)),
                                      coordinate);
        },
        x);
  }
  static void values(const X& x, Eigen::VectorXd& v, Eigen::Index first) {
    for_each_element(
        [&]<class Each>(const Each& each) {
          parameters<Each>::values(each, v, std::exchange(first, first + tangent_dimension(each)));
        },
        x);
  }
  static std::string name(const X& x, Eigen::Index k) {
    std::string result;
    int i = 0;
    for_each_element(
        [&]<class Each>(const Each& each) {
          const Eigen::Index count = tangent_dimension(each);
          if (0 <= k && k < count) {
            result = message(is_tuple<X> ? "argument " : "[", i, is_tuple<X> ? "" : "]",
                             parameters<Each>::name(each, k));
          }
          k -= count;
          ++i;
        },
        x);
    return result;
  }
};

template <ParameterSet X>
struct parameters<std::vector<X>> : parameters_of_elements<std::vector<X>> {};
template <ParameterSet X, std::size_t N>
struct parameters<std::array<X, N>> : parameters_of_elements<std::array<X, N>> {};
template <ParameterSet... X>
  requires(sizeof...(X) > 0)
struct parameters<std::tuple<X...>> : parameters_of_elements<std::tuple<X...>> {};

/// Replaces rotations and poses by units, from which steps deviate by round-off.
template <class X>
void normalise(X& x) {
  if constexpr (requires { manifold<X>::takes_rates_of_any_scalar; } && !VectorLike<X>) {
    x = normalized(x);
  } else if constexpr (is_tuple<X> || (!EigenMatrix<X> && requires { x.begin(); })) {
    for_each_element([](auto& each) { normalise(each); }, x);
  }
}

} // namespace duet::detail
