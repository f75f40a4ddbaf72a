// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/derivative/structure.hpp>
#include <duet/dual/math.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <utility>

/// \file
/// Arguments of several components, and how they are made the variables of a differentiation.

namespace duet {
namespace detail {

template <class X>
struct vector_argument;

template <class X>
  requires std::derived_from<X, Eigen::MatrixBase<X>>
struct vector_argument<X> {
  static_assert(X::ColsAtCompileTime == 1 || X::IsVectorAtCompileTime,
                "duet: differentiate with respect to a vector, not to a matrix");
  using scalar = differentiable_t<typename X::Scalar>;
  static constexpr int size_at_compile_time = X::SizeAtCompileTime;
  template <class D>
  using over = Eigen::Matrix<D, X::RowsAtCompileTime, X::ColsAtCompileTime>;
  static Eigen::Index size(const X& x) { return x.size(); }
  static scalar get(const X& x, Eigen::Index i) { return scalar(x[i]); }
  template <class D>
  static over<D> make(const X& x) {
    return over<D>(x.rows(), x.cols());
  }
};

template <class T, std::size_t N>
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

/// Up to this many components are differentiated in one pass; more, and vectors whose size is known
/// at run time, in passes of `chunk` components. Measured: longer rows leave the registers.
inline constexpr int single_pass_limit = 32;
inline constexpr int chunk = 8;

/// Partials per pass over the components of an X; `Chosen` by the caller, or 0.
template <class X, int Chosen = 0>
inline constexpr int partials_per_pass =
    Chosen > 0 ? Chosen
    : vector_argument<X>::size_at_compile_time > 0 &&
            vector_argument<X>::size_at_compile_time <= single_pass_limit
        ? vector_argument<X>::size_at_compile_time
        : chunk;

/// x over D, every component a constant.
template <class D, class X>
[[nodiscard]] auto constants(const X& x) {
  using argument = vector_argument<X>;
  auto result = argument::template make<D>(x);
  for (Eigen::Index i = 0; i < argument::size(x); ++i) {
    result[std::size_t(i)] = D(argument::get(x, i));
  }
  return result;
}

/// Makes the components [first, first + N) variables.
template <class D, int N, class Seeded, class X>
void seed(Seeded& variables, const X& x, Eigen::Index first) {
  using argument = vector_argument<X>;
  for (Eigen::Index i = first; i < std::min<Eigen::Index>(first + N, argument::size(x)); ++i) {
    variables[std::size_t(i)] = D::variable(argument::get(x, i), int(i - first));
  }
}

/// x with the components [first, first + N) as variables.
template <class D, int N, class X>
[[nodiscard]] auto seeded(const X& x, Eigen::Index first) {
  auto result = constants<D>(x);
  seed<D, N>(result, x, first);
  return result;
}

/// Calls visit(f(x seeded from `first`), first, count) for every pass over the components of x.
template <class Tag, int Chosen = 0, class F, class X, class Visit>
void for_each_pass(F&& f, const X& x, Visit&& visit) {
  using argument = vector_argument<X>;
  constexpr int n = partials_per_pass<X, Chosen>;
  using D = dual<typename argument::scalar, n, Tag>;
  const Eigen::Index size = argument::size(x);
  auto variables = constants<D>(x);
  for (Eigen::Index first = 0; first < size; first += n) {
    seed<D, n>(variables, x, first);
    const Eigen::Index count = std::min<Eigen::Index>(n, size - first);
    visit(evaluated(f(std::as_const(variables))), first, count);
    for (Eigen::Index i = first; i < first + count; ++i) {
      variables[std::size_t(i)] = D(argument::get(x, i));
    }
  }
}

} // namespace detail

/// A function's argument of several components: an Eigen vector or a `std::array` of scalars.
template <class X>
concept VectorLike = requires {
  typename detail::vector_argument<X>::scalar;
};

} // namespace duet
