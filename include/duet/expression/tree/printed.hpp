// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// \file
/// Formulas as text while they are put together.

namespace duet::expression {

/// How a formula is written.
enum class notation {
  text, ///< as in a program, with ^ for powers
  latex
};

/// How strongly a formula holds together.
enum class precedence { condition, sum, negative_number, product, power, atom };

/// The text of a formula, and what it is outside all parentheses.
struct printed {
  std::string text;
  precedence outermost = precedence::atom;
  notation style = notation::text;

  /// In parentheses if it would fall apart beside an operator of that precedence.
  [[nodiscard]] std::string inside(precedence beside) const {
    return outermost < beside ? in_parentheses() : text;
  }
  [[nodiscard]] std::string in_parentheses() const {
    return style == notation::latex ? "\\left(" + text + "\\right)" : "(" + text + ")";
  }
};

namespace detail {

/// With an index, in braces behind another one: LaTeX takes no two.
[[nodiscard]] inline printed with_index(const printed& x, const std::string& index) {
  const std::string base = x.inside(precedence::atom);
  const bool has_index = base.find('_') != std::string::npos;
  return {(has_index ? "{" + base + "}" : base) + "_{" + index + "}"};
}

/// The entries of a matrix, row by row.
[[nodiscard]] inline printed printed_matrix(notation style, std::size_t columns,
                                            const std::vector<std::string>& entries) {
  const bool is_latex = style == notation::latex;
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
