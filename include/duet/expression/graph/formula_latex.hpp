// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/graph/graph_text.hpp>
#include <duet/expression/text.hpp>
#include <duet/expression/tree/latex_arithmetic.hpp>
#include <duet/expression/tree/latex_text.hpp>
#include <duet/expression/tree/printed.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// Formulas that are data in LaTeX, as typed formulas are written.

namespace duet::expression {

namespace detail {

/// The command of a function in LaTeX, or its form with # for the argument; empty for its name.
[[nodiscard]] inline const char* latex_command(operation what) {
  using enum operation;
  static constexpr std::pair<operation, const char*> commands[] = {
      {log, "\\log"},
      {log2, "\\log_{2}"},
      {log10, "\\log_{10}"},
      {exp2, "2^{#}"},
      {sin, "\\sin"},
      {cos, "\\cos"},
      {tan, "\\tan"},
      {asin, "\\arcsin"},
      {acos, "\\arccos"},
      {atan, "\\arctan"},
      {sinh, "\\sinh"},
      {cosh, "\\cosh"},
      {tanh, "\\tanh"},
      {tgamma, "\\Gamma"},
      {lgamma, "\\log\\Gamma"},
      {abs, "\\left|#\\right|"},
      {floor, "\\left\\lfloor #\\right\\rfloor"},
      {ceil, "\\left\\lceil #\\right\\rceil"}};
  const auto* const found = std::find_if(std::begin(commands), std::end(commands),
                                         [&](const auto& each) { return each.first == what; });
  return found == std::end(commands) ? "" : found->second;
}

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

/// An operation of a graph in LaTeX.
[[nodiscard]] inline printed latex_node(const graph& g, const graph_node& n,
                                        const std::array<printed, 3>& x) {
  using enum operation;
  const auto style = notation::latex;
  const auto infix = [&](const char* sign, precedence beside) -> printed {
    return {x[0].inside(beside) + sign + x[1].inside(beside), precedence::condition, style};
  };
  switch (n.what) {
  case number:
    return printed_number(style, duet::to_text(n.number));
  case variable:
    return latex_variable(g.variable_name(n.index));
  case negative:
    return latex_product_of({"-1", precedence::negative_number, style, factor_order::number}, x[0]);
  case sum:
    return latex_sum_of(x[0], 1, x[1]);
  case difference:
    return latex_sum_of(x[0], -1, x[1]);
  case product:
    return latex_product_of(x[0], x[1]);
  case quotient:
    return latex_product_of(x[0], x[1], -1);
  case power:
    return latex_power(x[0], printed_number(style, std::to_string(n.index)));
  case pow:
    return latex_power(x[0], x[1]);
  case sqrt:
    return latex_root(x[0]);
  case exp:
    return latex_exponential(x[0]);
  case acos:
    if (g.is_number(n.operands[0], -1)) {
      return {"\\pi", precedence::atom, style, factor_order::pi};
    }
    break;
  case hypot: {
    const printed two = printed_number(style, "2");
    return latex_root(latex_sum_of(latex_power(x[0], two), 1, latex_power(x[1], two)));
  }
  case stumpff: {
    const std::string letter = "c_{" + std::to_string(n.index) + "}";
    return printed_call(style, {"", letter.c_str()}, {x[0]});
  }
  case fma:
    return latex_sum_of(latex_product_of(x[0], x[1]), 1, x[2]);
  case less:
    return infix(" < ", precedence::sum);
  case less_equal:
    return infix(" \\le ", precedence::sum);
  case equal:
    return infix(" = ", precedence::sum);
  case both:
    return infix(" \\land ", precedence::sum);
  case either:
    return infix(" \\lor ", precedence::sum);
  case no:
    return {"\\lnot " + x[0].inside(precedence::atom), precedence::product, style};
  case select:
    return {"\\begin{cases}" + x[1].text + " & " + x[0].text + "\\\\" + x[2].text +
                " & \\text{else}\\end{cases}",
            precedence::atom, style};
  default:
    break;
  }
  const std::string name(function_name_of(n.what));
  const function_name written = {name.c_str(), latex_command(n.what)};
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

} // namespace detail

/// The only output of a formula for a paper, to stand in mathematics mode, as `to_latex` writes
/// typed formulas; vectors as columns, quaternions as (w, x, y, z).
/// \throws invalid_input for several outputs, and if the formula has more than 2000 operations
[[nodiscard]] inline std::string to_latex(const formula_graph& f) {
  using detail::latex_terms;
  const graph& g = f.operations();
  duet::detail::require(f.outputs().size() == 1, "duet: to_latex takes a formula with one output");
  duet::detail::require(detail::written_size(f) <= detail::max_latex_size,
                        "duet: to_latex: the formula has more than ", detail::max_latex_size,
                        " operations");
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
