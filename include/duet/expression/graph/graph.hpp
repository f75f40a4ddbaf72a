// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/types.hpp>
#include <duet/core/errors.hpp>
#include <duet/expression/tree/exact_rules.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Formulas as data: a directed graph of operations on real numbers, in which equal operations of
/// equal operands are one node. For those who extend duet; users call `trace`.

namespace duet::expression {

/// The operation of a node.
enum class operation : std::uint8_t {
  number,   ///< a constant
  variable, ///< the `index`-th input
  negative,
  sum,
  difference,
  product,
  quotient,
  power, ///< x^index of an integer index
  sqrt,
  cbrt,
  exp,
  exp2,
  expm1,
  log,
  log2,
  log10,
  log1p,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  sinh,
  cosh,
  tanh,
  asinh,
  acosh,
  atanh,
  erf,
  erfc,
  tgamma,
  lgamma,
  abs,
  floor,
  ceil,
  trunc,
  round,
  stumpff, ///< c_index(x) = Σ_k (−x)^k/(2k+index)!
  atan2,
  hypot,
  pow,
  fmod,
  remainder,
  arc_ratio, ///< atan2(√s, w)/√s
  fma,
  less, ///< conditions from here on
  less_equal,
  equal,
  is_finite,
  is_nan,
  is_negative, ///< the sign bit
  both,
  either,
  no,
  select ///< b if the condition a holds, otherwise c
};

/// True if the value of the operation is a condition.
[[nodiscard]] constexpr bool is_condition(operation o) {
  return o >= operation::less && o < operation::select;
}

/// Number of operands of the operation.
[[nodiscard]] constexpr int operand_count(operation o) {
  using enum operation;
  if (o <= variable) {
    return 0;
  }
  if (o == fma || o == select) {
    return 3;
  }
  const bool has_two = (o >= sum && o <= quotient) || (o >= atan2 && o <= arc_ratio) ||
                       (o >= less && o <= equal) || o == both || o == either;
  return has_two ? 2 : 1;
}

/// An operation and the nodes that it is applied to, all of them before it in the graph.
struct graph_node {
  operation what = operation::number;      ///< the operation
  int index = 0;                           ///< of `variable`, `power` and `stumpff`
  std::array<int, 3> operands{-1, -1, -1}; ///< positions in the graph, −1 for none
  double number = 0;                       ///< of `number`

  [[nodiscard]] friend constexpr bool operator==(const graph_node& a, const graph_node& b) {
    return a.what == b.what && a.index == b.index && a.operands == b.operands &&
           duet::detail::bit_cast<std::uint64_t>(a.number) ==
               duet::detail::bit_cast<std::uint64_t>(b.number);
  }
};

/// The operations of one or more formulas, operands first, each once (hash-consing). Only exact
/// simplifications are made, which keep the written order: terms 0 and factors 0 and 1, signs,
/// arithmetic of numbers without rounding, and choices that are known.
class graph : public detail::exact_rules<graph, operation> {
public:
  /// A graph of more nodes is refused.
  static constexpr int max_nodes = 10'000'000;

  /// Number of nodes.
  [[nodiscard]] int size() const { return int(nodes_.size()); }
  /// The i-th node.
  [[nodiscard]] const graph_node& operator[](int i) const { return nodes_[std::size_t(i)]; }

  /// The node of a constant.
  [[nodiscard]] int number(double x) {
    graph_node n;
    n.number = x == 0 ? 0 : x;
    return insert(n);
  }
  /// The node of the `index`-th input.
  [[nodiscard]] int variable(int index) {
    graph_node n{.what = operation::variable, .index = index};
    return insert(n);
  }
  /// Names the `index`-th variable, for texts.
  void name_variable(int index, std::string name) {
    names_.resize(std::max(names_.size(), std::size_t(index) + 1));
    names_[std::size_t(index)] = std::move(name);
  }
  /// The name of the `index`-th variable, by default x and its index.
  [[nodiscard]] std::string variable_name(int index) const {
    const std::size_t i = std::size_t(index);
    return i < names_.size() && !names_[i].empty() ? names_[i] : "x" + std::to_string(index);
  }
  /// The node of the operation applied to nodes, simplified.
  [[nodiscard]] int apply(operation what, int a, int b = -1, int c = -1, int index = 0) {
    const int simple = simplified(what, a, b, c, index);
    if (simple >= 0) {
      return simple;
    }
    graph_node n{.what = what, .index = index, .operands = {a, b, c}};
    if ((commutes(what) || what == operation::difference) && b != a) {
      graph_node exchanged = n; // a sum or product is the same, of a difference the negative
      std::swap(exchanged.operands[0], exchanged.operands[1]);
      const int found = table_.empty() ? -1 : table_[slot_of(exchanged)];
      if (found >= 0) {
        return commutes(what) ? found : negative(found);
      }
    }
    return insert(n);
  }

  /// Marks the value of a function whose derivative the user gave: that of its operations is
  /// another one.
  void mark_given(int i) {
    if (!is_number(i) && !is(i, operation::variable)) {
      has_given_derivative_.resize(std::max(has_given_derivative_.size(), std::size_t(i) + 1));
      has_given_derivative_[std::size_t(i)] = true;
    }
  }
  /// Requires that the derivative of a node is that of its operations.
  /// \throws invalid_input for a node marked by `mark_given`
  void require_own_derivative(int i) const {
    duet::detail::require(std::size_t(i) >= has_given_derivative_.size() ||
                              !has_given_derivative_[std::size_t(i)],
                          "duet: the formula has a function of with_derivative, whose given "
                          "derivative is not recorded (trace the derivative, or use a typed "
                          "formula)");
  }

  /// True if the i-th node is of that operation.
  [[nodiscard]] bool is(int i, operation what) const { return (*this)[i].what == what; }
  /// True if the i-th node is a constant.
  [[nodiscard]] bool is_number(int i) const { return is(i, operation::number); }
  /// True if the i-th node is the constant x.
  [[nodiscard]] bool is_number(int i, double x) const {
    return is_number(i) && (*this)[i].number == x;
  }

private:
  [[nodiscard]] static constexpr bool commutes(operation what) {
    using enum operation;
    return what == sum || what == product || what == hypot || what == equal || what == both ||
           what == either;
  }
  [[nodiscard]] static std::size_t hash(const graph_node& n) {
    std::uint64_t h = std::uint64_t(n.what) * 0x9E3779B97F4A7C15U + std::uint64_t(n.index);
    const auto mix = [&h](std::uint64_t x) {
      h = (h ^ x) * 0xD6E8FEB86659FD93U;
      h ^= h >> 32;
    };
    for (const int operand : n.operands) {
      mix(std::uint64_t(operand + 1));
    }
    mix(duet::detail::bit_cast<std::uint64_t>(n.number));
    return std::size_t(h);
  }
  /// The index in the table of the node, or of a gap for it.
  [[nodiscard]] std::size_t slot_of(const graph_node& n) const {
    const std::size_t mask = table_.size() - 1;
    std::size_t slot = hash(n) & mask;
    while (table_[slot] >= 0 && !(nodes_[std::size_t(table_[slot])] == n)) {
      slot = (slot + 1) & mask;
    }
    return slot;
  }
  [[nodiscard]] int insert(const graph_node& n) {
    if (2 * (nodes_.size() + 1) > table_.size()) {
      table_.assign(std::max<std::size_t>(64, 2 * table_.size()), -1);
      for (int i = 0; i < size(); ++i) {
        table_[slot_of((*this)[i])] = i;
      }
    }
    const std::size_t slot = slot_of(n);
    if (table_[slot] < 0) {
      duet::detail::require(size() < max_nodes, "duet: a formula of more than ", max_nodes,
                            " operations");
      table_[slot] = size();
      nodes_.push_back(n);
    }
    return table_[slot];
  }

  // For the rules that the graph shares with the tape.

  friend detail::exact_rules<graph, operation>;
  [[nodiscard]] operation code(int i) const { return (*this)[i].what; }
  [[nodiscard]] int operand(int i, int k) const { return (*this)[i].operands[std::size_t(k)]; }
  [[nodiscard]] double value(int i) const { return (*this)[i].number; }
  [[nodiscard]] bool is_zero(int i) const { return is_number(i, 0); }
  [[nodiscard]] int negative(int a) { return apply(operation::negative, a); }
  [[nodiscard]] int sum(int a, int b) { return apply(operation::sum, a, b); }
  [[nodiscard]] int difference(int a, int b) { return apply(operation::difference, a, b); }
  [[nodiscard]] int product(int a, int b) { return apply(operation::product, a, b); }
  [[nodiscard]] int quotient(int a, int b) { return apply(operation::quotient, a, b); }

  /// A simpler node of the same value, or −1.
  [[nodiscard]] int simplified(operation what, int a, int b, int c, int index) {
    switch (what) {
    case operation::negative:
      return simplified_negative(a);
    case operation::sum:
      return simplified_sum(a, b);
    case operation::difference: {
      const int simple = simplified_difference(a, b);
      return simple < 0 && is(a, operation::negative) ? negative(sum(operand(a, 0), b)) : simple;
    }
    case operation::product:
      return is_zero(a) ? a : is_zero(b) ? b : simplified_product(a, b);
    case operation::quotient: {
      const int simple = simplified_quotient(a, b);
      int exponent = 0;
      const bool is_power_of_2 = is_number(b) && std::frexp(value(b), &exponent) == 0.5 &&
                                 exponent > -1000 && exponent < 1000;
      return simple < 0 && is_power_of_2 ? product(number(1 / value(b)), a) : simple;
    }
    case operation::power:
      return index == 1 ? a : -1;
    case operation::sin:
      return is(a, operation::negative) ? negative(apply(operation::sin, operand(a, 0)))
             : is_zero(a)               ? a
                                        : -1;
    case operation::cos:
      return is(a, operation::negative) ? apply(operation::cos, operand(a, 0))
             : is_zero(a)               ? number(1)
                                        : -1;
    case operation::abs:
      return is(a, operation::negative) ? apply(operation::abs, operand(a, 0))
             : is(a, operation::abs)    ? a
                                        : -1;
    case operation::no:
      return is(a, operation::no) ? operand(a, 0) : -1;
    case operation::both:
    case operation::either:
      return a == b ? a : -1;
    case operation::select:
      return b == c                 ? b
             : is(a, operation::no) ? apply(operation::select, operand(a, 0), c, b)
             : is(b, operation::negative) && is(c, operation::negative)
                 ? negative(apply(operation::select, a, operand(b, 0), operand(c, 0)))
                 : -1;
    default:
      return -1;
    }
  }

  std::vector<graph_node> nodes_;
  std::vector<int> table_;
  std::vector<std::string> names_;
  std::vector<bool> has_given_derivative_; ///< by nodes; shorter if the last have none
};

} // namespace duet::expression
