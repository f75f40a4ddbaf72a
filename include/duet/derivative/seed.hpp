// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/derivative/structure.hpp>
#include <duet/dual/math.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>

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
/// at run time, in passes of `chunk` components.
inline constexpr int single_pass_limit = 32;
inline constexpr int chunk = 8;

template <class X>
inline constexpr int partials_per_pass =
    vector_argument<X>::size_at_compile_time > 0 &&
            vector_argument<X>::size_at_compile_time <= single_pass_limit
        ? vector_argument<X>::size_at_compile_time
        : chunk;

/// x with the components [first, first + N) as variables.
template <class D, int N, class X>
[[nodiscard]] auto seeded(const X& x, Eigen::Index first) {
  using argument = vector_argument<X>;
  auto result = argument::template make<D>(x);
  for (Eigen::Index i = 0; i < argument::size(x); ++i) {
    const auto value = argument::get(x, i);
    const bool is_variable = i >= first && i < first + N;
    result[std::size_t(i)] = is_variable ? D::variable(value, int(i - first)) : D(value);
  }
  return result;
}

/// Calls visit(f(x seeded from `first`), first, count) for every pass over the components of x.
template <class Tag, class F, class X, class Visit>
void for_each_pass(F&& f, const X& x, Visit&& visit) {
  constexpr int n = partials_per_pass<X>;
  using D = dual<typename vector_argument<X>::scalar, n, Tag>;
  const Eigen::Index size = vector_argument<X>::size(x);
  for (Eigen::Index first = 0; first < size; first += n) {
    visit(evaluated(f(seeded<D, n>(x, first))), first, std::min<Eigen::Index>(n, size - first));
  }
}

} // namespace detail

/// A function's argument of several components: an Eigen vector or a `std::array` of scalars.
template <class X>
concept VectorLike = requires {
  typename detail::vector_argument<X>::scalar;
};

} // namespace duet
