// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/rules/hyperbolic.hpp>
#include <duet/dual/rules/special.hpp>
#include <duet/expression/algebra/power.hpp>
#include <duet/expression/elementary_functions.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/function.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>

/// \file
/// Hyperbolic, error and gamma functions of scalar formulas.

namespace duet::expression {

namespace op {

struct sinh;
struct cosh;
struct tanh;
struct asinh;
struct acosh;
struct atanh;
struct erf;
struct erfc;
struct tgamma;
struct lgamma;
struct hypot;

struct sinh : detail::function<sinh, duet::rule::sinh> {
  static constexpr detail::function_name name = {"sinh", "\\sinh"};
  template <int, class X>
  static constexpr auto slope_by(X x) {
    return apply<cosh>(x);
  }
};
struct cosh : detail::function<cosh, duet::rule::cosh> {
  static constexpr detail::function_name name = {"cosh", "\\cosh"};
  template <int, class X>
  static constexpr auto slope_by(X x) {
    return apply<sinh>(x);
  }
};
struct tanh : detail::function<tanh, duet::rule::tanh> {
  static constexpr detail::function_name name = {"tanh", "\\tanh"};
  static constexpr bool slopes_take_value = true;
  template <int, class X>
  static constexpr auto written_slope(X x) {
    return whole<1> / apply<whole_power<2>>(apply<cosh>(x));
  }
};
struct asinh : detail::function<asinh, duet::rule::asinh> {
  static constexpr detail::function_name name = {"asinh", ""};
  template <int, class X>
  static constexpr auto written_slope(X x) {
    return whole<1> / apply<hypot>(whole<1>, x);
  }
};
struct acosh : detail::function<acosh, duet::rule::acosh> {
  static constexpr detail::function_name name = {"acosh", ""};
  template <int, class X>
  static constexpr auto written_slope(X x) {
    return whole<1> / (apply<sqrt>(x - whole<1>) * apply<sqrt>(x + whole<1>));
  }
};
struct atanh : detail::function<atanh, duet::rule::atanh> {
  static constexpr detail::function_name name = {"atanh", ""};
  template <int, class X>
  static constexpr auto written_slope(X x) {
    return whole<1> / (whole<1> - apply<whole_power<2>>(x));
  }
};
struct erf : detail::function<erf, duet::rule::erf> {
  static constexpr detail::function_name name = {"erf", ""};
  template <int, class X>
  static constexpr auto written_slope(X x) {
    return whole<2> / apply<sqrt>(pi_node{}) * apply<exp>(-apply<whole_power<2>>(x));
  }
};
struct erfc : detail::function<erfc, duet::rule::erfc> {
  static constexpr detail::function_name name = {"erfc", ""};
  template <int, class X>
  static constexpr auto slope_by(X x) {
    return -erf::slope_by<0>(x);
  }
};
struct tgamma : detail::function<tgamma, duet::rule::tgamma> {
  static constexpr detail::function_name name = {"tgamma", "\\Gamma"};
  template <int, class X>
  static constexpr auto slope_by(X x) {
    return apply<tgamma>(x) * apply<polygamma<0>>(x);
  }
};
struct lgamma : detail::function<lgamma, duet::rule::lgamma> {
  static constexpr detail::function_name name = {"lgamma", "\\log\\Gamma"};
  template <int, class X>
  static constexpr auto slope_by(X x) {
    return apply<polygamma<0>>(x);
  }
};

} // namespace op

template <ScalarTerm X>
[[nodiscard]] constexpr auto sinh(const X& x) {
  return apply<op::sinh>(x);
}
template <ScalarTerm X>
[[nodiscard]] constexpr auto cosh(const X& x) {
  return apply<op::cosh>(x);
}
template <ScalarTerm X>
[[nodiscard]] constexpr auto tanh(const X& x) {
  return apply<op::tanh>(x);
}
template <ScalarTerm X>
[[nodiscard]] constexpr auto asinh(const X& x) {
  return apply<op::asinh>(x);
}
template <ScalarTerm X>
[[nodiscard]] constexpr auto acosh(const X& x) {
  return apply<op::acosh>(x);
}
template <ScalarTerm X>
[[nodiscard]] constexpr auto atanh(const X& x) {
  return apply<op::atanh>(x);
}
template <ScalarTerm X>
[[nodiscard]] constexpr auto erf(const X& x) {
  return apply<op::erf>(x);
}
template <ScalarTerm X>
[[nodiscard]] constexpr auto erfc(const X& x) {
  return apply<op::erfc>(x);
}
template <ScalarTerm X>
[[nodiscard]] constexpr auto tgamma(const X& x) {
  return apply<op::tgamma>(x);
}
template <ScalarTerm X>
[[nodiscard]] constexpr auto lgamma(const X& x) {
  return apply<op::lgamma>(x);
}

} // namespace duet::expression
