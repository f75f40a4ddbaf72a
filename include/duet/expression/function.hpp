// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/constants.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/rules.hpp>
#include <duet/dual/rules_special.hpp>
#include <duet/expression/formula.hpp>
#include <duet/expression/frame.hpp>
#include <duet/expression/node.hpp>
#include <duet/expression/number.hpp>
#include <duet/expression/printed.hpp>

#include <string>

/// \file
/// What all functions of one scalar have in common, and those that only derivatives need.

namespace duet::expression {

namespace detail {

struct function_name {
  const char* text;
  const char* latex; ///< a command, or empty
};

[[nodiscard]] inline printed printed_call(notation style, const function_name& name,
                                          const std::string& arguments) {
  if (style == notation::text) {
    return {std::string(name.text) + "(" + arguments + ")"};
  }
  const std::string command = name.latex;
  if (command == "\\sqrt") {
    return {"\\sqrt{" + arguments + "}"};
  }
  if (command == "\\exp") {
    return {"e^{" + arguments + "}", precedence::power};
  }
  const bool is_high = arguments.find_first_of("^{") != std::string::npos;
  return {(command.empty() ? "\\operatorname{" + std::string(name.text) + "}" : command) +
          (is_high ? "\\left(" : "(") + arguments + (is_high ? "\\right)" : ")")};
}

/// A function with a rule of the dual numbers, which has the values; what derives from this has
/// `name`, and `slope(x)`, the derivative as a node.
template <class Function, class Rule>
struct function {
  static constexpr kind kind_of(kind a) { return a; }
  template <class X>
  DUET_ALWAYS_INLINE static X value(const X& x) {
    return Rule{}.value(x);
  }
  static printed print(notation style, const printed& x) {
    return printed_call(style, Function::name, x.text);
  }
};

} // namespace detail

/// π in the precision of the arguments.
struct pi_node {
  static constexpr kind kind_of = kind::scalar;
};

namespace detail {

template <class Given>
struct leaf<pi_node, Given> {
  static constexpr auto value(const Given&) { return constant::pi<typename Given::real>(); }
};

} // namespace detail

/// π as a formula.
inline constexpr formula<pi_node, held<>> pi{};

namespace op {

/// 1 − x², accurate near ±1.
struct one_minus_square {
  static constexpr kind kind_of(kind a) { return a; }
  template <class X>
  static X value(const X& x) {
    return duet::detail::one_minus_square(x);
  }
  template <class X>
  static constexpr auto slope(X x) {
    return whole<-2> * x;
  }
  static printed print(notation style, const printed& x) {
    return {"1 - " + x.inside(precedence::atom) + (style == notation::latex ? "^{2}" : "^2"),
            precedence::sum};
  }
};

/// The N-th derivative of ψ, the logarithmic derivative of Γ.
template <int N>
struct polygamma {
  static constexpr kind kind_of(kind a) { return a; }
  template <class X>
  static X value(const X& x) {
    if constexpr (N == 0) {
      return duet::detail::digamma(x);
    } else {
      using D = dual<X, 1, derivative_tag<polygamma>>;
      return polygamma<N - 1>::value(D::variable(x)).epsilon();
    }
  }
  template <class X>
  static constexpr auto slope(X x) {
    return apply<polygamma<N + 1>>(x);
  }
  static printed print(notation style, const printed& x) {
    const std::string n = std::to_string(N);
    const std::string text = "polygamma(" + n + ", " + x.text + ")";
    return {style == notation::latex
                ? "\\psi^{(" + n + ")}" + printed{x.text, {}, style}.in_parentheses()
                : text};
  }
};

} // namespace op
} // namespace duet::expression
