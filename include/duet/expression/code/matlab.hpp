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
#include <set>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// Formulas as functions of MATLAB and Octave.

namespace duet::expression {

namespace detail {

/// MATLAB, as Octave also runs it.
class matlab_language {
public:
  [[nodiscard]] std::string number(double x) const { return number_literal(x, "NaN", "Inf"); }
  [[nodiscard]] printed call(const graph_node& n, const std::array<printed, 3>& x) const {
    std::string name(function_name_of(n.what));
    if (n.what == operation::trunc) {
      name = "fix";
    } else if (n.what == operation::stumpff) {
      name = "duet_stumpff" + std::to_string(n.index);
    } else if (!helper_of(n.what).empty()) {
      name.insert(0, "duet_");
    }
    return call_of(name, n, x);
  }
  [[nodiscard]] printed choice(const std::array<printed, 3>& x) const {
    return {"duet_select(" + x[0].text + ", " + x[1].text + ", " + x[2].text + ")"};
  }
  [[nodiscard]] printed condition(const graph_node& n, const std::array<printed, 3>& x) const {
    return infix_condition(n, x, "~", n.what == operation::is_negative ? "duet_" : "");
  }
  [[nodiscard]] std::string assignment(const std::string& name, const std::string& value,
                                       bool /*is_condition*/) const {
    return name + " = " + value + ";";
  }

  /// The local functions that a body calls.
  [[nodiscard]] std::string helpers(const code_body& body) const {
    std::set<operation> functions = body.functions;
    if (functions.count(operation::remainder) > 0) {
      functions.insert(operation::fmod);
    }
    if (functions.count(operation::fmod) > 0) {
      functions.insert(operation::is_negative);
    }
    if (functions.count(operation::arc_ratio) > 0 || !body.stumpff.empty()) {
      functions.insert(operation::sqrt);
    }
    std::string text;
    for (const operation what : functions) {
      if (!helper_of(what).empty()) {
        text += "\n" + std::string(helper_of(what));
      }
    }
    for (const int order : body.stumpff) {
      text += "\n" + stumpff_helper(order);
    }
    return text;
  }

private:
  /// The functions that MATLAB lacks, or has for complex numbers or with other rounding than C.
  [[nodiscard]] static std::string_view helper_of(operation what) {
    switch (what) {
    case operation::sqrt:
      return "function y = duet_sqrt(x)\n  if x < 0, y = NaN; else, y = sqrt(x); end\nend\n";
    case operation::cbrt:
      return "function y = duet_cbrt(x)\n  y = nthroot(x, 3);\nend\n";
    case operation::exp2:
      return "function y = duet_exp2(x)\n  y = 2 ^ x;\nend\n";
    case operation::log:
      return "function y = duet_log(x)\n  if x < 0, y = NaN; else, y = log(x); end\nend\n";
    case operation::log2:
      return "function y = duet_log2(x)\n  if x < 0, y = NaN; else, y = log2(x); end\nend\n";
    case operation::log10:
      return "function y = duet_log10(x)\n  if x < 0, y = NaN; else, y = log10(x); end\nend\n";
    case operation::log1p:
      return "function y = duet_log1p(x)\n  if x < -1, y = NaN; else, y = log1p(x); end\nend\n";
    case operation::asin:
      return "function y = duet_asin(x)\n  if abs(x) > 1, y = NaN; else, y = asin(x); end\nend\n";
    case operation::acos:
      return "function y = duet_acos(x)\n  if abs(x) > 1, y = NaN; else, y = acos(x); end\nend\n";
    case operation::acosh:
      return "function y = duet_acosh(x)\n  if x < 1, y = NaN; else, y = acosh(x); end\nend\n";
    case operation::atanh:
      return "function y = duet_atanh(x)\n  if abs(x) > 1, y = NaN; else, y = atanh(x); "
             "end\nend\n";
    case operation::tgamma:
      return "function y = duet_tgamma(x)\n  if x < 0 && x == fix(x), y = NaN; else, y = gamma(x); "
             "end\nend\n";
    case operation::lgamma:
      return R"(function y = duet_lgamma(x)
  if x > 0 || isnan(x)
    y = gammaln(x);
  elseif x == fix(x)
    y = Inf;
  elseif x > -1e-17 % the products of the reflection would vanish
    y = -log(-x);
  else % by reflection
    y = log(pi / abs(sin(pi * (x - round(x))) * x)) - gammaln(-x);
  end
end
)";
    case operation::pow:
      return R"(function y = duet_pow(a, b) % Octave's a ^ b is complex for some whole b
  if a < 0 && b ~= fix(b) && ~isinf(a)
    y = NaN;
  elseif a < 0
    y = abs(a) ^ b;
    if mod(b, 2) == 1, y = -y; end
  else
    y = a ^ b;
  end
end
)";
    case operation::fma:
      return "function y = duet_fma(a, b, c) % rounded twice\n  y = a * b + c;\nend\n";
    case operation::fmod:
      return R"(function r = duet_fmod(x, y) % exact, as in C
  d = abs(y);
  r = abs(x);
  if isnan(d) || ~isfinite(r) || d == 0
    r = NaN;
    return;
  end
  while r >= d
    [~, a] = log2(r);
    [~, b] = log2(d);
    half = fix((a - b) / 2);
    s = d * 2 ^ half * 2 ^ (a - b - half);
    if s > r
      s = s / 2;
    end
    r = r - s;
  end
  if duet_signbit(x), r = -r; end
end
)";
    case operation::remainder:
      return R"(function r = duet_remainder(x, y) % the quotient to the nearest, halves to even
  d = abs(y);
  r = abs(duet_fmod(x, 2 * d));
  if isnan(r) || d == 0
    r = NaN;
    return;
  end
  if 2 * r > d
    r = r - d;
    if 2 * r >= d, r = r - d; end
  end
  if duet_signbit(x), r = -r; end
end
)";
    case operation::arc_ratio:
      return R"(function y = duet_arc_ratio(s, w)
  root = duet_sqrt(s);
  if s == 0 && w > 0, y = 1 / w; else, y = atan2(root, w) / root; end
end
)";
    case operation::is_negative:
      return "function y = duet_signbit(x)\n  y = x < 0 || (x == 0 && 1 / x < 0);\nend\n";
    case operation::select:
      return "function y = duet_select(condition, a, b)\n  if condition, y = a; else, y = b; "
             "end\nend\n";
    default:
      return {};
    }
  }
  [[nodiscard]] std::string stumpff_helper(int order) const {
    const auto literal = [this](double x) { return number(x); };
    const std::vector<double> terms = stumpff_terms(order);
    const std::string root = order == 0   ? "    y = cos(duet_sqrt(s));\n"
                             : order == 1 ? "    root = duet_sqrt(s);\n    y = sin(root) / root;\n"
                                          : "    y = (" + number(inverse_factorial(order - 2)) +
                                                " - duet_stumpff" + std::to_string(order - 2) +
                                                "(s)) / s;\n";
    return "function y = duet_stumpff" + std::to_string(order) + "(s)\n  if " +
           (order < 2 ? "s <= 1" : "~(s > 4)") +
           "\n    square = s * s;\n    even = " + horner(terms, 0, literal) +
           ";\n    odd = " + horner(terms, 1, literal) + ";\n    y = even - s * odd;\n  else\n" +
           root + "  end\nend\n";
  }
};

/// A file's function in MATLAB.
[[nodiscard]] inline std::string matlab_function(const formula_graph& original,
                                                 const std::string& name,
                                                 const code_options& options) {
  const formula_graph f = without_powers(original);
  const code_names names(f, name, "to_matlab");
  const matlab_language language;
  const auto element = [](const named_value& x, const std::string& text, int i, int j) {
    return text + "(" + std::to_string(i + 1) +
           (x.columns == 1 ? "" : ", " + std::to_string(j + 1)) + ")";
  };
  const code_body body =
      write_body(f, input_texts(f, names, element), names.table.prefix("t"), language);
  const bool has_one = names.outputs.size() == 1;
  std::string text = "function " + std::string(has_one ? "" : "[") + joined(names.outputs) +
                     (has_one ? "" : "]") + " = " + name + "(" + joined(names.inputs) + ")\n";
  text += indented(comment_lines(f, names, options,
                                 [](const named_value& x) {
                                   return (x.columns == 1 && x.kind != shape::scalar ? "column: "
                                                                                     : "") +
                                          described(x, "");
                                 }),
                   "% ");
  text += indented(body.statements);
  std::size_t next = 0;
  for (std::size_t k = 0; k < f.outputs().size(); ++k) {
    const named_value& y = f.outputs()[k];
    const std::string& output = names.outputs[k];
    if (y.kind != shape::scalar) {
      text += "  " + output + " = zeros(" + std::to_string(y.rows) + ", " +
              std::to_string(y.columns) + ");\n";
    }
    for (int i = 0; i < y.rows * y.columns; ++i) {
      text += "  " +
              (y.kind == shape::scalar ? output : element(y, output, i % y.rows, i / y.rows)) +
              " = " + body.outputs[next++] + ";\n";
    }
  }
  return text + "end\n" + language.helpers(body);
}

} // namespace detail

/// The formula as a function of MATLAB and Octave: `[value, gradient] = name(u, w)` of numbers,
/// column vectors and matrices. What is NaN in C is NaN, never complex. The text is a whole file,
/// to be saved as name.m. Of the options only
/// `description` applies.
///
/// \param f     a formula, its gradient, Hessian, Jacobian or motion, or what `trace` returns
/// \param name  of the function
/// \throws invalid_input for a name that is no identifier
template <class F>
  requires TypedFormula<F> || std::derived_from<F, formula_graph>
[[nodiscard]] std::string to_matlab(const F& f, const std::string& name,
                                    const code_options& options = {}) {
  return detail::matlab_function(graph_of(f), name, options);
}

} // namespace duet::expression
