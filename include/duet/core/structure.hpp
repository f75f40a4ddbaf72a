// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>

#include <array>
#include <complex>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Traversal of the scalars in an object: containers of any kind define access to them, and lanes,
/// derivatives and constants of whole objects follow. For those who extend duet.

namespace duet {

/// Scalars inside an object: `structure<X>::map(f, x, y…)` is the same object with f of the scalars
/// at the same position in x and y…, from the first to the last (which is why results are
/// constructed in braces); `structure<X>::scalar` is their type if they have one. Scalars, arrays,
/// standard vectors, complex numbers and tuples are defined here; matrices of Eigen, rotations and
/// poses separately.
template <class X>
struct structure;

template <class X>
  requires(Scalar<X> || Arithmetic<X>)
struct structure<X> {
  using scalar = X;
  template <class F, class... Rest>
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr auto map(F&& f, const X& x,
                                                             const Rest&... rest) {
    return f(x, rest...);
  }
};

template <class T, std::size_t N>
struct structure<std::array<T, N>> {
  using scalar = typename structure<T>::scalar;
  template <class F, class... Rest>
  [[nodiscard]] DUET_ALWAYS_INLINE static constexpr auto map(F&& f, const std::array<T, N>& x,
                                                             const Rest&... rest) {
    using result = std::decay_t<decltype(structure<T>::map(f, x[0], rest[0]...))>;
    return [&]<std::size_t... I>(std::index_sequence<I...>) DUET_INLINE_LAMBDA {
      const auto at = [&](std::size_t i)
                          DUET_INLINE_LAMBDA { return structure<T>::map(f, x[i], rest[i]...); };
      return std::array<result, N>{at(I)...};
    }
    (std::make_index_sequence<N>{});
  }
};

template <class T, class Allocator>
struct structure<std::vector<T, Allocator>> {
  using scalar = typename structure<T>::scalar;
  template <class F, class... Rest>
  [[nodiscard]] static auto map(F&& f, const std::vector<T, Allocator>& x, const Rest&... rest) {
    std::vector<std::decay_t<decltype(structure<T>::map(f, x[0], rest[0]...))>> result;
    result.reserve(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      result.push_back(structure<T>::map(f, x[i], rest[i]...));
    }
    return result;
  }
};

/// Complex numbers over duals. (Complex numbers over the reals are scalars themselves.)
template <Infinitesimal T>
struct structure<std::complex<T>> {
  using scalar = T;
  template <class F, class... Rest>
  [[nodiscard]] static constexpr auto map(F&& f, const std::complex<T>& x, const Rest&... rest) {
    using result = std::decay_t<decltype(f(x.real(), rest.real()...))>;
    return std::complex<result>{f(x.real(), rest.real()...), f(x.imag(), rest.imag()...)};
  }
};

template <class... T>
struct structure<std::tuple<T...>> {
  template <class F, class... Rest>
  [[nodiscard]] static constexpr auto map(F&& f, const std::tuple<T...>& x, const Rest&... rest) {
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
      const auto at = [&]<std::size_t K>(std::integral_constant<std::size_t, K>) {
        return structure<std::tuple_element_t<K, std::tuple<T...>>>::map(f, std::get<K>(x),
                                                                         std::get<K>(rest)...);
      };
      return std::tuple<decltype(at(std::integral_constant<std::size_t, I>{}))...>{
          at(std::integral_constant<std::size_t, I>{})...};
    }
    (std::index_sequence_for<T...>{});
  }
};

template <class A, class B>
struct structure<std::pair<A, B>> {
  template <class F, class... Rest>
  [[nodiscard]] static constexpr auto map(F&& f, const std::pair<A, B>& x, const Rest&... rest) {
    return std::pair{structure<A>::map(f, x.first, rest.first...),
                     structure<B>::map(f, x.second, rest.second...)};
  }
};

/// True if X defines access to its scalars.
template <class X>
concept Structured = requires {
  sizeof(structure<X>);
};

/// f of every scalar of x, and of the scalars at the same position in the other arguments.
template <class F, class X, class... Rest>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto map_scalars(F&& f, const X& x,
                                                            const Rest&... rest) {
  return structure<X>::map(f, x, rest...);
}

} // namespace duet

namespace duet::detail {

/// T(), or zeros if T is a matrix of fixed size, whose default constructor leaves its entries
/// uninitialised.
template <class T>
[[nodiscard]] constexpr T zero_initialized() {
  if constexpr (requires { requires(T::SizeAtCompileTime > 0); }) {
    return T::Zero();
  } else {
    return T();
  }
}

} // namespace duet::detail
