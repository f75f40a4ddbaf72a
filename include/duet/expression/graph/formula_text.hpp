// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/expression/graph/formula_grammar.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/graph/graph_text.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// Formulas that are data as text, which `read_formula` reads again.

namespace duet::expression {

namespace detail {

/// The names of a text in the order of their appearance, as far as it has no declarations.
struct name_list {
  std::vector<std::string> names;

  void number(std::string_view, std::size_t) {}
  void name(std::string_view word, std::size_t) {
    if (std::find(names.begin(), names.end(), word) == names.end()) {
      names.emplace_back(word);
    }
  }
  void apply(std::string_view, int, std::size_t) {}
  void component(int, std::size_t) {}
  void declare(std::string_view, std::string_view, std::size_t) {}
  void assign(std::string_view, std::size_t) {}
  void output(std::string_view, std::size_t) {}
};

/// Writes the outputs of a formula, with names for common parts where they would be long.
class formula_writer {
public:
  /// \param exact_constants  as for `read_formula`
  formula_writer(const formula_graph& f, bool exact_constants)
      : f_(f), g_(f.operations()), has_exact_constants_(exact_constants), uses_(f.uses()),
        texts_(uses_.size()) {}

  [[nodiscard]] std::string text(bool has_declarations = true) {
    const bool is_long = measure();
    std::string body;
    const std::string prefix = unused_prefix();
    int shared = 0;
    for (int i = 0; i < g_.size(); ++i) {
      const std::size_t k = std::size_t(i);
      if (uses_[k] == 0) {
        continue;
      }
      texts_[k] = node(g_[i]);
      if (is_long && (is_named(i) || texts_[k].text.size() > max_length)) {
        const std::string name = prefix + std::to_string(++shared);
        body += name + " = " + texts_[k].text + "; ";
        texts_[k] = {name};
      }
    }
    for (std::size_t k = 0; k < f_.outputs().size(); ++k) {
      body += (k == 0 ? "" : ", ") + output(f_.outputs()[k]);
    }
    return has_declarations ? declarations(body, shared > 0) + body : body;
  }

private:
  [[nodiscard]] bool is_leaf(int i) const { return g_[i].what <= operation::variable; }
  /// True if names are needed: without, the text would be long or deeply nested.
  [[nodiscard]] bool measure() {
    depths_.assign(uses_.size(), 0);
    std::vector<double> lengths(uses_.size(), 0);
    double length = 0;
    bool is_deep = false;
    for (int i = 0; i < g_.size(); ++i) {
      const std::size_t k = std::size_t(i);
      if (uses_[k] > 0) {
        lengths[k] = double(node(g_[i]).text.size());
        for (const int operand : g_[i].operands) {
          lengths[k] += operand >= 0 ? lengths[std::size_t(operand)] : 0;
        }
        depths_[k] = depth(g_[i]);
        is_deep = is_deep || depths_[k] > max_depth;
        depths_[k] %= max_depth + 1; // from where a name begins anew
      }
    }
    for (const named_value& y : f_.outputs()) {
      for (const int node : y.nodes) {
        length += lengths[std::size_t(node)];
      }
    }
    return is_deep || length > double(max_length);
  }
  [[nodiscard]] int depth(const graph_node& n) const {
    int result = 0;
    for (const int operand : n.operands) {
      if (operand >= 0) {
        const bool is_chain = operand == n.operands[0] && n.what == g_[operand].what &&
                              (n.what == operation::sum || n.what == operation::product);
        result = std::max(result, depths_[std::size_t(operand)] + (is_chain ? 0 : 1));
      }
    }
    return result;
  }
  [[nodiscard]] bool is_named(int i) const {
    const bool is_short = g_[i].what == operation::negative && is_leaf(g_[i].operands[0]);
    return !is_leaf(i) && !is_short &&
           (uses_[std::size_t(i)] > 1 || depths_[std::size_t(i)] == max_depth);
  }
  /// t, with underscores if an input begins so.
  [[nodiscard]] std::string unused_prefix() const {
    std::string prefix = "t";
    const auto is_used = [&] {
      return std::any_of(f_.inputs().begin(), f_.inputs().end(),
                         [&](const named_value& x) { return x.name.starts_with(prefix); });
    };
    while (is_used()) {
      prefix += "_";
    }
    return prefix;
  }
  [[nodiscard]] static bool is_power_of_ten(double x) {
    double power = 10;
    for (int k = 1; k < 22 && power < x; ++k) {
      power *= 10;
    }
    return power == x;
  }
  [[nodiscard]] printed node(const graph_node& n) const {
    std::array<printed, 3> operands;
    for (std::size_t k = 0; k < 3; ++k) {
      if (n.operands[k] >= 0) {
        operands[k] = texts_[std::size_t(n.operands[k])];
      }
    }
    const auto is_number = [&](int k) { return g_.is_number(n.operands[std::size_t(k)]); };
    if (n.what == operation::number && std::isnan(n.number)) {
      return {"0 / 0", precedence::product};
    }
    if (n.what == operation::pow) {
      return {operands[0].inside(precedence::atom) + "^" + operands[1].inside(precedence::atom),
              precedence::power};
    }
    if (has_exact_constants_ && n.what == operation::acos && g_.is_number(n.operands[0], -1)) {
      return {"pi"};
    }
    if (has_exact_constants_ && n.what == operation::quotient && is_number(0) && is_number(1)) {
      const double a = g_[n.operands[0]].number, b = g_[n.operands[1]].number;
      constexpr double max_mantissa = 1e15;
      if (a > 0 && a < max_mantissa && std::trunc(a) == a && is_power_of_ten(b)) {
        return {duet::to_text(a / b)};
      }
    }
    return text_of(g_, n, operands);
  }
  [[nodiscard]] std::string output(const named_value& y) const {
    std::string numbers;
    for (const int i : y.nodes) {
      numbers += (numbers.empty() ? "" : ", ") + texts_[std::size_t(i)].text;
    }
    const bool is_vector = y.kind == shape::matrix && y.rows == 3 && y.columns == 1;
    duet::detail::require(is_vector || y.kind == shape::scalar || y.kind == shape::quaternion,
                          "duet: to_text: the output '", y.name, "' has ", y.nodes.size(),
                          " numbers (expected scalars, vectors of three numbers, and rotations)");
    const bool has_name = f_.outputs().size() > 1 || y.name != "y";
    return (has_name ? y.name + " = " : "") + (is_vector ? "[" + numbers + "]"
                                               : y.kind == shape::quaternion
                                                   ? "quaternion(" + numbers + ")"
                                                   : numbers);
  }
  /// Empty if the text has but scalar inputs, in their order.
  [[nodiscard]] std::string declarations(const std::string& body, bool has_shared) const {
    std::string text;
    bool are_scalars = !has_shared && body.size() < formula_grammar<name_list>::max_size;
    std::string last;
    for (const named_value& x : f_.inputs()) {
      const bool is_vector = x.kind == shape::matrix && x.rows == 3 && x.columns == 1;
      duet::detail::require(is_vector || x.kind == shape::scalar || x.kind == shape::quaternion,
                            "duet: to_text: the input '", x.name, "' has ", x.nodes.size(),
                            " numbers (expected scalars, vectors of three numbers, and rotations)");
      const std::string kind = x.kind == shape::scalar ? "scalar"
                               : is_vector             ? "vector"
                                                       : "rotation";
      are_scalars = are_scalars && x.kind == shape::scalar;
      text += (kind == last ? ", " : (last.empty() ? "" : "; ") + kind + " ") + x.name;
      last = kind;
    }
    if (are_scalars) {
      name_list found;
      formula_grammar<name_list>(body, found).read();
      std::erase(found.names, "pi");
      std::erase(found.names, "inf");
      if (std::equal(
              found.names.begin(), found.names.end(), f_.inputs().begin(), f_.inputs().end(),
              [](const std::string& name, const named_value& x) { return name == x.name; })) {
        return "";
      }
    }
    return text.empty() ? text : text + "; ";
  }

  static constexpr int max_depth = 40;
  static constexpr std::size_t max_length = 1500; ///< without names for common parts

  const formula_graph& f_;
  const graph& g_;
  bool has_exact_constants_;
  std::vector<int> uses_, depths_;
  std::vector<printed> texts_;
};

} // namespace detail

/// The formula as text, which `read_formula` reads again: `exp(-u) * sin(2 * u^2)`. Declarations of
/// inputs stand in front if there are vectors or rotations, or if scalars appear in another order;
/// in a text that would be long, parts that occur again have names `t1`, `t2` ….
/// \param exact_constants  true for a formula that was read so: writes 0.1 for 1/10
/// \throws invalid_input for matrices, poses and dual vectors
[[nodiscard]] inline std::string to_text(const formula_graph& f, bool exact_constants = false) {
  return detail::formula_writer(f, exact_constants).text();
}

} // namespace duet::expression
