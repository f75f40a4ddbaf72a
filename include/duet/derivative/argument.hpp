// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/refused.hpp>
#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/derivative/function.hpp>
#include <duet/dual/eigen_structure.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Arguments of several components. For those who extend duet.

namespace duet {
namespace detail {

template <class X>
inline constexpr bool is_tuple = false;
template <class... X>
inline constexpr bool is_tuple<std::tuple<X...>> = true;

template <class X>
struct vector_argument;

/// n, or a size known at run time if Eigen considers n too large for the stack.
template <class D>
constexpr int fixed_length(int n) {
  const bool is_large = n > 1 && EIGEN_STACK_ALLOCATION_LIMIT > 0 &&
                        std::size_t(n) * sizeof(D) > std::size_t(EIGEN_STACK_ALLOCATION_LIMIT);
  return is_large ? Eigen::Dynamic : n;
}

/// True for Eigen arguments with rows and columns.
template <class X>
inline constexpr bool is_matrix_argument = false;
template <class X>
  requires EigenMatrix<X>
inline constexpr bool is_matrix_argument<X> =
    X::ColsAtCompileTime != 1 && !bool(X::IsVectorAtCompileTime);
template <class... X>
inline constexpr bool is_matrix_argument<std::tuple<X...>> = (is_matrix_argument<X> || ...);

template <class X>
  requires(EigenMatrix<X> && !is_matrix_argument<X>)
struct vector_argument<X> {
  using scalar = differentiable_t<typename X::Scalar>;
  static constexpr int size_at_compile_time = X::SizeAtCompileTime;
  template <class D>
  using over = Eigen::Matrix<D, fixed_length<D>(X::RowsAtCompileTime),
                             fixed_length<D>(X::ColsAtCompileTime)>;
  static Eigen::Index size(const X& x) { return x.size(); }
  static scalar get(const X& x, Eigen::Index i) { return scalar(x[i]); }
  template <class D>
  static over<D> make(const X& x) {
    return over<D>(x.rows(), x.cols());
  }
};

template <class T, std::size_t N>
  requires(Scalar<T> || Arithmetic<T>)
struct vector_argument<std::array<T, N>> {
  using scalar = differentiable_t<T>;
  static constexpr int size_at_compile_time = int(N);
  template <class D>
  using over = std::array<D, N>;
  static constexpr Eigen::Index size(const std::array<T, N>&) { return Eigen::Index(N); }
  static scalar get(const std::array<T, N>& x, Eigen::Index i) { return scalar(x[std::size_t(i)]); }
  template <class D>
  static over<D> make(const std::array<T, N>&) {
    return {};
  }
};

template <class T>
  requires(Scalar<T> || Arithmetic<T>)
struct vector_argument<std::vector<T>> {
  using scalar = differentiable_t<T>;
  static constexpr int size_at_compile_time = Eigen::Dynamic;
  template <class D>
  using over = std::vector<D>;
  static Eigen::Index size(const std::vector<T>& x) { return Eigen::Index(x.size()); }
  static scalar get(const std::vector<T>& x, Eigen::Index i) { return scalar(x[std::size_t(i)]); }
  template <class D>
  static over<D> make(const std::vector<T>& x) {
    return over<D>(x.size());
  }
};

/// A vector or scalar among several arguments.
template <class X>
struct argument_part;
template <class X>
  requires(!is_tuple<X> && requires { typename vector_argument<X>::scalar; })
struct argument_part<X> : vector_argument<X> {};
template <class X>
  requires(Scalar<X> || Arithmetic<X>)
struct argument_part<X> {
  using scalar = differentiable_t<X>;
  static constexpr int size_at_compile_time = 1;
  template <class D>
  using over = D;
  static constexpr Eigen::Index size(const X&) { return 1; }
  static scalar get(const X& x, Eigen::Index) { return scalar(x); }
  template <class D>
  static over<D> make(const X&) {
    return {};
  }
};

/// The component of a scalar, a vector, or of several arguments one after the other.
template <class X>
[[nodiscard]] DUET_ALWAYS_INLINE auto& component(X& x, Eigen::Index i) {
  if constexpr (Scalar<std::remove_const_t<X>>) {
    return x;
  } else if constexpr (EigenMatrix<X>) {
    return x.coeffRef(i);
  } else {
    return x[std::size_t(i)];
  }
}

/// visit(part, k), where the i-th component of several arguments is the k-th of that part.
template <std::size_t I = 0, class Tuple, class Visit>
decltype(auto) at_component(Tuple& x, Eigen::Index i, const Visit& visit) {
  auto& part = std::get<I>(x);
  if constexpr (I + 1 == std::tuple_size_v<std::remove_const_t<Tuple>>) {
    return visit(part, i);
  } else {
    const Eigen::Index size = argument_part<std::decay_t<decltype(part)>>::size(part);
    return i < size ? visit(part, i) : at_component<I + 1>(x, i - size, visit);
  }
}
template <class... Parts>
[[nodiscard]] auto& component(std::tuple<Parts...>& x, Eigen::Index i) {
  return at_component(
      x, i, [](auto& part, Eigen::Index k) -> auto& { return component(part, k); });
}

/// Several arguments, scalars and vectors: their components one after the other.
template <class... X>
  requires(sizeof...(X) > 0 && (requires { typename argument_part<X>::scalar; } && ...))
struct vector_argument<std::tuple<X...>> {
  using scalar = std::common_type_t<typename argument_part<X>::scalar...>;
  static constexpr int size_at_compile_time =
      ((argument_part<X>::size_at_compile_time == Eigen::Dynamic) || ...)
          ? Eigen::Dynamic
          : (argument_part<X>::size_at_compile_time + ...);
  template <class D>
  using over = std::tuple<typename argument_part<X>::template over<D>...>;
  static Eigen::Index size(const std::tuple<X...>& x) {
    return std::apply([](const X&... part) { return (argument_part<X>::size(part) + ...); }, x);
  }
  static scalar get(const std::tuple<X...>& x, Eigen::Index i) {
    return at_component(x, i, []<class Part>(const Part& part, Eigen::Index k) {
      return scalar(argument_part<Part>::get(part, k));
    });
  }
  template <class D>
  static over<D> make(const std::tuple<X...>& x) {
    return std::apply(
        [](const X&... part) { return over<D>{argument_part<X>::template make<D>(part)...}; }, x);
  }
};

/// Calls f with x, or with the elements of the tuple x if f takes several arguments instead of one
/// tuple.
template <class F, class X>
[[nodiscard]] DUET_ALWAYS_INLINE decltype(auto) call(F&& f, const X& x) {
  constexpr bool takes_several = [] {
    if constexpr (is_tuple<X>) {
      return !std::is_invocable_v<F&, const X&>;
    } else {
      return false; // without a call, so that compilers instantiate f only by f(x)
    }
  }();
  if constexpr (takes_several) {
    return std::apply(f, x);
  } else {
    return f(x);
  }
}

} // namespace detail

/// Variables of a differentiation: an Eigen vector, a `std::array` or `std::vector` of scalars, or
/// a `std::tuple` of these and of scalars, whose components follow one after the other.
template <class X>
concept Variables = requires {
  typename detail::vector_argument<X>::scalar;
};

/// An argument of several components: an Eigen vector, a `std::array` or `std::vector` of scalars.
template <class X>
concept VectorLike = Variables<X> && !detail::is_tuple<X>;

} // namespace duet

/// Rejects variables that `driver` does not support: matrices, several arguments that are not a
/// tuple, and a single number, for which there is `of_one`; then the type of its result.
#define DUET_REFUSES_ARGUMENTS(driver, of_one, ...)                                                \
  template <class Tag = void, detail::FunctionOfAny F, class X>                                    \
    requires(detail::is_matrix_argument<X> && !HasOwnJacobian<F>)                                  \
  DUET_REFUSED("differentiate with respect to a vector, not to a matrix: " #driver                 \
               "(f, x.reshaped())")                                                                \
  __VA_ARGS__ driver(F&&, const X&);                                                               \
  template <class Tag = void, detail::FunctionOfAny F, class A, class B, class... More>            \
    requires(!FrameConstant<B> && !HasOwnJacobian<F>)                                              \
  DUET_REFUSED("pass several arguments as a tuple: " #driver "(f, std::tuple(a, b))")              \
  __VA_ARGS__ driver(F&&, const A&, const B&, const More&...);                                     \
  template <class Tag = void, detail::FunctionOfAny F, class X>                                    \
    requires((Scalar<X> || Arithmetic<X>)&&!HasOwnJacobian<F>)                                     \
  DUET_REFUSED(#driver                                                                             \
               " differentiates with respect to a vector; with respect to one number use " of_one) \
  __VA_ARGS__ driver(F&&, const X&);

/// Rejects matrices for a `driver` with more arguments, `rest` in the message.
#define DUET_REFUSES_MATRICES(driver, rest, ...)                                                   \
  template <class Tag = void, detail::FunctionOfAny F, class X, class... Rest>                     \
    requires(detail::is_matrix_argument<X> && sizeof...(Rest) > 0)                                 \
  DUET_REFUSED("differentiate with respect to a vector, not to a matrix: " #driver                 \
               "(f, x.reshaped(), " rest ")")                                                      \
  __VA_ARGS__ driver(F&&, const X&, Rest&&...);
#define DUET_REFUSES_MATRICES_IN_CHUNKS(driver, rest, ...)                                         \
  template <int Chunk = 0, class Tag = void, detail::FunctionOfAny F, class X, class J>            \
    requires(detail::is_matrix_argument<X>)                                                        \
  DUET_REFUSED("differentiate with respect to a vector, not to a matrix: " #driver                 \
               "(f, x.reshaped(), " rest ")")                                                      \
  __VA_ARGS__ driver(F&&, const X&, J&&);
