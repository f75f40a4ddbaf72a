// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/refused.hpp>
#include <duet/core/own_numbers.hpp>
#include <duet/core/scalar_traits.hpp>
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
/// Function traits used by the drivers: argument types, tags of infinitesimals, and returned
/// values.

namespace duet::detail {

/// X, or the vector or matrix that X evaluates to if it is an expression of Eigen.
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

/// The tag of a driver: the caller's, or the differentiated function.
template <class Chosen, class F>
using tag_for = std::conditional_t<std::is_void_v<Chosen>, derivative_tag<std::decay_t<F>>,
                                   derivative_tag<Chosen>>;

/// A parameter that holds real numbers alone.
template <class A>
concept RealParameter = Arithmetic<A> || Real<A> ||(Structured<A>&& requires {
  requires Arithmetic<typename structure<A>::scalar> || Real<typename structure<A>::scalar>;
});

template <class R, class... A>
std::bool_constant<(sizeof...(A) > 0 && (RealParameter<std::decay_t<A>> && ...))>
    has_real_parameters(R (*)(A...));
template <class R, class C, class... A>
std::bool_constant<(sizeof...(A) > 0 && (RealParameter<std::decay_t<A>> && ...))>
    has_real_parameters(R (C::*)(A...));
template <class R, class C, class... A>
std::bool_constant<(sizeof...(A) > 0 && (RealParameter<std::decay_t<A>> && ...))>
has_real_parameters(R (C::*)(A...) const);

/// A function, or an object with one `operator()`, of real numbers, which cannot be differentiated.
template <class F>
concept FunctionOfReals = requires(std::decay_t<F> f) {
  requires decltype(has_real_parameters(f))::value;
}
|| requires { requires decltype(has_real_parameters(&std::decay_t<F>::operator()))::value; };

/// Any other function: accepted by the drivers. (Formulas have separate drivers.)
template <class F>
concept FunctionOfAny = !FunctionOfReals<F> && !is_symbolic<std::remove_cvref_t<F>>;

/// Result of a user's function, as an owning object. (Its type is deduced, so that compilers report
/// the error first, even if only the type is needed.)
template <class X>
[[nodiscard]] constexpr auto result_of_call(X&& x) {
  using result = std::remove_cvref_t<X>;
  require_owning_result<result>();
  static_assert(
      refers_elsewhere<result> || requires { sizeof(structure<result>); },
      "duet: a function must return a scalar, an Eigen vector or matrix, a rotation, a "
      "pose, or an array, standard vector, tuple or pair of these");
  return std::forward<X>(x);
}

} // namespace duet::detail

namespace duet {

/// Callable with a separate function `jacobian`, such as a mechanism, which is not differentiated
/// as a callable. For those who extend duet.
template <class F>
concept HasOwnJacobian = requires {
  typename std::remove_cvref_t<F>::own_jacobian;
};

} // namespace duet

/// Message for a function of real numbers passed to `driver`.
#define DUET_REFUSED_FUNCTION(driver)                                                              \
  DUET_REFUSED(#driver ": the function must take any scalar: [](const auto& x) { ... }")
