// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/tape/derivation.hpp>
#include <duet/expression/tape/program.hpp>
#include <duet/expression/tree/bindings.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/variables.hpp>

#include <Eigen/Core>

/// \file
/// Gradients and Hessians of scalar formulas, whose structural zeros are known at compile time.

namespace duet::expression {

namespace detail {

/// Evaluates a formula and its gradient.
template <class Motions>
struct gradient_of;
template <class... Motions>
struct gradient_of<motion_list<Motions...>> {
  using result = value_and_gradient<double, Eigen::VectorXd>;

  template <class Node, class Bindings>
  [[nodiscard]] DUET_ALWAYS_INLINE static auto of(const Bindings& b) {
    constexpr int n = int(sizeof...(Motions));
    using S = typename Bindings::scalar;
    const auto use = [](auto& values) DUET_INLINE_LAMBDA {
      value_and_gradient<S, Eigen::Matrix<S, n, 1>> result;
      result.value = S(values.template get<0>());
      S* gradient = result.gradient.data();
      values.template each<1, n>([&](const auto& x) DUET_INLINE_LAMBDA { *gradient++ = S(x); });
      return result;
    };
    return evaluated_program<build_derivatives<Node, 1, void, Motions...>>(b, use);
  }
};

/// Evaluates a formula, its gradient and the upper triangle of its Hessian.
template <class Motions>
struct hessian_of;
template <class... Motions>
struct hessian_of<motion_list<Motions...>> {
  using result = value_gradient_and_hessian<double, Eigen::VectorXd, Eigen::MatrixXd>;

  template <class Node, class Bindings>
  [[nodiscard]] DUET_ALWAYS_INLINE static auto of(const Bindings& b) {
    constexpr int n = int(sizeof...(Motions));
    using S = typename Bindings::scalar;
    using build = build_derivatives<Node, 2, void, Motions...>;
    return evaluated_program<build>(b, [](auto& values) DUET_INLINE_LAMBDA {
      value_gradient_and_hessian<S, Eigen::Matrix<S, n, 1>, Eigen::Matrix<S, n, n>> result;
      result.value = S(values.template get<0>());
      S* gradient = result.gradient.data();
      values.template each<1, n>([&](const auto& x) DUET_INLINE_LAMBDA { *gradient++ = S(x); });
      S* const hessian = result.hessian.data();
      int i = 0, j = 0;
      values.template each<1 + n, n*(n + 1) / 2>([&](const auto& x) DUET_INLINE_LAMBDA {
        hessian[n * i + j] = hessian[n * j + i] = S(x);
        if (++j == n) {
          j = ++i;
        }
      });
      return result;
    });
  }
};

template <class... Symbols>
inline constexpr bool has_rotations =
    ((Symbols::kind_of == kind::quaternion || Symbols::kind_of == kind::pose) || ...);

} // namespace detail

/// Value and gradient of f with respect to the variables, a function to be called by name:
/// `auto [y, g] = gradient(f, wrt(u, w))(u = 0.3, w = w0)`.
template <Formula F, class... Symbols>
  requires ScalarTerm<F>
[[nodiscard]] constexpr auto gradient(const F& f, variables<Symbols...>) {
  static_assert(!detail::has_rotations<Symbols...>,
                "duet: with rotations and poses say the frame: gradient(f, wrt(q), frame::body)");
  using gradient = detail::gradient_of<typename variables<Symbols...>::motions>;
  return detail::called_by_name<gradient, F>(f);
}

/// Value and gradient with rotations and poses of unit norm among the variables: three numbers for
/// a rotation, per rad about the axes of the frame, six for a pose, in the order [v; ω], as the
/// columns of `jacobian` in the same frame.
template <Formula F, class... Symbols, FrameConstant Frame>
  requires ScalarTerm<F>
[[nodiscard]] constexpr auto gradient(const F& f, variables<Symbols...>, Frame) {
  using gradient = detail::gradient_of<typename variables<Symbols...>::template motions_in<Frame>>;
  return detail::called_by_name<gradient, F>(f);
}

/// Value, gradient and Hessian of f with respect to scalars, vectors and matrices, a function to be
/// called by name.
template <Formula F, class... Symbols>
  requires ScalarTerm<F>
[[nodiscard]] constexpr auto hessian(const F& f, variables<Symbols...>) {
  static_assert(!detail::has_rotations<Symbols...>,
                "duet: a Hessian of a formula is with respect to scalars, vectors and matrices");
  using hessian = detail::hessian_of<typename variables<Symbols...>::motions>;
  return detail::called_by_name<hessian, F>(f);
}

template <Formula F, class... Symbols>
  requires(!ScalarTerm<F>)
DUET_REFUSED("a gradient is that of a scalar formula; others have a jacobian")
detail::called_by_name<detail::gradient_of<detail::motion_list<>>, F>
gradient(const F&, variables<Symbols...>);
template <Formula F, class... Symbols>
  requires(!ScalarTerm<F>)
DUET_REFUSED("a Hessian is that of a scalar formula")
detail::called_by_name<detail::hessian_of<detail::motion_list<>>, F> hessian(const F&,
                                                                             variables<Symbols...>);
template <Formula F, class... X>
  requires detail::NoVariables<X...>
      DUET_REFUSED("by which symbols? gradient(f, wrt(u, w)); it is called with values afterwards, "
                   "gradient(f, wrt(u, w))(u = 0.3, w = w0)")
detail::called_by_name<detail::gradient_of<detail::motion_list<>>, F> gradient(const F&,
                                                                               const X&...);
template <Formula F, class... X>
  requires detail::NoVariables<X...>
      DUET_REFUSED("by which symbols? hessian(f, wrt(u, w)); it is called with values afterwards, "
                   "hessian(f, wrt(u, w))(u = 0.3, w = w0)")
detail::called_by_name<detail::hessian_of<detail::motion_list<>>, F> hessian(const F&, const X&...);

} // namespace duet::expression
