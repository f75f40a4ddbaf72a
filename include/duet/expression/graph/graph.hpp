// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/types.hpp>
#include <duet/core/errors.hpp>
#include <duet/expression/tree/number.hpp>

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
class graph {
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
        return commutes(what) ? found : negated(found);
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

  /// The number as a node: `number` is an operation in these functions.
  [[nodiscard]] int value_of(double x) { return number(x); }
  [[nodiscard]] int negated(int i) { return apply(operation::negative, i); }
  /// A simpler node of the same value, or −1.
  [[nodiscard]] int simplified(operation what, int a, int b, int c, int index) {
    using enum operation;
    switch (what) {
    case negative: {
      const graph_node x = (*this)[a];
      if (x.what == number) {
        return value_of(-x.number);
      }
      return x.what == negative ? x.operands[0] : -1;
    }
    case sum:
      return simplified_sum(a, b);
    case difference:
      if (is_number(b, 0)) {
        return a;
      }
      if (is_number(a, 0)) {
        return negated(b);
      }
      if (is(b, negative)) {
        return apply(sum, a, (*this)[b].operands[0]);
      }
      if (is(a, negative)) {
        return negated(apply(sum, (*this)[a].operands[0], b));
      }
      if (is_number(b) && (*this)[b].number < 0) {
        return apply(sum, a, value_of(-(*this)[b].number));
      }
      if (is_number(a) && is_number(b) &&
          detail::is_sum_exact((*this)[a].number, -(*this)[b].number)) {
        return value_of((*this)[a].number - (*this)[b].number);
      }
      return -1;
    case product:
      return simplified_product(a, b);
    case quotient:
      return simplified_quotient(a, b);
    case power:
      return index == 1 ? a : -1;
    case sin:
      return is(a, negative)   ? negated(apply(sin, (*this)[a].operands[0]))
             : is_number(a, 0) ? a
                               : -1;
    case cos:
      return is(a, negative)   ? apply(cos, (*this)[a].operands[0])
             : is_number(a, 0) ? value_of(1)
                               : -1;
    case abs:
      return is(a, negative) ? apply(abs, (*this)[a].operands[0]) : is(a, abs) ? a : -1;
    case no:
      return is(a, no) ? (*this)[a].operands[0] : -1;
    case both:
    case either:
      return a == b ? a : -1;
    case select:
      return b == c      ? b
             : is(a, no) ? apply(select, (*this)[a].operands[0], c, b)
             : is(b, negative) && is(c, negative)
                 ? negated(apply(select, a, (*this)[b].operands[0], (*this)[c].operands[0]))
                 : -1;
    default:
      return -1;
    }
  }
  [[nodiscard]] int simplified_sum(int a, int b) {
    if (is_number(a, 0)) {
      return b;
    }
    if (is_number(b, 0)) {
      return a;
    }
    if (is(b, operation::negative)) {
      return apply(operation::difference, a, (*this)[b].operands[0]);
    }
    if (is(a, operation::negative)) {
      return apply(operation::difference, b, (*this)[a].operands[0]);
    }
    if (is_number(a) && is_number(b) &&
        detail::is_sum_exact((*this)[a].number, (*this)[b].number)) {
      return number((*this)[a].number + (*this)[b].number);
    }
    if (is_number(b) && (*this)[b].number < 0) {
      return apply(operation::difference, a, number(-(*this)[b].number));
    }
    return a == b ? apply(operation::product, value_of(2), a) : -1;
  }
  [[nodiscard]] int simplified_product(int a, int b) {
    if (is_number(b) && !is_number(a)) {
      return apply(operation::product, b, a);
    }
    if (is(b, operation::negative)) {
      return negated(apply(operation::product, a, (*this)[b].operands[0]));
    }
    if (is(a, operation::negative)) {
      return negated(apply(operation::product, (*this)[a].operands[0], b));
    }
    if (!is_number(a)) {
      return -1;
    }
    const double factor = (*this)[a].number;
    if (factor == 0 || factor == 1 || factor == -1) {
      return factor == 0 ? a : factor == 1 ? b : negated(b);
    }
    if (is_number(b)) {
      const double second = (*this)[b].number;
      if (detail::is_product_exact(factor, second)) {
        return value_of(factor * second);
      }
      if (factor < 0 || second < 0) {
        const int sizes =
            apply(operation::product, value_of(std::abs(factor)), value_of(std::abs(second)));
        return (factor < 0) != (second < 0) ? negated(sizes) : sizes;
      }
      return -1;
    }
    if (factor < 0) {
      return negated(apply(operation::product, value_of(-factor), b));
    }
    const graph_node second = (*this)[b];
    if (second.what == operation::product && is_number(second.operands[0]) &&
        detail::is_product_exact(factor, (*this)[second.operands[0]].number)) {
      return apply(operation::product, value_of(factor * (*this)[second.operands[0]].number),
                   second.operands[1]);
    }
    return -1;
  }
  [[nodiscard]] int simplified_quotient(int a, int b) {
    if (is(a, operation::negative)) {
      return negated(apply(operation::quotient, (*this)[a].operands[0], b));
    }
    if (is(b, operation::negative)) {
      return negated(apply(operation::quotient, a, (*this)[b].operands[0]));
    }
    if (is_number(a, 0) && !is_number(b, 0)) {
      return a;
    }
    if (is_number(a) && (*this)[a].number < 0) {
      return negated(apply(operation::quotient, value_of(-(*this)[a].number), b));
    }
    if (!is_number(b)) {
      return -1;
    }
    const double divisor = (*this)[b].number;
    if (divisor == 1 || divisor == -1) {
      return divisor == 1 ? a : negated(a);
    }
    int exponent = 0;
    const double fraction = std::frexp(divisor, &exponent);
    if ((fraction == 0.5 || fraction == -0.5) && exponent > -1000 && exponent < 1000) {
      return apply(operation::product, value_of(1 / divisor), a); // a power of 2
    }
    if (is_number(a)) {
      const double ratio = (*this)[a].number / divisor;
      if (divisor != 0 && ratio * divisor == (*this)[a].number &&
          detail::is_product_exact(ratio, divisor)) {
        return value_of(ratio);
      }
    }
    return -1;
  }

  std::vector<graph_node> nodes_;
  std::vector<int> table_;
  std::vector<std::string> names_;
  std::vector<bool> has_given_derivative_; ///< by nodes; shorter if the last have none
};

} // namespace duet::expression
