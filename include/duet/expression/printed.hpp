// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <string>

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

} // namespace duet::expression
