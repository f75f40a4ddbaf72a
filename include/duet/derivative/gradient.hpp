// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/function.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/seed.hpp>
#include <duet/dual/parts.hpp>
#include <duet/dual/second_dual.hpp>

#include <Eigen/Core>

#include <type_traits>
#include <utility>

/// \file
/// Gradients and Hessians of scalar functions of a vector; gradients by thousands of components in
/// passes of a chosen size, into memory of the caller.

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

/// f(x); writes ∇f into `gradient`, any writable Eigen vector of as many components as x.
///
/// \tparam Chunk  components differentiated per evaluation of f; 0 takes what was measured to be
///                best, see docs/benchmarks.md. More partials per pass evaluate f less often, but
///                every number of f holds them all.
///
/// One vector of seeds is allocated per call where x has its size at run time, none otherwise; f
/// takes it by reference.
/// \throws invalid_input where the sizes do not match or x is empty
///
/// Example: `Eigen::VectorXd g(n); const double y = gradient_into<16>(f, x, g);`
template <int Chunk = 0, class Tag = void, class F, VectorLike X, class G>
[[nodiscard]] auto gradient_into(F&& f, const X& x, G&& gradient) {
  static_assert(Chunk >= 0, "duet: gradient_into<Chunk> needs a number of partials");
  using tag = detail::tag_for<Tag, F>;
  using output = detail::result_of_pass<tag, Chunk, F, X>;
  static_assert(Scalar<output>, "duet: gradient_into needs a function that returns a scalar");
  const Eigen::Index size = detail::vector_argument<X>::size(x);
  detail::require(size > 0, "duet: gradient_into of a function of no variables");
  detail::require_size("gradient_into", gradient, size, 1);
  decltype(detail::part<tag>(std::declval<const output&>(), 0)) value(0);
  detail::for_each_pass<tag, Chunk>(f, x,
                                    [&](const auto& y, Eigen::Index first, Eigen::Index count) {
                                      value = detail::part<tag>(y, 0);
                                      for (Eigen::Index i = 0; i < count; ++i) {
                                        gradient[first + i] = detail::part<tag>(y, int(i) + 1);
                                      }
                                    });
  return value;
}

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
