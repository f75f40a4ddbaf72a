// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/expression/tree/latex_text.hpp>

#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

/// \file
/// Formulas as text while they are put together. For those who extend duet.

namespace duet::expression {

/// How a formula is written.
enum class notation {
  text,  ///< as in a program, with ^ for powers
  latex, ///< LaTeX for mathematics mode
  notes  ///< LaTeX as "Quaternion Differentiation and Interpolation", lecture notes, writes it
};

/// The text of a formula, and what it is outside all parentheses. In LaTeX the text is that inside
/// of other formulas, with slashes for fractions; the terms tell how else it may be written.
struct printed {
  std::string text;                            ///< what stands there
  precedence outermost = precedence::atom;     ///< of the operation outside all parentheses
  notation style = notation::text;             ///< how it is written
  factor_order order = factor_order::function; ///< in LaTeX, of what has no terms
  std::size_t name_end = 0;                    ///< of f(x), where f^2(x) has its exponent; else 0
  std::vector<detail::latex_term> terms = {};  ///< in LaTeX, of what is no single factor

  /// In parentheses if it would fall apart beside an operator of that precedence.
  [[nodiscard]] std::string inside(precedence beside) const {
    return outermost < beside ? in_parentheses() : text;
  }
  /// In parentheses.
  [[nodiscard]] std::string in_parentheses() const {
    return style != notation::text ? "\\left(" + text + "\\right)" : "(" + text + ")";
  }
};

namespace detail {

/// How an operation with a name is written.
struct function_name {
  const char* text;
  /// A command, or what is written with the argument for #, in parentheses if # comes first and it
  /// would fall apart; if empty, the name.
  const char* latex;
};

/// The operation of that name and its operands.
[[nodiscard]] inline printed printed_call(notation style, const function_name& name,
                                          std::initializer_list<printed> operands) {
  std::string arguments;
  for (const printed& x : operands) {
    arguments += (arguments.empty() ? "" : ", ") + x.text;
  }
  if (style == notation::text) {
    return {std::string(name.text) + "(" + arguments + ")"};
  }
  std::string form = name.latex;
  if (const std::size_t at = form.find('#'); at != std::string::npos) {
    const bool is_power = form.find('^') != std::string::npos;
    form.replace(at, 1, at == 0 ? operands.begin()->inside(precedence::atom) : arguments);
    return {form, is_power ? precedence::power : precedence::atom};
  }
  const bool is_high = arguments.find_first_of("^{") != std::string::npos ||
                       arguments.find("\\left") != std::string::npos;
  if (form.empty()) {
    form = "\\operatorname{" + std::string(name.text) + "}";
  }
  const bool is_one_name = form.find('\\', 1) == std::string::npos; // unlike \log\Gamma
  return {form + (is_high ? "\\left(" : "(") + arguments + (is_high ? "\\right)" : ")"),
          is_one_name ? precedence::atom : precedence::power, style, factor_order::function,
          is_one_name ? form.size() : 0};
}

/// An operation as it prints itself, or by its name.
template <class Operation, class... P>
[[nodiscard]] printed printed_operation(notation style, const P&... operands) {
  if constexpr (requires { Operation::name; }) {
    return printed_call(style, Operation::name, {operands...});
  } else {
    return Operation::print(style, operands...);
  }
}

/// With an index, in braces behind another one: LaTeX takes no two.
[[nodiscard]] inline printed with_index(const printed& x, const std::string& index) {
  const std::string base = x.inside(precedence::atom);
  const bool has_index = base.find('_') != std::string::npos;
  return {(has_index ? "{" + base + "}" : base) + "_{" + index + "}"};
}

/// The entries of a matrix, row by row.
[[nodiscard]] inline printed printed_matrix(notation style, std::size_t columns,
                                            const std::vector<std::string>& entries) {
  const bool is_latex = style != notation::text;
  std::string text = is_latex ? "\\begin{bmatrix}" : "[";
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const bool is_first_of_row = k % columns == 0;
    const std::string separator =
        is_first_of_row ? (is_latex ? "\\\\" : "; ") : (is_latex ? " & " : ", ");
    text += (k == 0 ? "" : separator) + entries[k];
  }
  return {text + (is_latex ? "\\end{bmatrix}" : "]")};
}

} // namespace detail

} // namespace duet::expression
