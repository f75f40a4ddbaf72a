// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/types.hpp>

#include <cstdint>

/// \file
/// Numbers known at compile time: their bits, and whether their sums, products and quotients are
/// exact; and simplifications that are.

namespace duet::expression::detail {

/// True if a + b is exact in double precision (two-sum, Knuth).
[[nodiscard]] constexpr bool is_sum_exact(double a, double b) {
  const double sum = a + b;
  const double b_rounded = sum - a;
  return (a - (sum - b_rounded)) + (b - b_rounded) == 0;
}

/// True if a b is exact in double precision (Veltkamp–Dekker product); false for products so small
/// that digits of their error vanish.
[[nodiscard]] constexpr bool is_product_exact(double a, double b) {
  if (a * b < 0x1p-960 && a * b > -0x1p-960) {
    return a == 0 || b == 0;
  }
  const auto upper = [](double x) {
    const double scaled = x * 0x8000001p0;
    return scaled - (scaled - x);
  };
  const double a_high = upper(a), b_high = upper(b);
  const double a_low = a - a_high, b_low = b - b_high;
  return ((a_high * b_high - a * b) + a_high * b_low + a_low * b_high) + a_low * b_low == 0;
}

/// True if a/b is exact in double precision.
[[nodiscard]] constexpr bool is_quotient_exact(double a, double b) {
  const double ratio = b == 0 ? 0 : a / b;
  return b != 0 && ratio * b == a && is_product_exact(ratio, b);
}

[[nodiscard]] constexpr std::uint64_t bits_of(double x) {
  return duet::detail::bit_cast<std::uint64_t>(x == 0 ? 0.0 : x);
}

/// Simplifications of scalars, and of what they scale, that are exact for all finite numbers and
/// keep the written order: of terms 0, factors 1 and signs, and arithmetic of numbers without
/// rounding. The tape and the graph derive from it; in both, nodes are indices.
///
/// \tparam Nodes  applies the rules in its `negative`, `sum`, `difference`, `product` and
/// `quotient`; has also `code`, `operand`, `is_number`, `is_zero`, `value` and `number`
template <class Nodes, class Code>
class exact_rules {
protected:
  // Each gives a simpler node, or −1 without.

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
