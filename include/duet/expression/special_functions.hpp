// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/dual/rules/elementary.hpp>
#include <duet/expression/arithmetic.hpp>
#include <duet/expression/elementary_functions.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/function.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>

/// \file
/// Hyperbolic, error and gamma functions of scalar formulas.

namespace duet::expression {

namespace op {

struct cosh;
struct hypot;

struct sinh : detail::function<sinh, duet::rule::sinh> {
  static constexpr detail::function_name name = {"sinh", "\\sinh"};
  static constexpr auto differential(auto x, auto dx) { return apply<cosh>(x) * dx; }
};
struct cosh : detail::function<cosh, duet::rule::cosh> {
  static constexpr detail::function_name name = {"cosh", "\\cosh"};
  static constexpr auto differential(auto x, auto dx) { return apply<sinh>(x) * dx; }
};
struct tanh : detail::function<tanh, duet::rule::tanh> {
  static constexpr detail::function_name name = {"tanh", "\\tanh"};
  static constexpr bool slopes_take_value = true;
  static constexpr auto symbolic_derivative(auto x) {
    return whole<1> / apply<whole_power<2>>(apply<cosh>(x));
  }
};
struct asinh : detail::function<asinh, duet::rule::asinh> {
  static constexpr detail::function_name name = {"asinh", ""};
  static constexpr auto symbolic_derivative(auto x) { return whole<1> / apply<hypot>(whole<1>, x); }
};
struct acosh : detail::function<acosh, duet::rule::acosh> {
  static constexpr detail::function_name name = {"acosh", ""};
  static constexpr auto symbolic_derivative(auto x) {
    return whole<1> / (apply<sqrt>(x - whole<1>) * apply<sqrt>(x + whole<1>));
  }
};
struct atanh : detail::function<atanh, duet::rule::atanh> {
  static constexpr detail::function_name name = {"atanh", ""};
  static constexpr auto symbolic_derivative(auto x) {
    return whole<1> / (whole<1> - apply<whole_power<2>>(x));
  }
};
struct erf : detail::function<erf, duet::rule::erf> {
  static constexpr detail::function_name name = {"erf", ""};
  static constexpr auto symbolic_derivative(auto x) {
    return whole<2> / apply<sqrt>(pi_node{}) * apply<exp>(-apply<whole_power<2>>(x));
  }
};
struct erfc : detail::function<erfc, duet::rule::erfc> {
  static constexpr detail::function_name name = {"erfc", ""};
  static constexpr auto differential(auto x, auto dx) { return -erf::slope_by<0>(x) * dx; }
};
struct tgamma : detail::function<tgamma, duet::rule::tgamma> {
  static constexpr detail::function_name name = {"tgamma", "\\Gamma"};
  static constexpr auto differential(auto x, auto dx) {
    return apply<tgamma>(x) * apply<polygamma<0>>(x) * dx;
  }
};
struct lgamma : detail::function<lgamma, duet::rule::lgamma> {
  static constexpr detail::function_name name = {"lgamma", "\\log\\Gamma"};
  static constexpr auto differential(auto x, auto dx) { return apply<polygamma<0>>(x) * dx; }
};

} // namespace op

/// The function of `<cmath>` as a formula.
[[nodiscard]] constexpr auto sinh(const ScalarTerm auto& x) { return apply<op::sinh>(x); }
[[nodiscard]] constexpr auto cosh(const ScalarTerm auto& x) { return apply<op::cosh>(x); }
[[nodiscard]] constexpr auto tanh(const ScalarTerm auto& x) { return apply<op::tanh>(x); }
[[nodiscard]] constexpr auto asinh(const ScalarTerm auto& x) { return apply<op::asinh>(x); }
[[nodiscard]] constexpr auto acosh(const ScalarTerm auto& x) { return apply<op::acosh>(x); }
[[nodiscard]] constexpr auto atanh(const ScalarTerm auto& x) { return apply<op::atanh>(x); }
[[nodiscard]] constexpr auto erf(const ScalarTerm auto& x) { return apply<op::erf>(x); }
[[nodiscard]] constexpr auto erfc(const ScalarTerm auto& x) { return apply<op::erfc>(x); }
[[nodiscard]] constexpr auto tgamma(const ScalarTerm auto& x) { return apply<op::tgamma>(x); }
[[nodiscard]] constexpr auto lgamma(const ScalarTerm auto& x) { return apply<op::lgamma>(x); }

} // namespace duet::expression
