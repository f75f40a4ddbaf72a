// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/expression/graph/formula_derivative.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/formula_latex.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/graph/trace.hpp>
#include <duet/expression/symbol.hpp>

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Derivations: derivatives step by step, as one writes them on paper.

namespace duet::expression {

namespace detail {

/// The derivative of the only output of a formula, in steps that apply the rules of one level of
/// its operations after the other.
class derivation_steps {
public:
  derivation_steps(const formula_graph& f, const std::string& input)
      : f_(f), input_(input), variable_(f.input(input).nodes[0]),
        depends_(f.needed().size(), false), levels_(depends_.size(), 0) {
    const graph& g = f_.operations();
    if (std::size_t(variable_) < depends_.size()) {
      depends_[std::size_t(variable_)] = true;
    }
    for (int i = 0; i < g.size(); ++i) {
      for (const int operand : g[i].operands) {
        if (operand >= 0 && depends_[std::size_t(operand)]) {
          depends_[std::size_t(i)] = true;
        }
      }
    }
    const std::vector<bool> needed = f_.needed();
    for (int i = g.size() - 1; i >= 0; --i) {
      for (const int operand : g[i].operands) {
        if (operand >= 0 && needed[std::size_t(i)]) {
          int& level = levels_[std::size_t(operand)];
          level = std::max(level, levels_[std::size_t(i)] + (is_linear(g[i]) ? 0 : 1));
        }
      }
    }
  }

  /// The derivative with the rules of the first levels applied; `is_complete` says if that is all.
  [[nodiscard]] std::string after(int levels, bool& is_complete) const {
    formula_graph f = f_;
    graph& g = f.operations();
    const std::vector<bool> needed = f.needed();
    std::map<int, int> open;
    is_complete = true;
    int index = f.input_size();
    for (int i = 0; i < int(needed.size()); ++i) {
      if (needed[std::size_t(i)] && depends_[std::size_t(i)] && i != variable_ &&
          levels_[std::size_t(i)] >= levels) {
        g.name_variable(index, differential() + "\\left[" + latex_of_number(f_, i) + "\\right]");
        open[i] = g.variable(index++);
        is_complete = false;
      }
    }
    node_derivatives by(g, needed, variable_, open);
    const int derivative = by[f.outputs()[0].nodes[0]];
    return latex_of_number(std::move(f), derivative);
  }

private:
  [[nodiscard]] bool is_linear(const graph_node& n) const {
    using enum operation;
    const auto moves = [&](std::size_t k) { return depends_[std::size_t(n.operands[k])]; };
    return n.what == negative || n.what == sum || n.what == difference ||
           (n.what == product && !(moves(0) && moves(1))) || (n.what == quotient && !moves(1));
  }
  [[nodiscard]] std::string differential() const {
    const std::string d = f_.input_size() == 1 ? "\\mathrm{d}" : "\\partial";
    return "\\frac{" + d + "}{" + d + (d[1] == 'p' ? " " : "") + latex_variable(input_).text + "}";
  }

  const formula_graph& f_;
  std::string input_;
  int variable_;
  std::vector<bool> depends_;
  std::vector<int> levels_; ///< number of rules around a node, sums and constant factors apart
};

} // namespace detail

/// The derivative of a scalar formula with respect to a scalar input, step by step: lines of LaTeX
/// in an `align*` environment (package amsmath). Every line applies the rules of one more level of
/// nested operations; the last is the derivative.
///
/// \throws invalid_input as `derivative(f, input)` and `to_latex(f)`, and for outputs and inputs
/// that are not scalars
[[nodiscard]] inline std::string derivation(const formula_graph& f, const std::string& input) {
  duet::detail::require(f.outputs().size() == 1 && f.outputs()[0].nodes.size() == 1 &&
                            f.input(input).nodes.size() == 1,
                        "duet: derivation takes a formula with one scalar output, and a scalar "
                        "input");
  const detail::derivation_steps steps(f, input);
  std::string text, last;
  bool is_complete = false;
  for (int level = 0; !is_complete; ++level) {
    const std::string line = steps.after(level, is_complete);
    if (line != last || (is_complete && level == 1)) {
      text += (level == 0 ? "" : level == 1 ? " &= " : " \\\\\n &= ") + line;
    }
    last = line;
  }
  return "\\begin{align*}\n " + text + "\n\\end{align*}\n";
}
/// The derivation of a typed formula by a symbol.
template <Formula F, Symbol U>
[[nodiscard]] std::string derivation(const F& f, const U&) {
  return derivation(graph_of(f), detail::symbol_facts<typename U::node_type>::name());
}

} // namespace duet::expression
