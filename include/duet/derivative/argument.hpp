// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/number/tag.hpp>

#include <Eigen/Core>

#include <concepts>
#include <type_traits>

/// \file
/// What drivers make of their arguments' types, and the tag of their infinitesimals.

namespace duet::detail {

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

} // namespace duet::detail
