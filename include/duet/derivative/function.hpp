// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/own_numbers.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual/eigen_structure.hpp>
#include <duet/dual/promotion.hpp>

#include <Eigen/Core>

#include <array>
#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

/// \file
/// What drivers make of a function: of the types of its arguments, of its own for a tag of their
/// infinitesimals, and of what it returns.

namespace duet::detail {

/// X, but of an expression of Eigen the vector or matrix that it stands for.
template <class X>
struct own {
  using type = X;
};
template <class X>
  requires EigenMatrix<X>
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

/// What a function of the caller's returned, as an object of its own. (Its type is deduced, so that
/// compilers say first of all what is wrong, also where only the type is asked for.)
template <class X>
[[nodiscard]] constexpr auto result_of_call(X&& x) {
  using result = std::remove_cvref_t<X>;
  require_own_numbers<result>();
  static_assert(
      refers_elsewhere<result> || requires { sizeof(structure<result>); },
      "duet: a function must return a scalar, an Eigen vector or matrix, a rotation, a "
      "pose, or an array, standard vector, tuple or pair of these");
  return std::forward<X>(x);
}

} // namespace duet::detail
