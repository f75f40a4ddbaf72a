// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/rules/elementary.hpp>
#include <duet/expression/arithmetic.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/function.hpp>
#include <duet/expression/tree/latex_arithmetic.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/tree/printed.hpp>

/// \file
/// Roots, exponentials, logarithms and circular functions of scalar formulas.

namespace duet::expression {

namespace op {

struct sqrt : detail::function<sqrt, duet::rule::sqrt> {
  static constexpr bool slopes_take_value = true;
  static constexpr auto symbolic_derivative(auto x) {
    return whole<1> / (whole<2> * apply<sqrt>(x));
  }
  static printed print(notation style, const printed& x) {
    return style != notation::text ? detail::latex_root(x) : printed{"sqrt(" + x.text + ")"};
  }
};
struct cbrt : detail::function<cbrt, duet::rule::cbrt> {
  static constexpr detail::function_name name = {"cbrt", ""};
  static constexpr bool slopes_take_value = true;
  static constexpr auto symbolic_derivative(auto x) {
    return whole<1> / (whole<3> * apply<whole_power<2>>(apply<cbrt>(x)));
  }
};
struct exp : detail::function<exp, duet::rule::exp> {
  static constexpr auto differential(auto x, auto dx) { return apply<exp>(x) * dx; }
  static printed print(notation style, const printed& x) {
    return style != notation::text ? detail::latex_exponential(x) : printed{"exp(" + x.text + ")"};
  }
};
struct log : detail::function<log, duet::rule::log> {
  static constexpr detail::function_name name = {"log", "\\log"};
  static constexpr auto symbolic_derivative(auto x) { return whole<1> / x; }
};
struct exp2 : detail::function<exp2, duet::rule::exp2> {
  static constexpr detail::function_name name = {"exp2", "2^{#}"};
  static constexpr bool slopes_take_value = true;
  static constexpr auto symbolic_derivative(auto x) {
    return apply<log>(whole<2>) * apply<exp2>(x);
  }
};
struct expm1 : detail::function<expm1, duet::rule::expm1> {
  static constexpr detail::function_name name = {"expm1", ""};
  static constexpr auto differential(auto x, auto dx) { return apply<exp>(x) * dx; }
};
struct log2 : detail::function<log2, duet::rule::log2> {
  static constexpr detail::function_name name = {"log2", "\\log_{2}"};
  static constexpr auto symbolic_derivative(auto x) {
    return whole<1> / (apply<log>(whole<2>) * x);
  }
};
struct log10 : detail::function<log10, duet::rule::log10> {
  static constexpr detail::function_name name = {"log10", "\\log_{10}"};
  static constexpr auto symbolic_derivative(auto x) {
    return whole<1> / (apply<log>(whole<10>) * x);
  }
};
struct log1p : detail::function<log1p, duet::rule::log1p> {
  static constexpr detail::function_name name = {"log1p", ""};
  static constexpr auto symbolic_derivative(auto x) { return whole<1> / (whole<1> + x); }
};
struct sin : detail::function<sin, duet::rule::sin> {
  static constexpr detail::function_name name = {"sin", "\\sin"};
};
struct cos : detail::function<cos, duet::rule::cos> {
  static constexpr detail::function_name name = {"cos", "\\cos"};
};
struct tan : detail::function<tan, duet::rule::tan> {
  static constexpr detail::function_name name = {"tan", "\\tan"};
  static constexpr bool slopes_take_value = true;
  static constexpr auto symbolic_derivative(auto x) {
    return whole<1> + apply<whole_power<2>>(apply<tan>(x));
  }
};
struct asin : detail::function<asin, duet::rule::asin> {
  static constexpr detail::function_name name = {"asin", "\\arcsin"};
  static constexpr auto symbolic_derivative(auto x) {
    return whole<1> / apply<sqrt>(whole<1> - apply<whole_power<2>>(x));
  }
};
struct acos : detail::function<acos, duet::rule::acos> {
  static constexpr detail::function_name name = {"acos", "\\arccos"};
  static constexpr auto differential(auto x, auto dx) {
    return -apply<slope_product>(asin::slope_by<0>(x), dx);
  }
};
struct atan : detail::function<atan, duet::rule::atan> {
  static constexpr detail::function_name name = {"atan", "\\arctan"};
  static constexpr auto symbolic_derivative(auto x) {
    return whole<1> / (whole<1> + apply<whole_power<2>>(x));
  }
};

} // namespace op

/// The function of `<cmath>` as a formula.
[[nodiscard]] constexpr auto sqrt(const ScalarTerm auto& x) { return apply<op::sqrt>(x); }
[[nodiscard]] constexpr auto cbrt(const ScalarTerm auto& x) { return apply<op::cbrt>(x); }
[[nodiscard]] constexpr auto exp(const ScalarTerm auto& x) { return apply<op::exp>(x); }
[[nodiscard]] constexpr auto exp2(const ScalarTerm auto& x) { return apply<op::exp2>(x); }
[[nodiscard]] constexpr auto expm1(const ScalarTerm auto& x) { return apply<op::expm1>(x); }
[[nodiscard]] constexpr auto log(const ScalarTerm auto& x) { return apply<op::log>(x); }
[[nodiscard]] constexpr auto log2(const ScalarTerm auto& x) { return apply<op::log2>(x); }
[[nodiscard]] constexpr auto log10(const ScalarTerm auto& x) { return apply<op::log10>(x); }
[[nodiscard]] constexpr auto log1p(const ScalarTerm auto& x) { return apply<op::log1p>(x); }
[[nodiscard]] constexpr auto sin(const ScalarTerm auto& x) { return apply<op::sin>(x); }
[[nodiscard]] constexpr auto cos(const ScalarTerm auto& x) { return apply<op::cos>(x); }
[[nodiscard]] constexpr auto tan(const ScalarTerm auto& x) { return apply<op::tan>(x); }
[[nodiscard]] constexpr auto asin(const ScalarTerm auto& x) { return apply<op::asin>(x); }
[[nodiscard]] constexpr auto acos(const ScalarTerm auto& x) { return apply<op::acos>(x); }
[[nodiscard]] constexpr auto atan(const ScalarTerm auto& x) { return apply<op::atan>(x); }

/// f with the sines and cosines of the C library, bit for bit. By default, those of several doubles
/// are computed together, four times as fast and also within one unit in the last place.
template <Formula F>
[[nodiscard]] constexpr auto with_std_sincos(const F& f) {
  return make_formula(typename F::node_type{}, merged(f.held(), held<detail::library_sines>{}));
}

} // namespace duet::expression
