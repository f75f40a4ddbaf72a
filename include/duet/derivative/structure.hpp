// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/promotion.hpp>

#include <Eigen/Core>

#include <array>
#include <complex>
#include <concepts>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

/// \file
/// What a driver must know of arguments and results: how to reach the scalars in them.

namespace duet {

/// Scalars inside an object: `structure<X>::map(f, x)` is the same object with f applied to each,
/// from the first to the last (which is why results are made in braces). Scalars, Eigen matrices,
/// arrays, complex numbers and tuples are here; rotations and poses add their own.
template <class X>
struct structure;

template <class X>
  requires(Scalar<X> || Arithmetic<X>)
struct structure<X> {
  template <class F>
  [[nodiscard]] static constexpr auto map(F&& f, const X& x) {
    return f(x);
  }
};

template <class X>
  requires std::derived_from<X, Eigen::MatrixBase<X>>
struct structure<X> {
  template <class F>
  [[nodiscard]] static auto map(F&& f, const X& x) {
    using result = std::decay_t<std::invoke_result_t<F, const typename X::Scalar&>>;
    constexpr int options = X::RowsAtCompileTime == 1 && X::ColsAtCompileTime != 1
                                ? int(Eigen::RowMajor)
                                : int(Eigen::ColMajor);
    Eigen::Matrix<result, X::RowsAtCompileTime, X::ColsAtCompileTime, options,
                  X::MaxRowsAtCompileTime, X::MaxColsAtCompileTime>
        y(x.rows(), x.cols());
    for (Eigen::Index j = 0; j < x.cols(); ++j) {
      for (Eigen::Index i = 0; i < x.rows(); ++i) {
        y(i, j) = f(x(i, j));
      }
    }
    return y;
  }
};

template <class T, std::size_t N>
struct structure<std::array<T, N>> {
  template <class F>
  [[nodiscard]] static constexpr auto map(F&& f, const std::array<T, N>& x) {
    using result = std::decay_t<decltype(structure<T>::map(f, x[0]))>;
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
      return std::array<result, N>{structure<T>::map(f, x[I])...};
    }
    (std::make_index_sequence<N>{});
  }
};

/// Complex numbers over duals. (Complex numbers over the reals are scalars themselves.)
template <Infinitesimal T>
struct structure<std::complex<T>> {
  template <class F>
  [[nodiscard]] static constexpr auto map(F&& f, const std::complex<T>& x) {
    using result = std::decay_t<decltype(f(x.real()))>;
    return std::complex<result>(f(x.real()), f(x.imag()));
  }
};

template <class... T>
struct structure<std::tuple<T...>> {
  template <class F>
  [[nodiscard]] static constexpr auto map(F&& f, const std::tuple<T...>& x) {
    return std::apply(
        [&](const T&... t) {
          return std::tuple<decltype(structure<T>::map(f, t))...>{structure<T>::map(f, t)...};
        },
        x);
  }
};

template <class A, class B>
struct structure<std::pair<A, B>> {
  template <class F>
  [[nodiscard]] static constexpr auto map(F&& f, const std::pair<A, B>& x) {
    return std::pair<decltype(structure<A>::map(f, x.first)),
                     decltype(structure<B>::map(f, x.second))>{structure<A>::map(f, x.first),
                                                               structure<B>::map(f, x.second)};
  }
};

/// f applied to every scalar of x.
template <class F, class X>
[[nodiscard]] constexpr auto map_scalars(F&& f, const X& x) {
  return structure<X>::map(f, x);
}

namespace detail {

/// f applied to the value and to every infinitesimal part of a number: the same level over what f
/// returns.
template <class F, class T, int N, class Tag>
[[nodiscard]] constexpr auto map_parts(F&& f, const dual<T, N, Tag>& x) {
  dual<std::decay_t<decltype(f(x.value()))>, N, Tag> y(f(x.value()));
  for (int i = 0; i < x.size(); ++i) {
    y.set_partial(i, f(x.partial(i)));
  }
  return y;
}
template <class F, class T, int K, class Tag>
[[nodiscard]] constexpr auto map_parts(F&& f, const taylor<T, K, Tag>& x) {
  taylor<std::decay_t<decltype(f(x.value()))>, K, Tag> y;
  for (int k = 0; k <= K; ++k) {
    y.set_coefficient(k, f(x.coefficient(k)));
  }
  return y;
}

template <class F, class T, int N, class Tag>
[[nodiscard]] auto map_parts(F&& f, const second_dual<T, N, Tag>& x) {
  return x.map_parts(f);
}

template <class T, int N, class Tag>
[[nodiscard]] constexpr T own_part(const dual<T, N, Tag>& x, int k) {
  return k == 0 ? x.value() : x.partial(k - 1);
}
template <class T, int K, class Tag>
[[nodiscard]] constexpr T own_part(const taylor<T, K, Tag>& x, int k) {
  return x.derivative(k);
}

template <class T, int N, class Tag>
[[nodiscard]] T own_part(const second_dual<T, N, Tag>& x, int k) {
  return k == 0   ? x.value()
         : k <= N ? x.partial(k - 1)
                  : x.second_partial((k - N - 1) / N, (k - N - 1) % N);
}

/// Part of a scalar with respect to the level tagged `Tag`, wherever it stands in the nesting: 0
/// the value, k the k-th partial of a dual or the k-th derivative of a Taylor number; for second
/// derivatives by N variables 1 … N the gradient, then the Hessian row by row. A scalar without
/// that level does not depend on it.
template <class Tag, class T>
[[nodiscard]] constexpr auto part(const T& x, int k) {
  if constexpr (!contains_tag<T, Tag>()) {
    return k == 0 ? x : T(0);
  } else if constexpr (std::is_same_v<level_tag<T>, Tag>) {
    return own_part(x, k);
  } else {
    return map_parts([k](const auto& y) { return part<Tag>(y, k); }, x);
  }
}

/// The k-th part, by Tag, of every scalar of a result.
template <class Tag, class X>
[[nodiscard]] constexpr auto parts(const X& x, int k) {
  return map_scalars([k](const auto& s) { return part<Tag>(s, k); }, x);
}

/// X, but of an expression of Eigen the vector or matrix that it stands for.
template <class X>
struct own {
  using type = X;
};
template <class X>
  requires std::derived_from<X, Eigen::MatrixBase<X>>
struct own<X> {
  using type = typename X::PlainObject;
};
template <class X>
using own_t = typename own<X>::type;

/// Integers are differentiated as reals.
template <class X>
using differentiable_t = std::conditional_t<std::integral<X>, double, X>;

/// The tag of a driver: the caller's, or the differentiated function.
template <class Given, class F>
using tag_for = std::conditional_t<std::is_void_v<Given>, derivative_tag<std::decay_t<F>>,
                                   derivative_tag<Given>>;

} // namespace detail
} // namespace duet
