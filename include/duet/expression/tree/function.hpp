// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/constants.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/rules/elementary.hpp>
#include <duet/expression/tree/bindings.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/tree/printed.hpp>

#include <cstddef>
#include <initializer_list>
#include <string>
#include <type_traits>
#include <utility>

/// \file
/// Common base of functions of scalars, and functions that only derivatives need.

namespace duet::expression {

namespace op {

/// Partial derivative of a function, of order `Orders` with respect to each argument, by the rule
/// of dual numbers. Its operands are the value of the function, or 0 if the rule does not use it,
/// and the arguments.
template <class Function, int... Orders>
struct partial {
  static constexpr kind kind_of(auto...) { return kind::scalar; }
  template <int I, class... X>
  static constexpr auto slope_by(X... x) {
    if constexpr (I == 0) {
      return whole<0>; // the slopes by arguments include the change of the value
    } else {
      return [&]<int... K>(std::integer_sequence<int, K...>) {
        return apply<partial<Function, (Orders + int(K == I - 1))...>>(x...);
      }
      (std::make_integer_sequence<int, int(sizeof...(Orders))>{});
    }
  }

  template <class Y, class... X>
  static auto value(const Y& y, const X&... x) {
    using R = detail::common_scalar_t<X...>;
    if constexpr ((0 + ... + Orders) == 1) {
      return R(Function::template slope_at<last_argument>(R(y), x...));
    } else {
      return [&]<int... K>(std::integer_sequence<int, K...>) {
        using D = dual<R, 1, derivative_tag<partial>>;
        const auto moved = [](auto is_moving, const auto& a) {
          if constexpr (is_moving) {
            return D::variable(R(a));
          } else {
            return a;
          }
        };
        const auto moving_value = [&] {
          if constexpr (Function::slopes_take_value) {
            return D(R(y), R(Function::template slope_at<last_argument>(R(y), x...)));
          } else {
            return R(y);
          }
        }();
        using lower = partial<Function, (Orders - int(K == last_argument))...>;
        return lower::value(moving_value, moved(std::bool_constant<K == last_argument>{}, x)...)
            .epsilon();
      }
      (std::make_integer_sequence<int, int(sizeof...(Orders))>{});
    }
  }

  /// Index of the last argument of differentiation.
  static constexpr int last_argument = [] {
    const int orders[] = {Orders...};
    int i = int(sizeof...(Orders)) - 1;
    while (orders[i] == 0) {
      --i;
    }
    return i;
  }();
};

} // namespace op

namespace detail {

/// Partial derivative with respect to the I-th argument.
template <class Function, int I, int... K, class... X>
[[nodiscard]] constexpr auto partial_by(std::integer_sequence<int, K...>, X... x) {
  using operation = op::partial<Function, int(K == I)...>;
  if constexpr (Function::slopes_take_value) {
    return apply<operation>(apply<Function>(x...), x...);
  } else {
    return apply<operation>(whole<0>, x...);
  }
}

/// Base of functions of scalars; `Rule`, the rule of dual numbers, computes values and slopes. A
/// derived class has a `name` and either `differential` or the derivative as it is printed,
/// `symbolic_derivative(x)`, or `symbolic_derivative<I>(x…)` with respect to the I-th argument.
template <class Function, class Rule>
struct function {
  /// True if the slopes of the rule use the value.
  static constexpr bool slopes_take_value = false;

  static constexpr kind kind_of(auto...) { return kind::scalar; }
  template <class... X>
  static common_scalar_t<X...> value(const X&... x) {
    return Rule{}.value(common_scalar_t<X...>(x)...);
  }
  /// Derivative with respect to the I-th argument; y is the value.
  template <int I, class Y, class... X>
  static Y slope_at(const Y& y, const X&... x) {
    if constexpr (sizeof...(X) == 1) {
      return Rule{}.slope(Y(x)..., y);
    } else {
      return Rule{}.slopes(y, Y(x)...)[I];
    }
  }
  template <int I, class... X>
  static constexpr auto slope_by(X... x) {
    if constexpr (!(X::use::is_printed || ...)) {
      return partial_by<Function, I>(std::make_integer_sequence<int, int(sizeof...(X))>{}, x...);
    } else if constexpr (requires { Function::template symbolic_derivative<I>(x...); }) {
      return Function::template symbolic_derivative<I>(x...);
    } else {
      return Function::symbolic_derivative(x...);
    }
  }
};

/// A user's function with a mark of its derivatives, by its member `name` if it has one.
template <class Rule>
[[nodiscard]] printed printed_given(notation style, const std::string& mark,
                                    const std::string& latex_mark,
                                    std::initializer_list<printed> x) {
  std::string name = "f";
  if constexpr (requires { decltype(Rule::f)::name; }) {
    name = decltype(Rule::f)::name;
  }
  const std::string text = name + mark;
  const std::string latex = (name.size() == 1 ? name : "\\operatorname{" + name + "}") + latex_mark;
  return printed_call(style, {text.c_str(), latex.c_str()}, x);
}

} // namespace detail

/// π in the precision of the arguments.
struct pi_node {
  static constexpr kind kind_of = kind::scalar;
  /// Its name, or its letter in LaTeX.
  static printed print(notation style) {
    return {style != notation::text ? "\\pi" : "pi", precedence::atom, style, factor_order::pi};
  }
};

namespace detail {

template <class Bindings>
struct leaf<pi_node, Bindings> {
  static constexpr auto value(const Bindings&) { return constant::pi<typename Bindings::real>(); }
};

} // namespace detail

/// π as a formula.
inline constexpr formula<pi_node, held<>> pi{};

namespace op {

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
  static constexpr auto differential(auto x, auto dx) { return apply<polygamma<N + 1>>(x) * dx; }
  static printed print(notation style, const printed& x) {
    const std::string n = std::to_string(N);
    return {style != notation::text
                ? "\\psi^{(" + n + ")}" + printed{x.text, {}, style}.in_parentheses()
                : "polygamma(" + n + ", " + x.text + ")"};
  }
};

/// A derivative of a user's function as it is written, of order `Orders` by each argument.
template <class Rule, int... Orders>
struct written_derivative {
  static constexpr kind kind_of(auto...) { return kind::scalar; }
  template <int I>
  static constexpr auto slope_by(auto... x) {
    return [&]<int... K>(std::integer_sequence<int, K...>) {
      return apply<written_derivative<Rule, (Orders + int(K == I))...>>(x...);
    }
    (std::make_integer_sequence<int, int(sizeof...(Orders))>{});
  }
  static printed print(notation style, const auto&... x) {
    std::string orders;
    ((orders += (orders.empty() ? "" : ",") + std::to_string(Orders)), ...);
    constexpr int order = (0 + ... + Orders);
    if (sizeof...(Orders) == 1 && order <= 3) {
      const std::string primes(std::size_t(order), '\'');
      return detail::printed_given<Rule>(style, primes, primes, {x...});
    }
    return detail::printed_given<Rule>(style, "^(" + orders + ")", "^{(" + orders + ")}", {x...});
  }
};

/// A user's function with given derivatives.
template <class Rule>
struct given_function : detail::function<given_function<Rule>, Rule> {
  template <int I>
  static constexpr auto symbolic_derivative(auto... x) {
    return [&]<int... K>(std::integer_sequence<int, K...>) {
      return apply<written_derivative<Rule, int(K == I)...>>(x...);
    }
    (std::make_integer_sequence<int, int(sizeof...(x))>{});
  }
  static printed print(notation style, const auto&... x) {
    return detail::printed_given<Rule>(style, "", "", {x...});
  }
};

} // namespace op

namespace detail {

/// The rule of `with_derivative` applied to formulas of scalars.
template <class Rule, ScalarTerm... X>
[[nodiscard]] constexpr auto formula_of_rule(const Rule&, const X&... x) {
  return apply<op::given_function<Rule>>(x...);
}

} // namespace detail

using detail::formula_of_rule; // found by arguments

} // namespace duet::expression
