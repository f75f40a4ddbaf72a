// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/code/c_language.hpp>
#include <duet/expression/code/code_writer.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/graph/trace.hpp>

#include <concepts>
#include <cstddef>
#include <string>
#include <vector>

/// \file
/// Formulas as functions of C99.

namespace duet::expression {

namespace detail {

/// A file's function in C.
[[nodiscard]] inline std::string c_function(const formula_graph& original, const std::string& name,
                                            const code_options& options) {
  const formula_graph f = without_powers(original);
  const code_names names(f, name, "to_c");
  const c_language language(options);
  const auto index = [&](const named_value& x, int k) {
    return "[" + std::to_string(index_in_code(x, k, options.is_row_major)) + "]";
  };
  std::vector<std::string> parameters;
  for (std::size_t k = 0; k < f.inputs().size(); ++k) {
    const named_value& x = f.inputs()[k];
    parameters.push_back(x.kind == shape::scalar
                             ? language.type() + " " + names.inputs[k]
                             : "const " + language.type() + " " + names.inputs[k] + "[" +
                                   std::to_string(x.rows * x.columns) + "]");
  }
  for (std::size_t k = 0; k < f.outputs().size(); ++k) {
    const named_value& y = f.outputs()[k];
    parameters.push_back(language.type() + " " +
                         (y.kind == shape::scalar
                              ? "*" + names.outputs[k]
                              : names.outputs[k] + "[" + std::to_string(y.rows * y.columns) + "]"));
  }
  std::vector<std::string> inputs =
      input_texts(f, names, [&](const named_value& x, const std::string& text, int i, int j) {
        return text + index(x, i + j * x.rows);
      });
  // Outputs may be inputs: what is read is read before anything is written.
  const std::vector<bool> needed = f.needed();
  const std::string copies = names.table.prefix("x");
  std::vector<std::string> loads;
  for (int i = 0; i < f.operations().size(); ++i) {
    const graph_node& n = f.operations()[i];
    if (needed[std::size_t(i)] && n.what == operation::variable) {
      std::string& text = inputs[std::size_t(n.index)];
      if (text.back() == ']') {
        const std::string local = copies + std::to_string(loads.size() + 1);
        loads.push_back(language.assignment(local, text, false));
        text = local;
      }
    }
  }
  const code_body body = write_body(f, inputs, names.table.prefix("t"), language);

  const std::string order = options.is_row_major ? ", row by row" : ", column by column";
  std::vector<std::string> lines =
      comment_lines(f, names, options, [&](const named_value& x) { return described(x, order); });
  lines.insert(lines.end() - 1, "Outputs may overlap inputs. Stack: at most " +
                                    std::to_string(body.temporaries + int(loads.size())) +
                                    " numbers of type " + language.type() + ".");
  std::string text = block_comment(lines) + "void " + name + "(" + joined(parameters) + ")\n{\n";
  loads.insert(loads.end(), body.statements.begin(), body.statements.end());
  text += indented(loads);
  std::size_t next = 0;
  for (std::size_t k = 0; k < f.outputs().size(); ++k) {
    const named_value& y = f.outputs()[k];
    std::vector<std::string> stores(std::size_t(y.rows * y.columns)); // in the order in memory
    for (int i = 0; i < y.rows * y.columns; ++i) {
      stores[std::size_t(index_in_code(y, i, options.is_row_major))] =
          (y.kind == shape::scalar ? "*" + names.outputs[k] : names.outputs[k] + index(y, i)) +
          " = " + body.outputs[next++] + ";";
    }
    text += indented(stores);
  }
  text += unused_inputs(f, names) + "}\n";
  return "#include <math.h>\n\n" + language.helpers(body) +
         "#ifdef __cplusplus\nextern \"C\" {\n#endif\n\n" + text +
         "\n#ifdef __cplusplus\n}\n#endif\n";
}

} // namespace detail

/// The formula as a function of C99: `void name(double u, const double w[3], double value[1] …)`,
/// inputs first. It takes no heap, has no state, and computes in the order of the formula; whole
/// powers from −4 to 5 are products. The text is a whole file, which also compiles as C++.
///
/// \param f     a formula, its gradient, Hessian, Jacobian or motion, or what `trace` returns
/// \param name  of the function
/// \throws invalid_input for a name that is no identifier of C, and for own sines in `float`
template <class F>
  requires TypedFormula<F> || std::derived_from<F, formula_graph>
[[nodiscard]] std::string to_c(const F& f, const std::string& name,
                               const code_options& options = {}) {
  return detail::c_function(graph_of(f), name, options);
}

} // namespace duet::expression
