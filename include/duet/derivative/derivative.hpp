// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/structure.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual/math.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <tuple>
#include <utility>

/// \file
/// Derivatives of functions of one scalar.

namespace duet {

/// Result of `derivative`: y = f(x), and dy/dx of the same shape.
template <class Y, class DY>
struct value_and_derivative {
  Y value = detail::zero_initialized<Y>();        ///< f(x)
  DY derivative = detail::zero_initialized<DY>(); ///< dy/dx, of the shape of f(x)

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("value", value);
    f("derivative", derivative);
  }
  /// For those who extend duet: rejects `double slope = derivative(f, x)`.
  template <class M>
    requires(Arithmetic<M> || std::derived_from<M, Eigen::MatrixBase<M>>)
  DUET_REFUSED("derivative returns value and derivative: const auto [y, dy] = derivative(f, x); or "
               "derivative(f, x).derivative")
  operator M() const;
};
template <class Y, class DY>
value_and_derivative(Y, DY) -> value_and_derivative<Y, DY>;

/// f(x) and f′(x) of a function of one scalar.
///
/// The result may be a scalar, an Eigen matrix, an array, a tuple, a quaternion or a dual
/// quaternion; the derivative has the same shape. Calls may nest: each marks its ε with the type of
/// its function, or with `Tag` if the caller gives one.
///
/// \return `value_and_derivative`
///
/// Example: `auto [y, dy] = derivative([](auto x) { return sin(x); }, 0.3);`
template <class Tag = void, detail::FunctionOfAny F, class X>
  requires(Scalar<X> || Arithmetic<X>)
[[nodiscard]] auto derivative(F&& f, const X& x) {
  using T = detail::differentiable_t<X>;
  using tag = detail::tag_for<Tag, F>;
  static_assert(
      requires(dual<T, 1, tag> variable) { std::forward<F>(f)(variable); },
      "duet: derivative: the function must take any scalar: [](const auto& x) { ... }");
  const auto y = detail::result_of_call(std::forward<F>(f)(dual<T, 1, tag>::variable(T(x))));
  return value_and_derivative{detail::parts<tag>(y, 0), detail::parts<tag>(y, 1)};
}

/// f(x), f′(x), …, f^(K)(x) in one pass over Taylor numbers; element k is the k-th derivative.
///
/// \return a `std::array` of K + 1 values, each of the shape of f(x)
template <int K, class Tag = void, detail::FunctionOfAny F, class X>
  requires(Scalar<X> || Arithmetic<X>)
[[nodiscard]] auto derivatives(F&& f, const X& x) {
  using T = detail::differentiable_t<X>;
  using tag = detail::tag_for<Tag, F>;
  static_assert(
      requires(taylor<T, K, tag> variable) { std::forward<F>(f)(variable); },
      "duet: derivatives: the function must take any scalar: [](const auto& x) { ... }");
  const auto y = detail::result_of_call(std::forward<F>(f)(taylor<T, K, tag>::variable(T(x))));
  return [&]<int... I>(std::integer_sequence<int, I...>) {
    return std::array{detail::parts<tag>(y, I)...};
  }
  (std::make_integer_sequence<int, K + 1>{});
}

template <class Tag = void, detail::FunctionOfReals F, class... X>
DUET_REFUSED_FUNCTION(derivative)
value_and_derivative<double, double> derivative(F&&, X&&...);
template <int K, class Tag = void, detail::FunctionOfReals F, class... X>
DUET_REFUSED_FUNCTION(derivatives)
std::array<double, std::size_t(K) + 1> derivatives(F&&, X&&...);

template <class Tag = void, detail::FunctionOfAny F, class X>
  requires(!Scalar<X> && !Arithmetic<X>)
DUET_REFUSED(
    "derivative differentiates with respect to one number; with respect to vectors, rotations "
    "and poses use gradient(f, x) or jacobian(f, x)")
value_and_derivative<double, double> derivative(F&&, const X&);
template <class Tag = void, detail::FunctionOfAny F, class A, class B, class... More>
DUET_REFUSED("derivative differentiates with respect to one number; for several arguments use "
             "gradient(f, std::tuple(a, b)) or jacobian(f, std::tuple(a, b))")
value_and_derivative<double, double> derivative(F&&, const A&, const B&, const More&...);

} // namespace duet
