// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/number_text.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/tree/printed.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// Names of operations, and nodes of a graph as text.

namespace duet::expression::detail {

/// Name of a function; empty for an operator.
[[nodiscard]] constexpr std::string_view function_name_of(operation what) {
  constexpr std::array<std::string_view, std::size_t(operation::select) + 1> names = {
      "",       "",         "",      "",          "",          "",      "",        "",
      "sqrt",   "cbrt",     "exp",   "exp2",      "expm1",     "log",   "log2",    "log10",
      "log1p",  "sin",      "cos",   "tan",       "asin",      "acos",  "atan",    "sinh",
      "cosh",   "tanh",     "asinh", "acosh",     "atanh",     "erf",   "erfc",    "tgamma",
      "lgamma", "abs",      "floor", "ceil",      "trunc",     "round", "stumpff", "atan2",
      "hypot",  "pow",      "fmod",  "remainder", "arc_ratio", "fma",   "",        "",
      "",       "isfinite", "isnan", "signbit",   "",          "",      "",        "select"};
  return names[std::size_t(what)];
}

/// A name with Greek letters and indices spelt out: `theta1` of `θ₁`, `Gamma` of `Γ`.
[[nodiscard]] inline std::string spelt_out(const std::string& name) {
  static constexpr std::array<std::string_view, 25> letters = {
      "alpha", "beta",   "gamma",   "delta", "epsilon", "zeta",    "eta",  "theta", "iota",
      "kappa", "lambda", "mu",      "nu",    "xi",      "omicron", "pi",   "rho",   "varsigma",
      "sigma", "tau",    "upsilon", "phi",   "chi",     "psi",     "omega"};
  constexpr unsigned capital_alpha = 0x391, alpha = 0x3B1, index_0 = 0x2080;
  std::string result;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto byte = [&](std::size_t k) { // of UTF-8
      return i + k < name.size() ? static_cast<unsigned char>(name[i + k]) & 0x3FU : 0U;
    };
    const unsigned first = static_cast<unsigned char>(name[i]);
    const unsigned two = ((first & 0x1FU) << 6U) | byte(1);
    const unsigned three = ((first & 0xFU) << 12U) | (byte(1) << 6U) | byte(2);
    const unsigned letter = two >= alpha ? two - alpha : two - capital_alpha;
    if ((first >> 5U) == 6 && letter < letters.size()) {
      result += letters[letter];
      if (two < alpha) {
        char& capital = result[result.size() - letters[letter].size()];
        capital = char(capital - 'a' + 'A');
      }
      i += 1;
    } else if ((first >> 4U) == 14 && three >= index_0 && three < index_0 + 10) {
      result += char('0' + (three - index_0));
      i += 2;
    } else {
      result += name[i];
    }
  }
  return result;
}

/// A function called with the operands of a node.
[[nodiscard]] inline printed call_of(const std::string& function, const graph_node& n,
                                     const std::array<printed, 3>& x) {
  std::string text = function + "(" + x[0].text;
  for (int k = 1; k < operand_count(n.what); ++k) {
    text += ", " + x[std::size_t(k)].text;
  }
  return {text + ")"};
}

/// A condition with the signs that formulas share with C and MATLAB.
///
/// \param prefix  of functions
[[nodiscard]] inline printed infix_condition(const graph_node& n, const std::array<printed, 3>& x,
                                             const std::string& negation,
                                             const std::string& prefix) {
  const auto infix = [&](const char* sign, precedence inner) -> printed {
    return {x[0].inside(inner) + sign + x[1].inside(inner), precedence::condition};
  };
  switch (n.what) {
  case operation::less:
    return infix(" < ", precedence::sum);
  case operation::less_equal:
    return infix(" <= ", precedence::sum);
  case operation::equal:
    return infix(" == ", precedence::sum);
  case operation::both:
    return infix(" && ", precedence::atom);
  case operation::either:
    return infix(" || ", precedence::atom);
  case operation::no:
    return {negation + x[0].inside(precedence::atom)};
  default:
    return call_of(prefix + std::string(function_name_of(n.what)), n, x);
  }
}

/// The operation of a node applied to the texts of its operands.
[[nodiscard]] inline printed text_of(const graph& g, const graph_node& n,
                                     const std::array<printed, 3>& x) {
  using enum operation;
  const auto infix = [&](const char* sign, precedence own, precedence right) -> printed {
    return {x[0].inside(own) + sign + x[1].inside(right), own};
  };
  switch (n.what) {
  case number:
    return {duet::to_text(n.number), n.number < 0 ? precedence::negative_number : precedence::atom};
  case variable:
    return {g.variable_name(n.index)};
  case negative:
    return {"-" + x[0].inside(precedence::product), precedence::negative_number};
  case sum:
    return infix(" + ", precedence::sum, precedence::negative_number);
  case difference:
    return infix(" - ", precedence::sum, precedence::product);
  case product:
    return infix(" * ", precedence::product, precedence::power);
  case quotient:
    return infix(" / ", precedence::product, precedence::power);
  case power:
    return {x[0].inside(precedence::atom) + "^" + std::to_string(n.index), precedence::power};
  case stumpff:
    return {"stumpff" + std::to_string(n.index) + "(" + x[0].text + ")"};
  default:
    return is_condition(n.what) ? infix_condition(n, x, "!", "")
                                : call_of(std::string(function_name_of(n.what)), n, x);
  }
}

/// A node as text, in which what is nested deeper than `depth` is left out.
[[nodiscard]] inline printed node_text(const graph& g, int i, int depth) {
  std::array<printed, 3> operands;
  const graph_node& n = g[i];
  for (int k = 0; k < operand_count(n.what); ++k) {
    operands[std::size_t(k)] =
        depth == 0 ? printed{"..."} : node_text(g, n.operands[std::size_t(k)], depth - 1);
  }
  return text_of(g, n, operands);
}

/// For messages.
[[nodiscard]] inline std::string short_text(const graph& g, int i) {
  return node_text(g, i, 4).text;
}

} // namespace duet::expression::detail
