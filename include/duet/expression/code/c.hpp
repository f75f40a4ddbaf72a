// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/expression/code/code_writer.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/graph/graph_text.hpp>
#include <duet/expression/graph/trace.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Formulas as functions of C99.

namespace duet::expression {

namespace detail {

/// C, in double or single precision.
class c_language {
public:
  explicit c_language(bool is_single) : is_single_(is_single) {}

  [[nodiscard]] std::string type() const { return is_single_ ? "float" : "double"; }
  [[nodiscard]] std::string number(double x) const {
    if (std::isnan(x)) {
      return "NAN";
    }
    if (std::isinf(x)) {
      return x < 0 ? "-INFINITY" : "INFINITY";
    }
    return is_single_ ? float_literal(x) : number_literal(x);
  }
  [[nodiscard]] std::string function(const std::string& name) const {
    return name + (is_single_ ? "f" : "");
  }
  [[nodiscard]] bound_text call(const graph_node& n, const std::array<bound_text, 3>& x) const {
    std::string name(function_name_of(n.what));
    if (n.what == operation::abs) {
      name = "fabs";
    } else if (n.what == operation::stumpff) {
      return {"duet_stumpff" + std::to_string(n.index) + "(" + x[0].text + ")"};
    } else if (n.what == operation::arc_ratio) {
      return {"duet_arc_ratio(" + x[0].text + ", " + x[1].text + ")"};
    }
    std::string text = function(name) + "(" + x[0].text;
    for (int k = 1; k < operand_count(n.what); ++k) {
      text += ", " + x[std::size_t(k)].text;
    }
    return {text + ")"};
  }
  [[nodiscard]] bound_text choice(const std::array<bound_text, 3>& x) const {
    return {x[0].inside(binding::atom) + " ? " + x[1].inside(binding::sum) + " : " +
                x[2].inside(binding::sum),
            binding::condition};
  }
  [[nodiscard]] bound_text condition(const graph_node& n,
                                     const std::array<bound_text, 3>& x) const {
    const auto infix = [&](const char* sign, binding inner) -> bound_text {
      return {x[0].inside(inner) + sign + x[1].inside(inner), binding::condition};
    };
    switch (n.what) {
    case operation::less:
      return infix(" < ", binding::sum);
    case operation::less_equal:
      return infix(" <= ", binding::sum);
    case operation::equal:
      return infix(" == ", binding::sum);
    case operation::both:
      return infix(" && ", binding::atom);
    case operation::either:
      return infix(" || ", binding::atom);
    case operation::no:
      return {"!" + x[0].inside(binding::atom)};
    default:
      return {std::string(function_name_of(n.what)) + "(" + x[0].text + ")"};
    }
  }
  [[nodiscard]] std::string assignment(const std::string& name, const std::string& value,
                                       bool is_condition) const {
    return "const " + (is_condition ? "int" : type()) + " " + name + " = " + value + ";";
  }

  /// The helper functions that a body calls; they are static, so several files link.
  [[nodiscard]] std::string helpers(const code_body& body) const {
    const auto literal = [this](double x) { return number(x); };
    const std::string t = type();
    std::string text;
    for (const int order : body.stumpff) {
      const std::vector<double> terms = stumpff_terms(order);
      text += "static " + t + " duet_stumpff" + std::to_string(order) + "(" + t + " s)\n{\n";
      text += "  if (" + std::string(order < 2 ? "s <= " : "!(s > ") + number(order < 2 ? 1 : 4) +
              (order < 2 ? "" : ")") + ") {\n    const " + t + " square = s * s;\n    const " + t +
              " even = " + horner(terms, 0, literal) + ";\n    const " + t +
              " odd = " + horner(terms, 1, literal) + ";\n    return even - s * odd;\n  }\n";
      if (order == 0) {
        text += "  return " + function("cos") + "(" + function("sqrt") + "(s));\n";
      } else if (order == 1) {
        text += "  const " + t + " root = " + function("sqrt") + "(s);\n  return " +
                function("sin") + "(root) / root;\n";
      } else {
        double factorial = 1;
        for (int i = 2; i <= order - 2; ++i) {
          factorial *= i;
        }
        text += "  return (" + number(1 / factorial) + " - duet_stumpff" +
                std::to_string(order - 2) + "(s)) / s;\n";
      }
      text += "}\n\n";
    }
    if (body.has_arc_ratio) {
      text += "static " + t + " duet_arc_ratio(" + t + " s, " + t + " w)\n{\n  const " + t +
              " root = " + function("sqrt") + "(s);\n  if (s == " + number(0) + " && w > " +
              number(0) + ") {\n    return " + number(1) + " / w;\n  }\n  return " +
              function("atan2") + "(root, w) / root;\n}\n\n";
    }
    return text;
  }

private:
  bool is_single_;
};

/// A file's function in C.
[[nodiscard]] inline std::string c_function(const formula_graph& original, const std::string& name,
                                            const code_options& options) {
  duet::detail::require(!name.empty() && plain_name(name) == name &&
                            reserved_names().count(name) == 0,
                        "duet: to_c: '", name, "' is no name for a function");
  const formula_graph f = without_powers(original);
  const c_language language(options.is_single_precision);
  name_table names;
  static_cast<void>(names.add(name));
  std::vector<std::string> input_names, output_names, parameters, input_texts, loads;
  for (const named_value& x : f.inputs()) {
    input_names.push_back(names.add(x.name));
    const int size = x.rows * x.columns;
    if (x.kind == shape::scalar) {
      parameters.push_back(language.type() + " " + input_names.back());
      input_texts.push_back(input_names.back());
      continue;
    }
    parameters.push_back("const " + language.type() + " " + input_names.back() + "[" +
                         std::to_string(size) + "]");
    for (int k = 0; k < size; ++k) {
      input_texts.push_back(input_names.back() + "[" +
                            std::to_string(index_in_code(x, k, options.is_row_major)) + "]");
    }
  }
  for (const named_value& y : f.outputs()) {
    output_names.push_back(names.add(y.name));
    parameters.push_back(language.type() + " " +
                         (y.kind == shape::scalar ? "*" + output_names.back()
                                                  : output_names.back() + "[" +
                                                        std::to_string(y.rows * y.columns) + "]"));
  }
  // Outputs may be inputs: what is read is read before anything is written.
  const std::vector<bool> needed = f.needed();
  const std::string copies = names.prefix("x");
  int copied = 0;
  for (int i = 0; i < f.operations().size(); ++i) {
    const graph_node& n = f.operations()[i];
    if (needed[std::size_t(i)] && n.what == operation::variable) {
      std::string& text = input_texts[std::size_t(n.index)];
      if (text.back() == ']') {
        const std::string local = copies + std::to_string(++copied);
        loads.push_back("const " + language.type() + " " + local + " = " + text + ";");
        text = local;
      }
    }
  }
  code_body body = write_body(f, input_texts, names.prefix("t"), language);

  std::string text = "/*\n";
  for (const std::string& line : comment_lines(f, name, options, input_names, output_names)) {
    text += line.empty() ? " *\n" : " * " + line + "\n";
  }
  text += " * Outputs may overlap inputs. Stack: at most " +
          std::to_string(body.temporaries + copied) + " numbers of type " + language.type() +
          ".\n * Written by duet " DUET_VERSION_STRING "; free of licence conditions.\n */\n";
  text += "void " + name + "(";
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    text += (k > 0 ? ", " : "") + parameters[k];
  }
  text += ")\n{\n";
  for (const std::string& line : loads) {
    text += "  " + line + "\n";
  }
  for (const std::string& line : body.statements) {
    text += "  " + line + "\n";
  }
  std::size_t next = 0;
  for (std::size_t k = 0; k < f.outputs().size(); ++k) {
    const named_value& y = f.outputs()[k];
    for (int i = 0; i < y.rows * y.columns; ++i) {
      const std::string& value = body.outputs[next++];
      text += y.kind == shape::scalar
                  ? "  *" + output_names[k] + " = " + value + ";\n"
                  : "  " + output_names[k] + "[" +
                        std::to_string(index_in_code(y, i, options.is_row_major)) + "] = " + value +
                        ";\n";
    }
  }
  // Scalars that nothing needs.
  for (std::size_t k = 0; k < f.inputs().size(); ++k) {
    const named_value& x = f.inputs()[k];
    const bool is_used = std::any_of(x.nodes.begin(), x.nodes.end(),
                                     [&](int node) { return needed[std::size_t(node)]; });
    text += is_used ? "" : "  (void)" + input_names[k] + ";\n";
  }
  text += "}\n";
  return "#include <math.h>\n\n" + language.helpers(body) +
         "#ifdef __cplusplus\nextern \"C\" {\n#endif\n\n" + text +
         "\n#ifdef __cplusplus\n}\n#endif\n";
}

} // namespace detail

/// The formula as a function of C99: `void name(double u, const double w[3], double value[1] …)`,
/// inputs first. It takes no heap, has no state, and computes in the order of the formula; whole
/// powers are products. The text is a whole file, which also compiles as C++.
///
/// \param f     a formula, its gradient, Hessian, Jacobian or motion, or what `trace` returns
/// \param name  of the function
/// \throws invalid_input for a name that is no identifier of C
template <class F>
  requires TypedFormula<F> || std::derived_from<F, formula_graph>
[[nodiscard]] std::string to_c(const F& f, const std::string& name,
                               const code_options& options = {}) {
  return detail::c_function(graph_of(f), name, options);
}

} // namespace duet::expression
