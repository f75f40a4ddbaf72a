// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/expression/tree/latex_text.hpp>

#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

/// \file
/// Texts of formulas while they are composed from those of their operands. For those who extend
/// duet.

namespace duet::expression {

/// Notation of a formula.
enum class notation {
  text,  ///< as in a program, with ^ for powers
  latex, ///< LaTeX for mathematics mode
  notes  ///< LaTeX as "Quaternion Differentiation and Interpolation", lecture notes, writes it
};

/// Text of a formula, with properties that enclosing formulas need. In LaTeX the text has slashes
/// for fractions, as inside of other formulas; `terms` allow for other forms.
struct printed {
  std::string text;                        ///< text of the formula
  precedence outermost = precedence::atom; ///< precedence of the operation outside all parentheses
  notation style = notation::text;         ///< notation of the text
  factor_order order = factor_order::function; ///< of a formula without terms, as a factor in LaTeX
  std::size_t name_end = 0; ///< length of f in f(x), where f^2(x) has its exponent; else 0
  std::vector<detail::latex_term> terms = {}; ///< in LaTeX, unless it is a single factor

  /// The text as an operand of an operator of that precedence, in parentheses if its own is lower.
  [[nodiscard]] std::string inside(precedence beside) const {
    return outermost < beside ? in_parentheses() : text;
  }
  /// The text in parentheses.
  [[nodiscard]] std::string in_parentheses() const {
    return style != notation::text ? "\\left(" + text + "\\right)" : "(" + text + ")";
  }
};

namespace detail {

/// Names of an operation in text and in LaTeX.
struct function_name {
  const char* text;
  /// A command, or a form with # for the arguments. A form that begins with # takes an argument in
  /// parentheses unless that is atomic. If empty, `text` is the name of an operator.
  const char* latex;
};

/// Call f(x, …) of an operation that has a name.
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

/// Text of an operation: a call if it has a `name`, otherwise by its `print`.
template <class Operation, class... P>
[[nodiscard]] printed printed_operation(notation style, const P&... operands) {
  if constexpr (requires { Operation::name; }) {
    return printed_call(style, Operation::name, {operands...});
  } else {
    return Operation::print(style, operands...);
  }
}

/// x with a subscript. An x that has one already is put in braces, as LaTeX forbids two in a row.
[[nodiscard]] inline printed with_index(const printed& x, const std::string& index) {
  const std::string base = x.inside(precedence::atom);
  const bool has_index = base.find('_') != std::string::npos;
  return {(has_index ? "{" + base + "}" : base) + "_{" + index + "}"};
}

/// Text of a matrix, whose entries are listed row by row.
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
