// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/type_id.hpp>
#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/expression/arithmetic.hpp>
#include <duet/expression/elementary_functions.hpp>
#include <duet/expression/matrix/block.hpp>
#include <duet/expression/matrix/product.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/tape/builder.hpp>
#include <duet/expression/tape/recipe.hpp>
#include <duet/expression/tape/term.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/function.hpp>
#include <duet/expression/tree/latex_arithmetic.hpp>
#include <duet/expression/tree/latex_text.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/printed.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// Formulas as text and as LaTeX.

namespace duet::expression {

namespace detail {

/// A number, with ×10^n and ∞ in LaTeX.
[[nodiscard]] inline printed printed_number(notation style, std::string digits) {
  const std::size_t e = digits.find('e');
  const auto negative = precedence::negative_number;
  const bool is_negative = digits[0] == '-';
  if (style != notation::text && (digits == "inf" || digits == "-inf")) {
    return {is_negative ? "-\\infty" : "\\infty", is_negative ? negative : precedence::atom, style,
            factor_order::number};
  }
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

/// Subscript in LaTeX of the end of a name; parts behind a further _ are subscripts of it: that of
/// `_a_b` is _{a_{b}}.
[[nodiscard]] inline std::string latex_subscript(std::string_view name) {
  const std::size_t begin = name.find_first_not_of('_');
  if (begin == std::string_view::npos) {
    return "";
  }
  const std::size_t end = std::min(name.find('_', begin), name.size());
  return "_{" + std::string(name.substr(begin, end - begin)) + latex_subscript(name.substr(end)) +
         "}";
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
  const std::string subscript = end == std::string::npos ? "" : latex_subscript(name.substr(end));
  if (letters.empty()) { // a subscript alone would be that of what stands before
    letters = subscript.empty() ? "\\_" : "{}";
  }
  return letters + subscript;
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

/// Text of a symbol or constant that a formula holds.
template <kind K, char... Letters>
[[nodiscard]] printed printed_item(notation style, symbol_node<K, Letters...>, const auto&) {
  const std::string name = {Letters...};
  return {style != notation::text ? latex_name(name, K) : name, precedence::atom, style,
          order_of_kind(K)};
}
template <class Node, class T>
[[nodiscard]] printed printed_item(notation style, held_constant<Node, T>, const auto& h) {
  return printed_constant(style, value_in<Node>(h));
}
[[nodiscard]] inline printed printed_item(notation, library_sines, const auto&) { return {}; }

/// Name of a symbol, empty for a constant.
template <kind K, char... Letters>
[[nodiscard]] std::string name_of_item(symbol_node<K, Letters...>) {
  return {Letters...};
}
template <class Item>
[[nodiscard]] std::string name_of_item(Item) {
  return {};
}

/// Text of an operation that the algebra of the tape knows, whose first operand is of a kind.
[[nodiscard]] inline printed print_coded(notation style, const tape_entry& e, kind first,
                                         const printed* x) {
  const int p = e.parameter;
  const auto component = [&](int i) {
    return style != notation::text
               ? with_index(x[0], std::to_string(i + 1))
               : printed{x[0].inside(precedence::atom) + "[" + std::to_string(i) + "]"};
  };
  switch (e.code) {
  case tape_code::negative:
    return op::negative::print(style, x[0]);
  case tape_code::sum:
    return op::sum::print(style, x[0], x[1]);
  case tape_code::difference:
    return op::difference::print(style, x[0], x[1]);
  case tape_code::quotient:
    return op::quotient::print(style, x[0], x[1]);
  case tape_code::conj:
    return printed_operation<op::conj>(style, x[0]);
  case tape_code::transpose:
    return printed_operation<op::transpose>(style, x[0]);
  case tape_code::trace:
    return printed_operation<op::trace>(style, x[0]);
  case tape_code::trace_of_product:
    return printed_operation<op::trace>(style, op::product::print(style, x[0], x[1]));
  case tape_code::sine:
    return printed_operation<op::sin>(style, x[0]);
  case tape_code::cosine:
    return printed_operation<op::cos>(style, x[0]);
  case tape_code::power: {
    const std::string n = std::to_string(p);
    return style != notation::text
               ? latex_power(x[0], {n, precedence::atom, style, factor_order::number})
               : printed{x[0].inside(precedence::atom) + "^" + n, precedence::power};
  }
  case tape_code::component:
    return component(p);
  case tape_code::block:
    return print_block(style, x[0], p / 8, p % 8, e.kind_of);
  case tape_code::entries:
  case tape_code::embedded_block: {
    const bool is_whole = e.code == tape_code::entries;
    const int rows = is_whole ? rows_of(e.kind_of) : rows_of(first);
    const int columns = is_whole ? columns_of(e.kind_of) : columns_of(first);
    std::vector<std::string> all;
    for (int k = 0; k < rows_of(e.kind_of) * columns_of(e.kind_of); ++k) {
      const int i = k / columns_of(e.kind_of) - p / 8, j = k % columns_of(e.kind_of) - p % 8;
      const bool is_zero = i < 0 || j < 0 || i >= rows || j >= columns;
      all.push_back(is_zero                 ? "0"
                    : is_whole              ? x[k].text
                    : first == kind::scalar ? x[0].text
                    : columns == 1          ? component(i).text
                                            : print_block(style, x[0], i, j, kind::scalar).text);
    }
    return printed_matrix(style, std::size_t(columns_of(e.kind_of)), all);
  }
  default: // products
    return op::product::print(style, x[0], x[1]);
  }
}

/// A formula on a tape, to be printed.
class printed_formula {
public:
  /// Puts a node on a tape.
  template <class Node, class... Items>
  printed_formula(Node, const held<Items...>& h, notation style)
      : style_(style), items_{printed_item(style, Items{}, h)...}, names_{
                                                                       name_of_item(Items{})...} {
    bool is_full = true;
    for (int capacity = 1024; is_full; capacity *= 4) {
      const std::size_t size = std::size_t(capacity);
      memory_ = {{},
                 std::vector<tape_entry>(size),
                 std::vector<int>(4 * size),
                 std::vector<tape_memo>(size)};
      tape_builder tape(memory_, true);
      root_ = recipe<Node>::template add<tape_use<0, true>, held<Items...>>(tape);
      is_full = memory_.is_full;
    }
  }

  [[nodiscard]] printed text() { return text_of(root_); }

  /// Refuses symbols that look alike in LaTeX.
  ///
  /// \throws invalid_input if two symbols do, or one looks like the number pi
  void require_different_looks() {
    std::vector<std::pair<std::string, std::string>> seen; // looks and names
    const tape_builder tape(memory_);
    tape_numbers is_needed(tape.size());
    is_needed[root_] = 1;
    mark_operands(tape, is_needed, root_);
    for (int i = 0; i < tape.size(); ++i) {
      const tape_entry& e = tape[i];
      const bool is_symbol = e.code == tape_code::input && e.parameter >= 0;
      if (is_needed[i] == 0 || (!is_symbol && !is_pi(e))) {
        continue;
      }
      const std::string look = text_of(i).text;
      const std::string name = is_symbol ? names_[std::size_t(e.parameter)] : "the number pi";
      for (const auto& [other_look, other_name] : seen) {
        duet::detail::require(look != other_look, "duet: to_latex: ", other_name, " and ", name,
                              " both look like ", look, ": one of them needs another name");
      }
      seen.emplace_back(look, name);
    }
  }

private:
  [[nodiscard]] static bool is_pi(const tape_entry& e) {
    return e.code == tape_code::other &&
           duet::detail::is_same_type(e.operation->id, &duet::detail::type_id<pi_node>);
  }
  [[nodiscard]] printed text_of(int i) {
    const tape_builder tape(memory_);
    const tape_entry& e = tape[i];
    switch (e.code) {
    case tape_code::zero:
      return {"0", precedence::atom, style_, factor_order::number};
    case tape_code::number:
      return printed_number(style_, duet::to_text(e.number));
    case tape_code::input:
      return items_[std::size_t(e.parameter < 0 ? -1 - e.parameter : e.parameter)];
    case tape_code::unit_vector:
      return print_unit_vector(style_, e.parameter);
    default:
      break;
    }
    std::vector<printed> x;
    for (int k = 0; k < e.count; ++k) {
      x.push_back(text_of(tape.operand(i, k)));
    }
    if (is_pi(e)) {
      return e.operation->print(style_, nullptr);
    }
    printed result = e.code == tape_code::other
                         ? e.operation->print(style_, x.data())
                         : print_coded(style_, e, tape.kind_of(tape.operand(i, 0)), x.data());
    return style_ != notation::text ? latex_of_kind(std::move(result), e.kind_of == kind::scalar)
                                    : result;
  }

  notation style_;
  std::vector<printed> items_;
  std::vector<std::string> names_;
  tape_vectors memory_;
  int root_ = 0;
};

} // namespace detail

/// The formula as in a program: `2 * x * cos(x^2)`.
template <Formula F>
[[nodiscard]] std::string to_text(const F& f) {
  return detail::printed_formula(typename F::node_type{}, f.held(), notation::text).text().text;
}

namespace detail {

/// A node in LaTeX.
template <class Node>
[[nodiscard]] std::string latex_of_node(const auto& held, notation style) {
  printed_formula f(Node{}, held, style);
  f.require_different_looks();
  return latex_text(latex_terms(f.text()), fractions::lines).text;
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
