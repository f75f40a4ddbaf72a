// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/math.hpp>
#include <duet/dual/rules/of_many.hpp>
#include <duet/expression/arithmetic.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/function.hpp>
#include <duet/expression/tree/latex_arithmetic.hpp>
#include <duet/expression/tree/latex_text.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/tree/printed.hpp>

#include <type_traits>
#include <utility>

/// \file
/// Functions of two or more scalars.

namespace duet::expression {

namespace op {

struct atan2 : detail::function<atan2, duet::rule::atan2> {
  static constexpr detail::function_name name = {"atan2", ""};
  template <int I>
  static constexpr auto symbolic_derivative(auto y, auto x) {
    const auto square = apply<whole_power<2>>(x) + apply<whole_power<2>>(y);
    if constexpr (I == 0) {
      return x / square;
    } else {
      return -(y / square);
    }
  }
};

/// √(x² + y² + …)
struct hypot : detail::function<hypot, duet::rule::hypot> {
  static printed print(notation style, const auto&... x) {
    if (style == notation::text) {
      return detail::printed_call(style, {"hypot", ""}, {x...});
    }
    const printed two = {"2", precedence::atom, style, factor_order::number};
    printed squares = {"0", precedence::atom, style, factor_order::number};
    ((squares = sum::print(style, squares, detail::latex_power(x, two))), ...);
    return detail::latex_root(squares);
  }
  template <int I, class... X>
  static constexpr auto symbolic_derivative(X... x) {
    const std::common_type_t<X...> all[] = {x...};
    return all[I] / apply<hypot>(x...);
  }
};

/// x y + z, rounded once.
struct fma : detail::function<fma, duet::rule::fma> {
  static constexpr detail::function_name name = {"fma", ""};
  static constexpr auto differential(auto x, auto y, auto, auto dx, auto dy, auto dz) {
    return dx * y + x * dy + dz;
  }
};

/// a + t (b − a)
struct lerp : detail::function<lerp, duet::rule::lerp> {
  static constexpr detail::function_name name = {"lerp", ""};
  static constexpr auto differential(auto a, auto b, auto t, auto da, auto db, auto dt) {
    return (whole<1> - t) * da + t * db + (b - a) * dt;
  }
};

} // namespace op

/// The angle of the point (x, y), in (−π, π].
template <class Y, Operands<Y> X, class Tag = decltype([](op::hypot*) {})>
[[nodiscard]] constexpr auto atan2(const Y& y, const X& x) {
  return apply<op::atan2>(detail::term<Tag>(y), detail::term<Tag>(x));
}
/// √(x² + y²)
template <class X, Operands<X> Y, class Tag = decltype([](op::hypot*) {})>
[[nodiscard]] constexpr auto hypot(const X& x, const Y& y) {
  return apply<op::hypot>(detail::term<Tag>(x), detail::term<Tag>(y));
}
/// √(x² + y² + z²)
template <class X, class Y, class Z, class Tag = decltype([](op::hypot*) {})>
  requires(Operands<X, Y>&& Term<Z>)
[[nodiscard]] constexpr auto hypot(const X& x, const Y& y, const Z& z) {
  return apply<op::hypot>(detail::term<Tag>(x), detail::term<Tag>(y), z);
}
/// x y + z, the value rounded once.
[[nodiscard]] constexpr auto fma(const Term auto& x, const Term auto& y, const Term auto& z) {
  return apply<op::fma>(x, y, z);
}
/// a + t (b − a) of scalars, exact at t = 0 and t = 1.
template <class A, class B, Term T, class Tag = decltype([](op::hypot*) {})>
  requires Operands<A, B, T>
[[nodiscard]] constexpr auto lerp(const A& a, const B& b, const T& t) {
  return detail::apply_to<op::lerp, Tag>(std::index_sequence_for<A, B, T>{}, a, b, t);
}

} // namespace duet::expression
