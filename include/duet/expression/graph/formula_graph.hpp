// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/graph/recorded.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

/// \file
/// A formula as data: operations, with the inputs and outputs that have names.

namespace duet::expression {

/// Kind of an input or output, and the order of its numbers.
enum class shape {
  scalar,
  matrix,      ///< column by column; a vector has one column
  quaternion,  ///< w, x, y, z
  dual_vector, ///< n + εm: n, then m
  pose         ///< a dual quaternion: w, x, y, z of the real part, then of the dual part
};

/// An input or output of a formula.
struct named_value {
  std::string name;            ///< its name
  shape kind = shape::scalar;  ///< its kind
  int rows = 1;                ///< of a matrix; otherwise how many numbers it has
  int columns = 1;             ///< of a matrix; otherwise 1
  std::vector<int> nodes = {}; ///< its numbers, by their nodes
};

/// A formula as data: a function of named inputs with named outputs, by operations on real numbers
/// in the order in which they were written. `trace` and `read_formula` make it.
class formula_graph {
public:
  formula_graph() = default;

  /// The operations.
  [[nodiscard]] const graph& operations() const { return operations_; }
  /// For those who extend duet: to record further operations.
  [[nodiscard]] graph& operations() { return operations_; }
  /// The inputs in their order.
  [[nodiscard]] const std::vector<named_value>& inputs() const& { return inputs_; }
  /// Those of a temporary, so that a range-based for loop may use it.
  [[nodiscard]] std::vector<named_value> inputs() && { return std::move(inputs_); }
  /// The outputs in their order.
  [[nodiscard]] const std::vector<named_value>& outputs() const& { return outputs_; }
  /// Those of a temporary, likewise.
  [[nodiscard]] std::vector<named_value> outputs() && { return std::move(outputs_); }

  /// Number of all numbers of the inputs.
  [[nodiscard]] int input_size() const { return size_of(inputs_); }
  /// Number of all numbers of the outputs.
  [[nodiscard]] int output_size() const { return size_of(outputs_); }

  /// Adds an input.
  /// \throws invalid_input if its name is taken
  const named_value& add_input(named_value x) {
    require_new_name(inputs_, x.name, "input");
    int index = input_size();
    x.nodes.clear();
    for (int i = 0; i < x.rows * x.columns; ++i) {
      operations_.name_variable(index, component_name(x, i));
      x.nodes.push_back(operations_.variable(index++));
    }
    inputs_.push_back(std::move(x));
    return inputs_.back();
  }
  /// Adds an output.
  /// \throws invalid_input if its name is taken
  void add_output(named_value y) {
    require_new_name(outputs_, y.name, "output");
    outputs_.push_back(std::move(y));
  }
  /// Removes the outputs, for others.
  [[nodiscard]] std::vector<named_value> take_outputs() {
    return std::exchange(outputs_, std::vector<named_value>());
  }

  /// The input of that name.
  /// \throws invalid_input if the formula has no such input
  [[nodiscard]] const named_value& input(const std::string& name) const {
    const auto found = std::find_if(inputs_.begin(), inputs_.end(),
                                    [&](const named_value& x) { return x.name == name; });
    duet::detail::require(found != inputs_.end(), "duet: the formula has no input '", name, "'");
    return *found;
  }

  /// Numbers of uses of the nodes, as outputs and as operands of nodes that the outputs need: 0 for
  /// those that they do not need.
  [[nodiscard]] std::vector<int> uses() const {
    std::vector<int> result(std::size_t(operations_.size()), 0);
    for (const named_value& y : outputs_) {
      for (const int node : y.nodes) {
        ++result[std::size_t(node)];
      }
    }
    for (int i = operations_.size() - 1; i >= 0; --i) {
      for (const int operand : operations_[i].operands) {
        if (operand >= 0 && result[std::size_t(i)] > 0) {
          ++result[std::size_t(operand)];
        }
      }
    }
    return result;
  }
  /// The nodes that the outputs need, in order: true for each of them.
  [[nodiscard]] std::vector<bool> needed() const {
    const std::vector<int> counts = uses();
    return {counts.begin(), counts.end()};
  }

private:
  /// The name of the i-th number of an input, counted from 0.
  [[nodiscard]] static std::string component_name(const named_value& x, int i) {
    if (x.kind == shape::scalar) {
      return x.name;
    }
    return x.kind == shape::matrix && x.columns > 1
               ? x.name + "[" + std::to_string(i % x.rows) + "," + std::to_string(i / x.rows) + "]"
               : x.name + "[" + std::to_string(i) + "]";
  }
  [[nodiscard]] static int size_of(const std::vector<named_value>& values) {
    int size = 0;
    for (const named_value& x : values) {
      size += x.rows * x.columns;
    }
    return size;
  }
  static void require_new_name(const std::vector<named_value>& values, const std::string& name,
                               const char* role) {
    for (const named_value& x : values) {
      duet::detail::require(x.name != name, "duet: two ", role, "s of a formula are named '", name,
                            "'");
    }
  }

  graph operations_;
  std::vector<named_value> inputs_, outputs_;
};

/// Numbers of operations of a formula, by kind.
struct operation_counts {
  int additions = 0;       ///< and subtractions
  int multiplications = 0; ///< of whole powers those of repeated squaring
  int divisions = 0;       ///< quotients and reciprocals
  int sines = 0;           ///< sines and cosines of an angle together
  int functions = 0;       ///< other functions
  int choices = 0;         ///< comparisons and selections

  /// All of them.
  [[nodiscard]] int total() const {
    return additions + multiplications + divisions + sines + functions + choices;
  }
};

namespace detail {

/// Products that x^n takes by halving n.
[[nodiscard]] constexpr int products_of_power(int n) {
  n = n < 0 ? -n : n;
  int count = 0;
  for (; n > 1; n /= 2) {
    count += 1 + n % 2;
  }
  return count;
}

} // namespace detail

/// The operations that the outputs need. Signs are not counted.
[[nodiscard]] inline operation_counts count_operations(const formula_graph& f) {
  using enum operation;
  operation_counts n;
  const graph& g = f.operations();
  const std::vector<bool> needed = f.needed();
  std::vector<bool> has_sine(needed.size(), false);
  for (int i = 0; i < g.size(); ++i) {
    if (!needed[std::size_t(i)]) {
      continue;
    }
    const operation what = g[i].what;
    if (what == sum || what == difference) {
      ++n.additions;
    } else if (what == product) {
      ++n.multiplications;
    } else if (what == quotient) {
      ++n.divisions;
    } else if (what == power) {
      n.multiplications += detail::products_of_power(g[i].index);
      n.divisions += g[i].index < 0;
    } else if (what == sin || what == cos) {
      const std::size_t angle = std::size_t(g[i].operands[0]);
      n.sines += !has_sine[angle];
      has_sine[angle] = true;
    } else if (what >= less) {
      ++n.choices;
    } else if (what > negative) {
      ++n.functions;
    }
  }
  return n;
}

namespace detail {

/// Adds the input x, a column of `size` numbers, and gives what stands for it.
template <class Column>
[[nodiscard]] Column add_column(formula_graph& f, Eigen::Index size) {
  const std::vector<int> nodes =
      f.add_input({.name = "x", .kind = shape::matrix, .rows = int(size)}).nodes;
  Column x(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    x[i] = recorded(f.operations(), nodes[std::size_t(i)]);
  }
  return x;
}

} // namespace detail

} // namespace duet::expression
