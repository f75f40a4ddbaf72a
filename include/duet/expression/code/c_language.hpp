// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/expression/code/code_writer.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/graph/graph_text.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Common parts of the emitters of C and C++: expressions, and the helper functions that they call.
/// For those who extend duet.

namespace duet::expression::detail {

/// C and C++, in double or single precision.
class c_language {
public:
  /// C, or C++ with the helper functions in a namespace.
  explicit c_language(const code_options& options, std::string helper_namespace = {})
      : is_single_(options.is_single_precision), has_own_sines_(options.has_own_sines),
        namespace_(std::move(helper_namespace)) {
    duet::detail::require(!(is_single_ && has_own_sines_),
                          "duet: code_options: has_own_sines is for double precision only");
  }

  [[nodiscard]] bool is_cpp() const { return !namespace_.empty(); }

  [[nodiscard]] std::string type() const { return is_single_ ? "float" : "double"; }
  [[nodiscard]] std::string number(double x) const {
    if (!is_single_) {
      return number_literal(x, "NAN", "INFINITY");
    }
    const auto single = static_cast<float>(x); // infinite if x is beyond its range
    return number_literal(single, "NAN", "INFINITY") + (std::isfinite(single) ? "f" : "");
  }
  [[nodiscard]] std::string function(const std::string& name) const {
    return is_cpp() ? "std::" + name : name + (is_single_ ? "f" : "");
  }
  [[nodiscard]] printed call(const graph_node& n, const std::array<printed, 3>& x) const {
    const std::string name(function_name_of(n.what));
    return call_of(n.what == operation::stumpff     ? helper(name + std::to_string(n.index))
                   : n.what == operation::arc_ratio ? helper(name)
                   : n.what == operation::abs       ? function("fabs")
                                                    : function(name),
                   n, x);
  }
  [[nodiscard]] printed choice(const std::array<printed, 3>& x) const {
    return {x[0].inside(precedence::atom) + " ? " + x[1].inside(precedence::sum) + " : " +
                x[2].inside(precedence::sum),
            precedence::condition};
  }
  [[nodiscard]] printed condition(const graph_node& n, const std::array<printed, 3>& x) const {
    return infix_condition(n, x, "!", is_cpp() ? "std::" : "");
  }
  [[nodiscard]] std::string assignment(const std::string& name, const std::string& value,
                                       bool is_condition) const {
    return "const " + (is_condition ? (is_cpp() ? "bool" : "int") : type()) + " " + name + " = " +
           value + ";";
  }

  [[nodiscard]] bool has_own_sines() const { return has_own_sines_; }
  [[nodiscard]] std::string sine_pair(const std::string& angle, const std::string& sine,
                                      const std::string& cosine) const {
    return type() + " " + sine + ", " + cosine + "; " + helper("sincos") + "(" + angle + ", &" +
           sine + ", &" + cosine + ");";
  }

  /// The helper functions that a body calls; in C they are static, so several files link.
  [[nodiscard]] std::string helpers(const code_body& body) const {
    std::string text;
    for (const int order : body.stumpff) {
      text += stumpff_helper(order);
    }
    if (body.functions.count(operation::arc_ratio) > 0) {
      text += filled("@ T duet_arc_ratio(T s, T w)\n{\n  const T root = #sqrt(s);\n"
                     "  if (s == 0 && w > 0) {\n    return 1 / w;\n  }\n"
                     "  return #atan2(root, w) / root;\n}\n\n");
    }
    if (body.has_sine_pairs) {
      text += sines_helper();
    }
    return text.empty() || !is_cpp() ? text
                                     : "namespace " + namespace_ + " {\n\n" + text +
                                           "} // namespace " + namespace_ + "\n\n";
  }

private:
  [[nodiscard]] std::string helper(const std::string& name) const {
    return (is_cpp() ? namespace_ + "::" : "") + "duet_" + name;
  }
  /// A text in which T is the type, # stands before functions of the library, and @ for static.
  [[nodiscard]] std::string filled(const std::string& pattern) const {
    std::string text;
    for (std::size_t k = 0; k < pattern.size(); ++k) {
      const bool is_type = pattern[k] == 'T' && (k == 0 || pattern[k - 1] != '_');
      if (pattern[k] == '#') {
        const std::size_t end = pattern.find('(', k);
        text += function(pattern.substr(k + 1, end - k - 1));
        k = end - 1;
      } else if (pattern[k] == '@') {
        text += is_cpp() ? "inline" : "static";
      } else if (is_type) {
        text += type();
      } else {
        text += pattern[k];
      }
    }
    return text;
  }
  [[nodiscard]] std::string stumpff_helper(int order) const {
    const auto literal = [this](double x) { return number(x); };
    const std::vector<double> terms = stumpff_terms(order);
    std::string text =
        "@ T duet_stumpff" + std::to_string(order) + "(T s)\n{\n  if (" +
        (order < 2 ? "s <= 1" : "!(s > 4)") +
        ") {\n    const T square = s * s;\n    const T even = " + horner(terms, 0, literal) +
        ";\n    const T odd = " + horner(terms, 1, literal) +
        ";\n    return even - s * odd;\n  }\n";
    if (order == 0) {
      text += "  return #cos(#sqrt(s));\n";
    } else if (order == 1) {
      text += "  const T root = #sqrt(s);\n  return #sin(root) / root;\n";
    } else {
      text += "  return (" + number(inverse_factorial(order - 2)) + " - duet_stumpff" +
              std::to_string(order - 2) + "(s)) / s;\n";
    }
    return filled(text + "}\n\n");
  }
  /// As core/batch/vector_sine_cosine.hpp, operation by operation.
  [[nodiscard]] std::string sines_helper() const {
    const auto n = [](double x) { return number_literal(x); };
    return filled(
        "/* Sine and cosine within one unit of the last place; compile without contraction\n"
        "   (-ffp-contract=off) for the same bits everywhere below 8e5. */\n"
        "@ void duet_sincos(T x, T* sine, T* cosine)\n{\n"
        "  if (!(#fabs(x) < 8e5)) {\n    *sine = #sin(x);\n    *cosine = #cos(x);\n    return;\n  "
        "}\n"
        "  /* x = n pi/2 + r + tail, |r| <= pi/4: the products with n are exact. */\n"
        "  const T shifted = x * " +
        n(0x1.45f306dc9c883p-1) + " + " + n(0x1.8p52) + ";\n" + "  const T n = shifted - " +
        n(0x1.8p52) + ";\n" + "  const T w1 = n * " + n(0x1.921fb544p+0) + ", w2 = n * " +
        n(0x1.0b4611a6p-34) + ";\n" + "  const T w3 = n * " + n(0x1.3198a2ep-69) + ";\n" +
        "  const T r1 = x - w1;\n  const T r2 = r1 - w2;\n  const T r3 = r2 - w3;\n" +
        "  const T lost = n * " + n(0x1.b839a252049c1p-104) +
        " - (((r1 - r2) - w2) + ((r2 - r3) - w3));\n"
        "  const T r = r3 - lost;\n  const T tail = (r3 - r) - lost;\n"
        "  const T z = r * r;\n  const T z2 = z * z;\n  const T cube = z * r;\n"
        "  const T s = (" +
        n(0x1.111111110f8a5p-7) + " - z * " + n(0x1.a01a019c15e6dp-13) + ")\n" + "      + z2 * ((" +
        n(0x1.71de357ae42b6p-19) + " - z * " + n(0x1.ae5e686c75808p-26) + ")\n" + "      + z2 * " +
        n(0x1.5d93942c9fa1ap-33) + ");\n" + "  const T c = (" + n(0x1.555555555554cp-5) +
        " - z * " + n(0x1.6c16c16c1521ep-10) + ")\n" + "      + z2 * ((" +
        n(0x1.a01a019cbf387p-16) + " - z * " + n(0x1.27e4f8128eacfp-22) + ")\n" + "      + z2 * (" +
        n(0x1.1ee9f1327a1fap-29) + " - z * " + n(0x1.8fb11e2c1d83cp-37) + "));\n" +
        "  const T half = 0.5 * z;\n  const T rounded = 1 - half;\n"
        "  const T a = r - ((z * (0.5 * tail - cube * s) - tail) + cube * " +
        n(0x1.5555555555549p-3) + ");\n" +
        "  const T b = rounded + (((1 - rounded) - half) + (z2 * c - r * tail));\n"
        "  const int quadrant = " +
        (is_cpp() ? "static_cast<int>(n)" : "(int)n") + " & 3;\n" +
        "  const T y = quadrant % 2 == 0 ? a : b;\n  const T v = quadrant % 2 == 0 ? b : a;\n"
        "  *sine = quadrant >= 2 ? -y : y;\n"
        "  *cosine = quadrant == 1 || quadrant == 2 ? -v : v;\n}\n\n");
  }

  bool is_single_, has_own_sines_;
  std::string namespace_;
};

/// Lines as a comment of C.
[[nodiscard]] inline std::string block_comment(const std::vector<std::string>& lines) {
  std::string text = "/*\n";
  for (const std::string& line : lines) {
    text += line.empty() ? " *\n" : " * " + line + "\n";
  }
  return text + " */\n";
}

/// Statements by which no compiler warns of inputs that nothing needs.
[[nodiscard]] inline std::string unused_inputs(const formula_graph& f, const code_names& names,
                                               const std::string& cast = "(void)") {
  const std::vector<bool> needed = f.needed();
  std::string text;
  for (std::size_t k = 0; k < f.inputs().size(); ++k) {
    text += is_used(f.inputs()[k], needed) ? "" : "  " + cast + "(" + names.inputs[k] + ");\n";
  }
  return text;
}

} // namespace duet::expression::detail
