// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/function.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/storage/partials.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

/// \file
/// Seeding: makes the components of arguments the variables of a differentiation.

namespace duet {
namespace detail {

/// Maximum number of components differentiated in a single pass.
inline constexpr int single_pass_limit = 32;
/// Maximum number of components per pass if there are several passes, which are as few as possible.
/// Measured: each pass computes all values again, but longer rows cost more per partial, the sooner
/// the shorter vectors are.
inline constexpr int pass_limit = DUET_BATCH_BYTES < 64 ? 50 : 64;
/// Components per pass over a vector whose size is known only at run time: a short one pays for
/// all.
inline constexpr int chunk = 16;

/// Partials per pass, for passes of equal size.
[[nodiscard]] constexpr int balanced_chunk(int size) {
  const int passes = std::max(1, (size + pass_limit - 1) / pass_limit);
  return std::max(1, (size + passes - 1) / passes);
}

/// Partials per pass over the components of an X; `Chosen` by the caller, or 0 for the default.
template <class X, int Chosen = 0>
inline constexpr int
    partials_per_pass = Chosen > 0 ? Chosen
                        : vector_argument<X>::size_at_compile_time == Eigen::Dynamic
                            ? chunk
                            : balanced_chunk(vector_argument<X>::size_at_compile_time);

/// x over D, every component a constant.
template <class D, class X>
[[nodiscard]] auto constants(const X& x) {
  using argument = vector_argument<X>;
  auto result = argument::template make<D>(x);
  for (Eigen::Index i = 0; i < argument::size(x); ++i) {
    component(result, i) = D(argument::get(x, i));
  }
  return result;
}

/// x, of a size known at compile time, over D, every component a variable.
template <class D, class X>
[[nodiscard]] auto seeded(const X& x) {
  using argument = vector_argument<X>;
  auto result = argument::template make<D>(x);
  unrolled<argument::size_at_compile_time>([&](int i) DUET_INLINE_LAMBDA {
    component(result, i) = D::variable(argument::get(x, i), i);
  });
  return result;
}

/// x + ε v over D.
///
/// \throws invalid_input if the sizes differ; the message names the driver and v
template <class D, class X, class V>
[[nodiscard]] auto moving(const char* driver, const X& x, const char* name, const V& v) {
  using T = typename D::value_type;
  using argument = vector_argument<X>;
  using direction = vector_argument<V>;
  require(argument::size(x) == direction::size(v), "duet: ", driver, ": the point has ",
          argument::size(x), " components, the ", name, " ", direction::size(v));
  auto result = argument::template make<D>(x);
  for (Eigen::Index i = 0; i < argument::size(x); ++i) {
    component(result, i) = D(T(argument::get(x, i)), T(direction::get(v, i)));
  }
  return result;
}

/// x over the duals of one pass over its components, every one a constant.
template <class Tag, int Chosen, class X>
[[nodiscard]] auto constants_of_pass(const X& x) {
  return constants<dual<typename vector_argument<X>::scalar, partials_per_pass<X, Chosen>, Tag>>(x);
}

/// Calls visit(f(x seeded from `first`), first, count) for every pass over the components of x.
/// Between passes only the nonzero partials change.
template <class Tag, int Chosen = 0, class F, class X, class Visit>
void for_each_pass(F&& f, const X& x, Visit&& visit) {
  using argument = vector_argument<X>;
  constexpr int n = partials_per_pass<X, Chosen>;
  using T = typename argument::scalar;
  using D = dual<T, n, Tag>;
  const Eigen::Index size = argument::size(x);
  if constexpr (0 < argument::size_at_compile_time && argument::size_at_compile_time <= n) {
    const auto variables = seeded<D>(x);
    visit(result_of_call(call(f, variables)), 0, size);
  } else {
    auto variables = constants<D>(x);
    for (Eigen::Index first = 0; first < size; first += n) {
      const Eigen::Index count = std::min<Eigen::Index>(n, size - first);
      const auto set_diagonal = [&](const T& slope) {
        for (Eigen::Index i = 0; i < count; ++i) {
          component(variables, first + i).set_partial(int(i), slope);
        }
      };
      set_diagonal(T(1));
      visit(result_of_call(call(f, variables)), first, count);
      set_diagonal(T(0));
    }
  }
}

} // namespace detail
} // namespace duet
