// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/expression/gradient.hpp>
#include <duet/expression/graph/components.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/formula_latex.hpp>
#include <duet/expression/text.hpp>
#include <duet/expression/tree/printed.hpp>

#include <concepts>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Gradients, Hessians, Jacobians and motions in LaTeX, and documents of formulas.

namespace duet::expression {

namespace detail {

/// Derivatives with respect to scalars, each as the formula that `derivative` makes, row by row.
template <class Made, class F>
struct scalar_derivatives {
  static constexpr bool exist = false;
};
template <class Motion>
inline constexpr bool is_of_scalar = false;
template <class Symbol, class Rate>
inline constexpr bool is_of_scalar<moving<Symbol, Rate>> = Symbol::kind_of == kind::scalar;
template <class... Motions, class F>
struct scalar_derivatives<gradient_of<motion_list<Motions...>>, F> {
  static constexpr bool exist = (is_of_scalar<Motions> && ...);
  static constexpr std::size_t columns = 1;
  static std::vector<std::string> latex(const F& f, notation style) {
    return {latex_of_node<rate_node<typename F::node_type, Motions>>(f.held(), style)...};
  }
};
template <class... Motions, class F>
struct scalar_derivatives<hessian_of<motion_list<Motions...>>, F> {
  static constexpr bool exist = (is_of_scalar<Motions> && ...);
  static constexpr std::size_t columns = sizeof...(Motions);
  template <class Motion>
  static void add_row(const F& f, notation style, std::vector<std::string>& entries) {
    using slope = rate_node<typename F::node_type, Motion>;
    (entries.push_back(latex_of_node<rate_node<slope, Motions>>(f.held(), style)), ...);
  }
  static std::vector<std::string> latex(const F& f, notation style) {
    std::vector<std::string> entries;
    (add_row<Motions>(f, style, entries), ...);
    return entries;
  }
};

/// An output of a formula alone.
[[nodiscard]] inline std::string latex_of_output(formula_graph f, std::size_t k) {
  named_value y = f.take_outputs()[k];
  f.add_output(std::move(y));
  return to_latex(f);
}

} // namespace detail

/// The derivatives that `gradient`, `hessian`, `jacobian` and `motion` stand for, as a matrix in
/// LaTeX. Entries are expanded as `components` does, in sums of products with sines and cosines of
/// whole angles; those of gradients and Hessians with respect to scalars are as `derivative` writes
/// them where that is shorter. A motion is its velocity and acceleration, side by side.
///
/// \throws invalid_input as `to_latex` and `components` of formulas
template <class Made, Formula F>
[[nodiscard]] std::string to_latex(const detail::called_by_name<Made, F>& f,
                                   [[maybe_unused]] notation style = notation::latex) {
  using derivatives = detail::scalar_derivatives<Made, F>;
  if constexpr (derivatives::exist) {
    detail::printed_formula(typename F::node_type{}, f.formula().held(), style)
        .require_different_looks();
    std::vector<std::string> entries = derivatives::latex(f.formula(), style);
    const formula_graph expanded = components(f);
    const named_value& matrix = expanded.outputs().back();
    for (std::size_t k = 0; k < entries.size(); ++k) { // which is symmetric, or a column
      const std::string other = detail::latex_of_number(expanded, matrix.nodes[k]);
      entries[k] = other.size() < entries[k].size() ? other : entries[k];
    }
    return detail::printed_matrix(notation::latex, derivatives::columns, entries).text;
  } else {
    const formula_graph g = components(f); // the value is its first output
    std::string text;
    for (std::size_t k = 1; k < g.outputs().size(); ++k) {
      text += (k == 1 ? "" : ", \\quad ") + detail::latex_of_output(g, k);
    }
    return text;
  }
}

namespace detail {

[[nodiscard]] inline std::string document_item(const std::string& text) {
  return text.starts_with("\\begin{align") ? text : text + "\n";
}
[[nodiscard]] inline std::string document_item(const char* text) {
  return document_item(std::string(text));
}
template <class F>
[[nodiscard]] std::string document_item(const F& f) {
  return "\\[\n\\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{$"
         "\\displaystyle\n" +
         to_latex(f) + "\n$}\n\\]\n";
}

} // namespace detail

/// A LaTeX document of formulas, a file that `pdflatex` compiles without further packages than
/// amsmath and graphicx: each formula, gradient, Jacobian and so on is displayed by `to_latex`;
/// formulas wider than the line are reduced to it. Texts between them are LaTeX, and stand as they
/// are, derivations included: `document("The arm:", arm, jacobian(arm, wrt(u), frame::body))`.
template <class... Items>
  requires(sizeof...(Items) > 0)
[[nodiscard]] std::string document(const Items&... items) {
  std::string text = "\\documentclass{article}\n\\usepackage{amsmath}\n\\usepackage{graphicx}\n"
                     "\\setcounter{MaxMatrixCols}{40}\n\\setlength{\\parindent}{0pt}\n"
                     "\\allowdisplaybreaks\n\\begin{document}\n";
  ((text += detail::document_item(items) + "\n"), ...);
  return text + "\\end{document}\n";
}

} // namespace duet::expression
