// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/expression/tree/exact.hpp>

/// \file
/// Exact simplifications, the same for typed formulas (tape) and formulas that are data (graph).

namespace duet::expression::detail {

/// Rules for terms that are zero, factors that are one, signs, and arithmetic of numbers without
/// rounding. All are exact for finite numbers and keep the written order. Nodes are indices.
///
/// \tparam Nodes  the derived tape or graph, with the members `negative`, `sum`, `difference`,
/// `product` and `quotient`, which apply the rules, and `code`, `operand`, `is_number`, `is_zero`,
/// `value` and `number`
/// \tparam Code   enumeration of operations, with `negative` and `product`
template <class Nodes, class Code>
class exact_rules {
protected:
  // Each returns a simpler node, or −1 if no rule applies.

  [[nodiscard]] constexpr int simplified_negative(int a) {
    return nodes().is_zero(a)     ? a
           : nodes().is_number(a) ? nodes().number(-nodes().value(a))
           : is_negative(a)       ? nodes().operand(a, 0)
                                  : -1;
  }
  [[nodiscard]] constexpr int simplified_sum(int a, int b) {
    if (nodes().is_zero(a) || nodes().is_zero(b)) {
      return nodes().is_zero(a) ? b : a;
    }
    if (are_numbers(a, b) && is_sum_exact(nodes().value(a), nodes().value(b))) {
      return nodes().number(nodes().value(a) + nodes().value(b));
    }
    if (starts_with_minus(b)) {
      return nodes().difference(a, nodes().negative(b));
    }
    if (is_negative(a)) {
      return nodes().difference(b, nodes().operand(a, 0));
    }
    return a == b ? nodes().product(nodes().number(2), a) : -1;
  }
  [[nodiscard]] constexpr int simplified_difference(int a, int b) {
    if (nodes().is_zero(a) || nodes().is_zero(b)) {
      return nodes().is_zero(b) ? a : nodes().negative(b);
    }
    if (are_numbers(a, b) && is_sum_exact(nodes().value(a), -nodes().value(b))) {
      return nodes().number(nodes().value(a) - nodes().value(b));
    }
    return starts_with_minus(b) ? nodes().sum(a, nodes().negative(b)) : -1;
  }
  /// A product of factors that are not 0, of which the first one is a scalar.
  [[nodiscard]] constexpr int simplified_product(int a, int b) {
    if (is_one(a) || is_one(b)) {
      return is_one(a) ? b : a;
    }
    if (nodes().is_number(b) && !nodes().is_number(a)) {
      return nodes().product(b, a);
    }
    if (are_numbers(a, b) && is_product_exact(nodes().value(a), nodes().value(b))) {
      return nodes().number(nodes().value(a) * nodes().value(b));
    }
    if (starts_with_minus(a)) {
      return nodes().negative(nodes().product(nodes().negative(a), b));
    }
    if (starts_with_minus(b)) {
      return nodes().negative(nodes().product(a, nodes().negative(b)));
    }
    if (nodes().is_number(a) && nodes().code(b) == Code::product) {
      const int n = nodes().operand(b, 0);
      if (nodes().is_number(n) && is_product_exact(nodes().value(a), nodes().value(n))) {
        return nodes().product(nodes().product(a, n), nodes().operand(b, 1));
      }
    }
    return -1;
  }
  [[nodiscard]] constexpr int simplified_quotient(int a, int b) {
    if (is_one(b) || (nodes().is_zero(a) && !nodes().is_zero(b))) {
      return a;
    }
    if (are_numbers(a, b) && is_quotient_exact(nodes().value(a), nodes().value(b))) {
      return nodes().number(nodes().value(a) / nodes().value(b));
    }
    if (starts_with_minus(a)) {
      return nodes().negative(nodes().quotient(nodes().negative(a), b));
    }
    return starts_with_minus(b) ? nodes().negative(nodes().quotient(a, nodes().negative(b))) : -1;
  }

private:
  [[nodiscard]] constexpr Nodes& nodes() { return static_cast<Nodes&>(*this); }
  [[nodiscard]] constexpr bool is_negative(int i) { return nodes().code(i) == Code::negative; }
  [[nodiscard]] constexpr bool is_one(int i) {
    return nodes().is_number(i) && nodes().value(i) == 1;
  }
  [[nodiscard]] constexpr bool are_numbers(int a, int b) {
    return nodes().is_number(a) && nodes().is_number(b);
  }
  [[nodiscard]] constexpr bool starts_with_minus(int i) {
    return is_negative(i) || (nodes().is_number(i) && nodes().value(i) < 0);
  }
};

} // namespace duet::expression::detail
