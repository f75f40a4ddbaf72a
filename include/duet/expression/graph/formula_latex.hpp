// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/expression/arithmetic.hpp>
#include <duet/expression/condition.hpp>
#include <duet/expression/elementary_functions.hpp>
#include <duet/expression/functions_of_many.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/functions_of_one.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/graph/graph_text.hpp>
#include <duet/expression/special_functions.hpp>
#include <duet/expression/text.hpp>
#include <duet/expression/tree/latex_arithmetic.hpp>
#include <duet/expression/tree/latex_text.hpp>
#include <duet/expression/tree/printed.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

/// \file
/// Formulas that are data in LaTeX, as typed formulas are written.

namespace duet::expression {

namespace detail {

/// A variable, with the index of a component behind it.
[[nodiscard]] inline printed latex_variable(const std::string& name) {
  if (name[0] == '\\') { // LaTeX already
    return {name, precedence::power, notation::latex, factor_order::function};
  }
  const std::size_t bracket = name.find('[');
  const printed letters{latex_name(spelt_out(name.substr(0, bracket)), kind::scalar),
                        precedence::atom, notation::latex, factor_order::symbol};
  if (bracket == std::string::npos) {
    return letters;
  }
  printed x = with_index(letters, name.substr(bracket + 1, name.size() - bracket - 2));
  x.style = notation::latex;
  x.order = factor_order::symbol;
  return x;
}

/// An operation of a graph in LaTeX, as a typed formula writes it.
[[nodiscard]] inline printed latex_node(const graph& g, const graph_node& n,
                                        const std::array<printed, 3>& x) {
  using enum operation;
  const auto style = notation::latex;
  const auto infix = [&](const char* sign) -> printed {
    return {x[0].inside(precedence::sum) + sign + x[1].inside(precedence::sum),
            precedence::condition, style};
  };
  if (n.what == acos && g.is_number(n.operands[0], -1)) {
    return {"\\pi", precedence::atom, style, factor_order::pi};
  }
#define DUET_CASE(name)                                                                            \
  case operation::name:                                                                            \
    return printed_operation<op::name>(style, x[0]);
  switch (n.what) {
    DUET_EACH_FUNCTION(DUET_CASE)
#undef DUET_CASE
  case number:
    return printed_number(style, duet::to_text(n.number));
  case variable:
    return latex_variable(g.variable_name(n.index));
  case negative:
    return op::negative::print(style, x[0]);
  case sum:
    return op::sum::print(style, x[0], x[1]);
  case difference:
    return op::difference::print(style, x[0], x[1]);
  case product:
    return op::product::print(style, x[0], x[1]);
  case quotient:
    return op::quotient::print(style, x[0], x[1]);
  case power:
    return latex_power(x[0], printed_number(style, std::to_string(n.index)));
  case pow:
    return latex_power(x[0], x[1]);
  case hypot:
    return op::hypot::print(style, x[0], x[1]);
  case stumpff: {
    const std::string letter = "c_{" + std::to_string(n.index) + "}";
    return printed_call(style, {"", letter.c_str()}, {x[0]});
  }
  case floor:
    return printed_call(style, {"", "\\left\\lfloor #\\right\\rfloor"}, {x[0]});
  case ceil:
    return printed_call(style, {"", "\\left\\lceil #\\right\\rceil"}, {x[0]});
  case fma:
    return latex_sum_of(latex_product_of(x[0], x[1]), 1, x[2]);
  case less:
    return op::less<false>::print(style, x[0], x[1]);
  case less_equal:
    return op::less<true>::print(style, x[0], x[1]);
  case equal:
    return infix(" = ");
  case both:
    return infix(" \\land ");
  case either:
    return infix(" \\lor ");
  case no:
    return {"\\lnot " + x[0].inside(precedence::atom), precedence::product, style};
  case select:
    return op::select::print(style, x[0], x[1], x[2]);
  default:
    break;
  }
  const std::string name(function_name_of(n.what));
  const function_name written = {name.c_str(),
                                 n.what == arc_ratio ? "\\operatorname{arc\\_ratio}" : ""};
  return operand_count(n.what) == 1 ? printed_call(style, written, {x[0]})
                                    : printed_call(style, written, {x[0], x[1]});
}

/// Formulas of more operations are not written in LaTeX.
inline constexpr double max_latex_size = 2000;

/// The number of operations of a formula that is written out, each repeated where it is used.
[[nodiscard]] inline double written_size(const formula_graph& f) {
  const graph& g = f.operations();
  std::vector<double> sizes(std::size_t(g.size()), 1);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    for (const int operand : g[int(i)].operands) {
      sizes[i] += operand >= 0 ? sizes[std::size_t(operand)] : 0;
    }
  }
  double size = 0;
  for (const named_value& y : f.outputs()) {
    for (const int node : y.nodes) {
      size = std::max(size, sizes[std::size_t(node)]);
    }
  }
  return size;
}

/// The message with which `to_latex` refuses a formula; empty if it accepts it.
[[nodiscard]] inline std::string refusal_in_latex(const formula_graph& f) {
  if (f.outputs().size() != 1) {
    return "duet: to_latex takes a formula with one output";
  }
  if (written_size(f) > max_latex_size) {
    return duet::detail::message("duet: to_latex: the formula has more than ", max_latex_size,
                                 " operations");
  }
  const graph& g = f.operations();
  const std::vector<bool> needed = f.needed();
  std::map<std::string, std::string> names; // by their looks
  for (int i = 0; i < g.size(); ++i) {
    const bool is_variable = g[i].what == operation::variable;
    const bool is_pi = g[i].what == operation::acos && g.is_number(g[i].operands[0], -1);
    const std::string name = is_variable ? g.variable_name(g[i].index) : "the number pi";
    if (!needed[std::size_t(i)] || !(is_variable ? name[0] != '\\' : is_pi)) {
      continue;
    }
    const std::string text = is_pi ? "\\pi" : latex_variable(name).text;
    const auto [other, is_new] = names.emplace(text, name);
    if (!is_new) {
      return duet::detail::message("duet: to_latex: ", other->second, " and ", name,
                                   " both look like ", text, ": one of them needs another name");
    }
  }
  return "";
}

} // namespace detail

/// The only output of a formula for a paper, to stand in mathematics mode, as `to_latex` writes
/// typed formulas; vectors as columns, quaternions as (w, x, y, z).
/// \throws invalid_input for several outputs, if the formula has more than 2000 operations, and for
/// variables that look alike
[[nodiscard]] inline std::string to_latex(const formula_graph& f) {
  using detail::latex_terms;
  const graph& g = f.operations();
  const std::string refusal = detail::refusal_in_latex(f);
  duet::detail::require(refusal.empty(), refusal);
  const std::vector<bool> needed = f.needed();
  std::vector<printed> texts(needed.size());
  for (int i = 0; i < g.size(); ++i) {
    const std::size_t k = std::size_t(i);
    if (!needed[k]) {
      continue;
    }
    std::array<printed, 3> operands;
    for (std::size_t j = 0; j < 3; ++j) {
      if (g[i].operands[j] >= 0) {
        operands[j] = texts[std::size_t(g[i].operands[j])];
      }
    }
    texts[k] = detail::latex_of_kind(detail::latex_node(g, g[i], operands), true);
  }
  const named_value& y = f.outputs()[0];
  std::vector<std::string> numbers;
  std::string list;
  for (std::size_t k = 0; k < y.nodes.size(); ++k) { // row by row
    const std::size_t row = k / std::size_t(y.columns), column = k % std::size_t(y.columns);
    const int node = y.nodes[row + column * std::size_t(y.rows)];
    numbers.push_back(
        detail::latex_text(latex_terms(texts[std::size_t(node)]), detail::fractions::lines).text);
    list += (list.empty() ? "" : ", ") + numbers.back();
  }
  return y.kind == shape::scalar ? numbers[0]
         : y.kind == shape::matrix
             ? detail::printed_matrix(notation::latex, std::size_t(y.columns), numbers).text
             : "\\left(" + list + "\\right)";
}

namespace detail {

/// A number of a formula.
[[nodiscard]] inline std::string latex_of_number(formula_graph f, int node) {
  static_cast<void>(f.take_outputs());
  f.add_output({.name = "y", .nodes = {node}});
  return to_latex(f);
}

} // namespace detail

} // namespace duet::expression
