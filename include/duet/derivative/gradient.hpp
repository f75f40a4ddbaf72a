// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/require.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/chunked.hpp>
#include <duet/derivative/result.hpp>
#include <duet/derivative/seed.hpp>
#include <duet/dual/second_dual.hpp>

#include <Eigen/Core>

#include <type_traits>
#include <utility>

/// \file
/// Gradients and Hessians of scalar functions of a vector.

namespace duet {

/// What `gradient` returns: f(x), and ∇f as a column.
template <class Y, class G>
struct value_and_gradient {
  Y value;
  G gradient;
};

/// What `hessian` returns: f(x), ∇f as a column, and the symmetric matrix of second derivatives.
template <class Y, class G, class H>
struct value_gradient_and_hessian {
  Y value;
  G gradient;
  H hessian;
};

/// f(x) and ∇f(x): x an Eigen vector or a `std::array` of n components, f scalar; the gradient is a
/// column of n. Up to 32 components known at compile time take one evaluation of f.
template <class Tag = void, class F, VectorLike X>
[[nodiscard]] auto gradient(F&& f, const X& x) {
  using argument = detail::vector_argument<X>;
  using tag = detail::tag_for<Tag, F>;
  using output = detail::result_of_pass<tag, 0, F, X>;
  static_assert(Scalar<output>, "duet: gradient needs a function that returns a scalar");
  using S = decltype(detail::part<tag>(std::declval<const output&>(), 0));
  using vector = Eigen::Matrix<S, argument::size_at_compile_time, 1>;
  value_and_gradient<S, vector> result{S(0), vector(argument::size(x))};
  detail::require(argument::size(x) > 0, "duet: gradient of a function of no variables");
  result.value = gradient_into<0, std::conditional_t<std::is_void_v<Tag>, std::decay_t<F>, Tag>>(
      f, x, result.gradient);
  return result;
}

/// f(x), ∇f(x) and the symmetric Hessian, for up to 32 components known at compile time.
template <class Tag = void, class F, VectorLike X>
[[nodiscard]] auto hessian(F&& f, const X& x) {
  using argument = detail::vector_argument<X>;
  using T = typename argument::scalar;
  constexpr int n = argument::size_at_compile_time;
  static_assert(n > 0 && n <= detail::single_pass_limit,
                "duet: hessian needs a vector of at most 32 components, known at compile time");
  using tag = detail::tag_for<Tag, F>;
  const auto y = detail::result_of_call(f(detail::seeded<second_dual<T, n, tag>>(x)));
  static_assert(Scalar<std::remove_const_t<decltype(y)>>,
                "duet: hessian needs a function that returns a scalar");
  using S = decltype(detail::part<tag>(y, 0));
  value_gradient_and_hessian<S, Eigen::Matrix<S, n, 1>, Eigen::Matrix<S, n, n>> result;
  result.value = detail::part<tag>(y, 0);
  for (int i = 0; i < n; ++i) {
    result.gradient[i] = detail::part<tag>(y, 1 + i);
    for (int j = 0; j < n; ++j) {
      result.hessian(i, j) = detail::part<tag>(y, 1 + n + n * i + j);
    }
  }
  return result;
}

} // namespace duet
