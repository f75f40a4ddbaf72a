// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/code/c_language.hpp>
#include <duet/expression/code/code_writer.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/trace.hpp>

#include <concepts>
#include <cstddef>
#include <string>
#include <vector>

/// \file
/// Formulas as functions of C++ with arguments and results of Eigen.

namespace duet::expression {

namespace detail {

/// The type of a value in C++.
[[nodiscard]] inline std::string eigen_type(const named_value& x, const c_language& language) {
  if (x.kind == shape::scalar) {
    return language.type();
  }
  const bool is_short = x.rows >= 2 && x.rows <= 4;
  const std::string rows = std::to_string(x.rows), letter = language.type().substr(0, 1);
  if (x.columns == 1 && is_short) {
    return "Eigen::Vector" + rows + letter;
  }
  if (x.columns == x.rows && is_short) {
    return "Eigen::Matrix" + rows + letter;
  }
  return "Eigen::Matrix<" + language.type() + ", " + rows + ", " + std::to_string(x.columns) + ">";
}

/// An element of an Eigen vector or matrix.
[[nodiscard]] inline std::string eigen_element(const named_value& x, const std::string& name, int i,
                                               int j) {
  const std::string row = std::to_string(i);
  return name + (x.columns == 1 ? "[" + row + "]" : "(" + row + ", " + std::to_string(j) + ")");
}

/// A file's function in C++.
[[nodiscard]] inline std::string
cpp_function(const formula_graph& original, const std::string& name, const code_options& options) {
  const formula_graph f = without_powers(original);
  const std::string struct_name = name + "_result", helpers = name + "_helpers";
  code_names names(f, name, "to_cpp", {struct_name, helpers});
  const c_language language(options, helpers);
  std::vector<std::string> parameters;
  for (std::size_t k = 0; k < f.inputs().size(); ++k) {
    const named_value& x = f.inputs()[k];
    const std::string type = eigen_type(x, language);
    parameters.push_back((x.kind == shape::scalar ? type + " " : "const " + type + "& ") +
                         names.inputs[k]);
  }
  const code_body body =
      write_body(f, input_texts(f, names, eigen_element), names.table.prefix("t"), language);
  const bool is_struct = f.outputs().size() > 1;
  const std::string result = is_struct ? names.table.add("result") : names.outputs.at(0);
  const std::string result_type = is_struct ? struct_name : eigen_type(f.outputs()[0], language);
  std::string text = block_comment(
      comment_lines(f, names, options, [](const named_value& x) { return described(x, ""); }));
  text += "[[nodiscard]] inline " + result_type + " " + name + "(" + joined(parameters) + ") {\n" +
          indented(body.statements);
  std::string fields;
  if (!is_struct && f.outputs()[0].kind == shape::scalar) {
    text += unused_inputs(f, names, "static_cast<void>") + "  return " + body.outputs[0] + ";\n}\n";
  } else {
    text += "  " + result_type + " " + result + ";\n";
    std::size_t next = 0;
    for (std::size_t k = 0; k < f.outputs().size(); ++k) {
      const named_value& y = f.outputs()[k];
      const std::string target = is_struct ? result + "." + names.outputs[k] : result;
      fields += "  " + eigen_type(y, language) + " " + names.outputs[k] + ";\n";
      for (int i = 0; i < y.rows * y.columns; ++i) {
        text +=
            "  " +
            (y.kind == shape::scalar ? target : eigen_element(y, target, i % y.rows, i / y.rows)) +
            " = " + body.outputs[next++] + ";\n";
      }
    }
    text += unused_inputs(f, names, "static_cast<void>") + "  return " + result + ";\n}\n";
  }
  return "#pragma once\n\n#include <Eigen/Core>\n\n#include <cmath>\n\n" + language.helpers(body) +
         (is_struct ? "struct " + struct_name + " {\n" + fields + "};\n\n" : "") + text;
}

} // namespace detail

/// The formula as an inline function of C++: `Eigen::Vector3d name(double u, const
/// Eigen::Vector3d& w)`. Quaternions are `Eigen::Vector4d` w, x, y, z; dual vectors and poses are
/// vectors of 6 and 8 numbers. Several outputs come as a struct `name_result`. The text is a whole
/// header, which needs `<cmath>` and `<Eigen/Core>` only, and C++17.
///
/// \param f     a formula, its gradient, Hessian, Jacobian or motion, or what `trace` returns
/// \param name  of the function
/// \throws invalid_input for a name that is no identifier, and for own sines in `float`
template <class F>
  requires TypedFormula<F> || std::derived_from<F, formula_graph>
[[nodiscard]] std::string to_cpp(const F& f, const std::string& name,
                                 const code_options& options = {}) {
  return detail::cpp_function(graph_of(f), name, options);
}

} // namespace duet::expression
