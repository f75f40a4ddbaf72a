// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/code/code_writer.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/graph/graph_text.hpp>
#include <duet/expression/graph/trace.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <string>
#include <vector>

/// \file
/// Formulas as functions of Python with NumPy.

namespace duet::expression {

namespace detail {

/// Python with NumPy, of numbers and of arrays alike.
class python_language {
public:
  [[nodiscard]] std::string number(double x) const { return number_literal(x, "np.nan", "np.inf"); }
  [[nodiscard]] printed call(const graph_node& n, const std::array<printed, 3>& x) const {
    return call_of(function(n), n, x);
  }
  [[nodiscard]] printed choice(const std::array<printed, 3>& x) const {
    return {"np.where(" + x[0].text + ", " + x[1].text + ", " + x[2].text + ")"};
  }
  [[nodiscard]] printed condition(const graph_node& n, const std::array<printed, 3>& x) const {
    const std::string both = "(" + x[0].text + ", " + x[1].text + ")";
    switch (n.what) {
    case operation::both:
      return {"np.logical_and" + both};
    case operation::either:
      return {"np.logical_or" + both};
    case operation::no:
      return {"np.logical_not(" + x[0].text + ")"};
    default:
      return infix_condition(n, x, "", "np.");
    }
  }
  [[nodiscard]] std::string assignment(const std::string& name, const std::string& value,
                                       bool /*is_condition*/) const {
    return name + " = " + value;
  }

  /// The helper functions that a body calls.
  [[nodiscard]] std::string helpers(const code_body& body) const {
    std::string text;
    const auto add = [&](operation what, const char* helper) {
      text += body.functions.count(what) > 0 ? helper : "";
    };
    add(operation::round, R"(def _duet_round(x):
    """The nearest integer, halves away from zero."""
    whole = np.trunc(x)
    return np.where(np.abs(x - whole) >= 0.5, whole + np.copysign(1.0, x), whole)


)");
    add(operation::remainder, R"(@np.vectorize
def _duet_remainder(x, y):
    return math.remainder(x, y) if y != 0 and not math.isinf(x) else math.nan


)");
    add(operation::fma, R"(@np.vectorize
def _duet_fma(x, y, z):
    """x*y + z, rounded once."""
    rounded = x * y + z
    if not (math.isfinite(x) and math.isfinite(y) and math.isfinite(z)):
        return rounded
    exact = Fraction(float(x)) * Fraction(float(y)) + Fraction(float(z))
    try:
        return float(exact) if exact != 0 else float(rounded)
    except OverflowError:
        return math.inf if exact > 0 else -math.inf


)");
    add(operation::erf, "_duet_erf = np.vectorize(math.erf, otypes=[float])\n\n\n");
    add(operation::erfc, "_duet_erfc = np.vectorize(math.erfc, otypes=[float])\n\n\n");
    add(operation::tgamma, R"(@np.vectorize
def _duet_tgamma(x):
    try:
        return math.gamma(x)
    except ValueError:
        return math.copysign(math.inf, x) if x == 0 else math.nan
    except OverflowError:
        return math.copysign(math.inf, x)


)");
    add(operation::lgamma, R"(@np.vectorize
def _duet_lgamma(x):
    try:
        return math.lgamma(x)
    except (ValueError, OverflowError):
        return math.inf


)");
    for (const int order : body.stumpff) {
      text += stumpff_helper(order);
    }
    add(operation::arc_ratio, R"(def _duet_arc_ratio(s, w):
    root = np.sqrt(s)
    return np.where((s == 0) & (w > 0), 1.0 / w, np.arctan2(root, w) / root)


)");
    for (std::size_t at = 0; (at = text.find("@np.vectorize\n", at)) != std::string::npos; ++at) {
      text.replace(at, 13, "@functools.partial(np.vectorize, otypes=[float])");
    }
    const std::string first =
        text.find("functools") != std::string::npos ? "import functools\n" : "";
    return first + (text.find("math.") != std::string::npos ? "import math\n" : "") +
           (text.find("Fraction") != std::string::npos ? "from fractions import Fraction\n" : "") +
           (first.empty() && text.find("math.") == std::string::npos ? "" : "\n") +
           "import numpy as np\n\n\n" + array_helpers + text;
  }

private:
  static constexpr const char* array_helpers = R"python(def _duet_input(name, x, dims):
    """The array, whose first dimensions must be dims; further ones are those of many inputs."""
    x = np.asarray(x, dtype=float)
    if x.shape[:len(dims)] != dims:
        raise ValueError(f"{name} has shape {x.shape}, expected {dims} or {dims} + (...)")
    return x


def _duet_output(dims, many, *numbers):
    """An array of the numbers, row by row, and of the dimensions of many inputs behind dims."""
    result = np.empty((len(numbers),) + many)
    for k, x in enumerate(numbers):
        result[k] = x
    return result.reshape(dims + many)[()]


)python";

  [[nodiscard]] static std::string function(const graph_node& n) {
    const std::string name(function_name_of(n.what));
    switch (n.what) {
    case operation::stumpff:
      return "_duet_stumpff" + std::to_string(n.index);
    case operation::pow:
      return "np.power";
    case operation::round:
    case operation::remainder:
    case operation::fma:
    case operation::erf:
    case operation::erfc:
    case operation::tgamma:
    case operation::lgamma:
    case operation::arc_ratio:
      return "_duet_" + name;
    default: // arcsin, arctan2, arcsinh …
      return name[0] == 'a' && n.what != operation::abs ? "np.arc" + name.substr(1) : "np." + name;
    }
  }
  [[nodiscard]] std::string stumpff_helper(int order) const {
    const auto literal = [this](double x) { return number(x); };
    const std::vector<double> terms = stumpff_terms(order);
    const std::string text = "def _duet_stumpff" + std::to_string(order) +
                             "(s):\n    square = s * s\n    even = " + horner(terms, 0, literal) +
                             "\n    odd = " + horner(terms, 1, literal) +
                             "\n    small = even - s * odd\n";
    if (order < 2) {
      return text + "    root = np.sqrt(s)\n    return np.where(s <= 1, small, " +
             (order == 0 ? "np.cos(root)" : "np.sin(root) / root") + ")\n\n\n";
    }
    return text + "    return np.where(s > 4, (" + number(inverse_factorial(order - 2)) +
           " - _duet_stumpff" + std::to_string(order - 2) + "(s)) / s, small)\n\n\n";
  }
};

/// The dimensions of a value as a tuple of Python.
[[nodiscard]] inline std::string python_dimensions(const named_value& x) {
  if (x.kind == shape::scalar) {
    return "()";
  }
  return "(" + std::to_string(x.rows) +
         (x.columns == 1 ? ",)" : ", " + std::to_string(x.columns) + ")");
}

/// A module's function in Python.
[[nodiscard]] inline std::string python_function(const formula_graph& original,
                                                 const std::string& name,
                                                 const code_options& options) {
  const formula_graph f = without_powers(original);
  code_names names(f, name, "to_python");
  const std::string many = names.table.add("many");
  const python_language language;
  const code_body body =
      write_body(f,
                 input_texts(f, names,
                             [](const named_value& x, const std::string& text, int i, int j) {
                               return text + "[" + std::to_string(i) +
                                      (x.columns == 1 ? "" : ", " + std::to_string(j)) + "]";
                             }),
                 names.table.prefix("t"), language);
  const auto describe = [](const named_value& x) {
    const std::string dimensions = python_dimensions(x);
    return described(x, "") +
           (x.kind == shape::scalar
                ? ""
                : ", shape " + dimensions.substr(0, dimensions.find_last_not_of(",)") + 1) +
                      ", ...)");
  };
  std::vector<std::string> lines = comment_lines(f, names, options, describe);
  lines.insert(lines.end() - 1, "Scalars may be arrays; all inputs are broadcast together.");
  std::string text = language.helpers(body) + "def " + name + "(" + joined(names.inputs) +
                     "):\n    \"\"\"" + indented(lines, "    ").substr(4) + "    \"\"\"\n";
  std::vector<std::string> shapes;
  for (std::size_t k = 0; k < f.inputs().size(); ++k) {
    const named_value& x = f.inputs()[k];
    const std::string& input = names.inputs[k];
    text += "    " + input + " = _duet_input(\"" + input + "\", " + input + ", " +
            python_dimensions(x) + ")\n";
    const int dimensions = x.kind == shape::scalar ? 0 : x.columns == 1 ? 1 : 2;
    shapes.push_back(input + ".shape" +
                     (dimensions == 0 ? "" : "[" + std::to_string(dimensions) + ":]"));
  }
  text += "    " + many + " = np.broadcast_shapes(" + joined(shapes) + ")\n" +
          "    with np.errstate(all=\"ignore\"):\n" + indented(body.statements, "        ");
  std::vector<std::string> results;
  std::size_t begin = 0;
  for (const named_value& y : f.outputs()) {
    std::string result = "_duet_output(" + python_dimensions(y) + ", " + many;
    for (int i = 0; i < y.rows * y.columns; ++i) { // row by row
      const int k = i % y.columns * y.rows + i / y.columns;
      result += ", " + body.outputs[begin + std::size_t(k)];
    }
    results.push_back(result + ")");
    begin += std::size_t(y.rows * y.columns);
  }
  if (results.size() == 1) {
    return text + "        return " + results[0] + "\n";
  }
  text += "        return (\n";
  for (const std::string& result : results) {
    text += "            " + result + ",\n";
  }
  return text + "        )\n";
}

} // namespace detail

/// The formula as a function of Python with NumPy: `def name(u, w)`, which returns one array, or a
/// tuple of them. Vectors have the shape (3, ...), matrices (rows, columns, ...); the dimensions
/// behind are those of many inputs at once, which are broadcast together, with scalars as arrays of
/// any shape. The text is a whole module. Of the options only
/// `description` applies.
///
/// \param f     a formula, its gradient, Hessian, Jacobian or motion, or what `trace` returns
/// \param name  of the function
/// \throws invalid_input for a name that is no identifier
template <class F>
  requires TypedFormula<F> || std::derived_from<F, formula_graph>
[[nodiscard]] std::string to_python(const F& f, const std::string& name,
                                    const code_options& options = {}) {
  return detail::python_function(graph_of(f), name, options);
}

} // namespace duet::expression
