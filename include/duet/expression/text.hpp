// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/function.hpp>
#include <duet/expression/tree/latex_arithmetic.hpp>
#include <duet/expression/tree/latex_text.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/printed.hpp>

#include <boost/mp11/algorithm.hpp>
#include <boost/mp11/list.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Formulas as text and as LaTeX.

namespace duet::expression::detail {

// Formulas as they are printed: derivatives of functions, which rules of dual numbers evaluate, are
// replaced by formulas of other functions.

template <class Node>
inline constexpr bool has_partial = false;
template <class Operation, class... X>
inline constexpr bool has_partial<applied_node<Operation, X...>> = (has_partial<X> || ...);
template <class Function, int... Orders, class... X>
inline constexpr bool has_partial<applied_node<op::partial<Function, Orders...>, X...>> = true;
template <class A, class B>
inline constexpr bool has_partial<applied_node<op::slope_product, A, B>> = true;

/// Symbol that stands for the K-th argument of a function while its derivatives are formed; numbers
/// stand for themselves.
template <int K, class X>
using stand_in = std::conditional_t<is_number<X>, X, symbol_node<kind::scalar, '\0', char(K)>>;

/// A node in which each stand-in is replaced by the argument from a list.
template <class Node, class Arguments>
struct substituted {
  using type = Node;
};
template <char K, class Arguments>
struct substituted<symbol_node<kind::scalar, '\0', K>, Arguments> {
  using type = boost::mp11::mp_at_c<Arguments, std::size_t(K)>;
};
template <class Operation, class... X, class Arguments>
struct substituted<applied_node<Operation, X...>, Arguments> {
  using type = decltype(apply<Operation>(typename substituted<X, Arguments>::type{}...));
};

/// A node as it is printed.
template <class Node, bool HasPartial = has_partial<Node>>
struct written {
  using type = Node;
};
template <class Node>
using written_t = typename written<Node>::type;
template <class Operation, class... X>
struct written<applied_node<Operation, X...>, true> {
  using type = decltype(apply<Operation>(written_t<X>{}...));
};

template <class A, class B>
struct written<applied_node<op::slope_product, A, B>, true> {
  using type = decltype(written_t<A>{} * written_t<B>{});
};

/// Derivative of a function as a formula of its arguments.
template <class Function, class Numbers, int... Orders>
struct written_partial;
template <class Function, int... K, int... Orders>
struct written_partial<Function, std::integer_sequence<int, K...>, Orders...> {
  static constexpr int argument = op::partial<Function, Orders...>::last_argument;

  template <class... X>
  static constexpr auto of(X... x) {
    if constexpr ((0 + ... + Orders) == 1 && sizeof...(X) == 1) {
      return Function::symbolic_derivative(x...);
    } else if constexpr ((0 + ... + Orders) == 1) {
      return Function::template symbolic_derivative<argument>(x...);
    } else {
      using lower = written_partial<Function, std::integer_sequence<int, K...>,
                                    (Orders - int(K == argument))...>;
      using symbols = boost::mp11::mp_list<stand_in<K, X>...>;
      using moving = movement_of_scalar<boost::mp11::mp_at_c<symbols, std::size_t(argument)>>;
      using slope = rate_t<decltype(lower::of(stand_in<K, X>{}...)), moving>;
      return typename substituted<written_t<slope>, boost::mp11::mp_list<X...>>::type{};
    }
  }
};
template <class Rule, int... K, int... Orders>
struct written_partial<op::given_function<Rule>, std::integer_sequence<int, K...>, Orders...> {
  template <class... X>
  static constexpr auto of(X... x) {
    return apply<op::written_derivative<Rule, Orders...>>(x...);
  }
};
template <class Function, int... Orders, class Value, class... X>
struct written<applied_node<op::partial<Function, Orders...>, Value, X...>, true> {
  static constexpr auto make() {
    using partial =
        written_partial<Function, std::make_integer_sequence<int, int(sizeof...(Orders))>,
                        Orders...>;
    return partial::of(written_t<X>{}...);
  }
  using type = decltype(make());
};

} // namespace duet::expression::detail

namespace duet::expression {

namespace detail {

/// A number, with ×10^n in LaTeX.
[[nodiscard]] inline printed printed_number(notation style, std::string digits) {
  const std::size_t e = digits.find('e');
  const auto negative = precedence::negative_number;
  const bool is_negative = digits[0] == '-';
  if (style != notation::text && e != std::string::npos) {
    const std::size_t exponent = digits.find_first_not_of("+0", e + 1);
    const std::string factor = digits.substr(0, e);
    digits = (factor == "1" ? "" : factor + " \\cdot ") + "10^{" +
             (digits[e + 1] == '-' ? "-" + digits.substr(digits.find_first_not_of("-0", e + 1))
                                   : digits.substr(exponent)) +
             "}";
    return {digits, is_negative ? negative : precedence::product, style, factor_order::number};
  }
  return {digits, is_negative ? negative : precedence::atom, style, factor_order::number};
}

/// A name in LaTeX: Greek letters by their names, digits and what follows _ as a subscript, columns
/// with an arrow.
[[nodiscard]] inline std::string latex_name(const std::string& name, kind k) {
  static constexpr std::array greek = {
      "alpha",   "beta",   "gamma", "delta", "epsilon", "zeta",  "eta",   "theta", "iota",
      "kappa",   "lambda", "mu",    "nu",    "xi",      "pi",    "rho",   "sigma", "tau",
      "upsilon", "phi",    "chi",   "psi",   "omega",   "Gamma", "Delta", "Theta", "Lambda",
      "Xi",      "Pi",     "Sigma", "Phi",   "Psi",     "Omega"};
  const std::size_t end = name.find_first_of("_0123456789");
  std::string letters = name.substr(0, end);
  for (const char* letter : greek) {
    if (letters == letter) {
      letters = "\\" + letters;
    }
  }
  if (letters.size() > 1 && letters[0] != '\\') {
    letters = "\\mathrm{" + letters + "}";
  }
  if (is_matrix(k) && columns_of(k) == 1) {
    letters = "\\vec{" + letters + "}";
  }
  if (end == std::string::npos || name.substr(end) == "_") {
    return letters;
  }
  return letters + "_{" + name.substr(name[end] == '_' ? end + 1 : end) + "}";
}

[[nodiscard]] constexpr factor_order order_of_kind(kind k) {
  return k == kind::scalar ? factor_order::symbol : factor_order::in_order;
}

/// A constant with all its digits: vectors as (x, y, z), quaternions as (w, x, y, z), dual numbers
/// as a[b], in LaTeX as a + b ε.
template <class T>
[[nodiscard]] printed printed_constant(notation style, const T& value) {
  const auto listed = [&](const auto&... x) {
    std::string text;
    ((text += (text.empty() ? "" : ", ") + printed_constant(style, x).text), ...);
    return text;
  };
  if constexpr (std::floating_point<T>) {
    return printed_number(style, duet::to_text(value));
  } else if constexpr (is_screw_dual<T>) {
    const std::string real = listed(value.value()), dual = listed(value.epsilon());
    if (style == notation::text) {
      return {real + "[" + dual + "]", precedence::atom, style, factor_order::symbol};
    }
    const bool is_negative = dual[0] == '-';
    return {real + (is_negative ? " - " : " + ") + dual.substr(is_negative) + " \\varepsilon",
            precedence::sum, style, factor_order::symbol};
  } else if constexpr (is_sized_matrix(constant_traits<T>::kind_of)) {
    std::vector<std::string> entries;
    for (Eigen::Index i = 0; i < value.rows(); ++i) {
      for (Eigen::Index j = 0; j < value.cols(); ++j) {
        entries.push_back(listed(value(i, j)));
      }
    }
    return printed_matrix(style, std::size_t(value.cols()), entries);
  } else if constexpr (Scalar<T>) {
    std::ostringstream digits;
    digits.precision(std::numeric_limits<T>::max_digits10);
    digits << value;
    return {digits.str(), precedence::atom, style, factor_order::symbol};
  } else {
    std::string text;
    if constexpr (is_quaternion<T>) {
      text = listed(value.w(), value.x(), value.y(), value.z());
    } else {
      text = listed(value[0], value[1], value[2]);
    }
    return {"(" + text + ")", precedence::atom, style, order_of_kind(constant_traits<T>::kind_of)};
  }
}

template <kind K, char... Letters>
[[nodiscard]] printed print(notation style, symbol_node<K, Letters...>, const auto&) {
  const std::string name = {Letters...};
  return {style != notation::text ? latex_name(name, K) : name, precedence::atom, style,
          order_of_kind(K)};
}
template <kind K, class Tag>
[[nodiscard]] printed print(notation style, constant_node<K, Tag>, const auto& h) {
  return printed_constant(style, value_in<constant_node<K, Tag>>(h));
}
template <std::uint64_t Bits>
[[nodiscard]] printed print(notation style, number_node<Bits> n, const auto&) {
  return printed_number(style, duet::to_text(n.value));
}
[[nodiscard]] inline printed print(notation style, pi_node, const auto&) {
  return {style != notation::text ? "\\pi" : "pi", precedence::atom, style, factor_order::pi};
}
template <kind K>
[[nodiscard]] printed print(notation style, zero_node<K>, const auto&) {
  return {"0", precedence::atom, style, factor_order::number};
}
template <class Operation, class... Operands>
[[nodiscard]] printed print(notation style, applied_node<Operation, Operands...>, const auto& h) {
  printed result = printed_operation<Operation>(style, print(style, Operands{}, h)...);
  constexpr kind k = applied_node<Operation, Operands...>::kind_of;
  return style != notation::text ? latex_of_kind(std::move(result), k == kind::scalar) : result;
}

/// Symbols of a formula, to find those that look alike in LaTeX.
class latex_symbols {
public:
  template <kind K, char... Letters>
  void visit(symbol_node<K, Letters...>) {
    const std::string name = {Letters...};
    add({latex_name(name, K), name, K});
  }
  void visit(pi_node) { add({"\\pi", "the number pi", kind::scalar}); }
  template <class Operation, class... Operands>
  void visit(applied_node<Operation, Operands...>) {
    (visit(Operands{}), ...);
  }
  void visit(const auto&) {}

private:
  struct look {
    std::string latex, name;
    kind of;
  };

  /// \throws invalid_input if another symbol looks like it
  void add(look now) {
    for (const look& other : seen_) {
      if (other.latex == now.latex) {
        duet::detail::require(other.name == now.name && other.of == now.of,
                              "duet: to_latex: ", other.name, " and ", now.name, " both look like ",
                              now.latex, ": one of them needs another name");
        return;
      }
    }
    seen_.push_back(std::move(now));
  }

  std::vector<look> seen_;
};

} // namespace detail

/// The formula as in a program: `2 * x * cos(x^2)`.
template <Formula F>
[[nodiscard]] std::string to_text(const F& f) {
  return detail::print(notation::text, detail::written_t<typename F::node_type>{}, f.held()).text;
}

namespace detail {

/// A node in LaTeX.
template <class Node>
[[nodiscard]] std::string latex_of_node(const auto& held, notation style) {
  const printed whole = print(style, written_t<Node>{}, held);
  return latex_text(latex_terms(whole), fractions::lines).text;
}

} // namespace detail

/// The formula in LaTeX, for mathematics mode: `2 x \cos\left(x^{2}\right)`. It equals
/// the formula wherever that has a value: equal factors are joined to powers and cancelled, equal
/// terms are collected, and no fraction is inside of another one, of an exponent or of an argument.
/// Names of Greek letters become these letters; digits, and what follows _, become a subscript.
///
/// \param style  `notation::notes` writes rotations and poses as the lecture notes do: cos ½θ + n
/// sin ½θ (N4), q + ½ε t q (N17)
/// \throws invalid_input for two symbols that would look alike, as theta1 and theta_1 do, and
/// a symbol pi in addition to the number
template <Formula F>
[[nodiscard]] std::string to_latex(const F& f, notation style = notation::latex) {
  detail::latex_symbols().visit(typename F::node_type{});
  return detail::latex_of_node<typename F::node_type>(f.held(), style);
}

template <class Made, class F>
DUET_REFUSED("gradients, Hessians, Jacobians and motions in LaTeX take the header "
             "duet/expression/graph/document.hpp")
std::string to_latex(const detail::called_by_name<Made, F>&, notation = notation::latex);
template <class Made, class F>
DUET_REFUSED(
    "gradients, Hessians, Jacobians and motions are functions to be called with values; "
    "formulas are derivative(f, u) and, along a vector, directional_derivative(f, along(w, "
    "v)); to_latex writes them all")
std::string to_text(const detail::called_by_name<Made, F>&);

} // namespace duet::expression
