// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/partials.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/expression/algebra/arithmetic.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/latex_arithmetic.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/tree/printed.hpp>

#include <cstdint>
#include <string>
#include <type_traits>

/// \file
/// Products of scalars, quaternions and poses, scaling, and quotients. (Products of matrices are in
/// matrix/product.hpp.)

namespace duet::expression {

namespace op {

template <int Exponent>
struct whole_power;
struct matrix_product;

} // namespace op

namespace detail {

[[nodiscard]] constexpr bool is_product_of_kinds(kind a, kind b) {
  return a == kind::scalar || b == kind::scalar ||
         (a == b && (a == kind::quaternion || a == kind::pose)) ||
         (is_matrix(a) && is_matrix(b) && (a != b || a != kind::vector));
}

} // namespace detail

namespace op {

/// a b; a scalar comes first, a number before other scalars.
struct product {
  static constexpr kind kind_of(kind a, kind b) {
    return is_matrix(a) && is_matrix(b) ? matrix_kind(rows_of(a), columns_of(b))
           : a == kind::scalar          ? b
                                        : a;
  }
  template <kind A, kind B>
  static constexpr void require() {
    static_assert(detail::is_product_of_kinds(A, B),
                  "duet: a product is of scalars, of a scalar and anything, of two matrices, two "
                  "quaternions or two poses; vectors have dot and cross, rotations rotate(q, v)");
    static_assert(!is_matrix(A) || !is_matrix(B) || columns_of(A) == rows_of(B),
                  "duet: a product of matrices of sizes that do not fit: the first must have as "
                  "many columns as the second has rows");
  }
  static constexpr auto value(const auto& a, const auto& b) {
    return detail::componentwise([](const auto& x, const auto& y) { return x * y; }, a, b);
  }
  static printed print(notation style, const printed& a, const printed& b) {
    if (style != notation::text) {
      return detail::latex_product_of(a, b);
    }
    return {a.inside(precedence::negative_number) + " * " + b.inside(precedence::product),
            precedence::product};
  }
};

/// Slope of a function times the rate of its argument; 0 if the rate is exactly 0, even if the
/// slope is infinite, as for √(x²) at 0. Dual numbers follow the same rule.
struct slope_product : bilinear_operation {
  static constexpr kind kind_of(kind, kind) { return kind::scalar; }
  template <class A, class B>
  static constexpr auto value(const A& a, const B& b) {
    using S = promote_t<A, B>;
    return duet::detail::zero_preserving_product(S(a), S(b));
  }
  static printed print(notation style, const printed& a, const printed& b) {
    return product::print(style, a, b);
  }
};

/// a/b for a scalar b.
struct quotient {
  static constexpr kind kind_of(kind a, kind) { return a; }
  template <kind, kind B>
  static constexpr void require() {
    static_assert(B == kind::scalar,
                  "duet: formulas are divided by scalars; for rotations and poses there is conj");
  }
  static constexpr auto value(const auto& a, const auto& b) {
    return detail::componentwise([](const auto& x, const auto& y) { return x / y; }, a, b);
  }
  static printed print(notation style, const printed& a, const printed& b) {
    if (style != notation::text) {
      return detail::latex_product_of(a, b, -1);
    }
    return {a.inside(precedence::product) + " / " + b.inside(precedence::power),
            precedence::product};
  }
};

} // namespace op
} // namespace duet::expression
