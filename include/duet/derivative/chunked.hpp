// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/require.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/result.hpp>
#include <duet/derivative/seed.hpp>
#include <duet/dual/parts.hpp>

#include <Eigen/Core>

#include <type_traits>
#include <utility>

/// \file
/// Derivatives by thousands of inputs, in passes of a chosen size, into memory of the caller.

namespace duet {
namespace detail {

/// Rows times columns of what the caller gave for a result.
template <class Out>
void require_size(const char* driver, const Out& out, Eigen::Index rows, Eigen::Index columns) {
  const auto text = [](Eigen::Index r, Eigen::Index c) {
    return c == 1 ? message(r) : message(r, " x ", c);
  };
  if (out.rows() != rows || out.cols() != columns) {
    throw invalid_input(message("duet: ", driver, ": the result needs size ", text(rows, columns),
                                ", but has ", text(out.rows(), out.cols())));
  }
}

} // namespace detail

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

/// f(x); writes ∂f_i/∂x_j into `jacobian`, any writable Eigen matrix of as many rows as f(x) has
/// components and as many columns as x. Everything else as `gradient_into`.
template <int Chunk = 0, class Tag = void, class F, VectorLike X, class J>
[[nodiscard]] auto jacobian_into(F&& f, const X& x, J&& jacobian) {
  static_assert(Chunk >= 0, "duet: jacobian_into<Chunk> needs a number of partials");
  using tag = detail::tag_for<Tag, F>;
  using output = detail::result_of_pass<tag, Chunk, F, X>;
  static_assert(VectorLike<output>, "duet: jacobian_into needs a function that returns a vector");
  const Eigen::Index size = detail::vector_argument<X>::size(x);
  detail::require(size > 0, "duet: jacobian_into of a function of no variables");
  return detail::write_jacobian<tag, Chunk>(f, x, jacobian, [&](Eigen::Index rows) {
    detail::require_size("jacobian_into", jacobian, rows, size);
  });
}

} // namespace duet
