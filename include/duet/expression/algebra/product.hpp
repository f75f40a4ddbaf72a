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

/// Integer exponent of T as a power of X; 0 if it is not a power of X.
template <class T, class X>
inline constexpr int exponent_of = 0;
template <class X>
inline constexpr int exponent_of<X, X> = 1;
template <int N, class X>
inline constexpr int exponent_of<applied_node<op::whole_power<N>, X>, X> = N;

/// Base X of a power X^n; T itself if it is not a power.
template <class T>
struct base {
  using type = T;
};
template <int N, class X>
struct base<applied_node<op::whole_power<N>, X>> {
  using type = X;
};

template <class T>
inline constexpr bool is_inverse = false;
template <class X>
inline constexpr bool is_inverse<applied_node<op::quotient, number_node<bits_of(1)>, X>> = true;

/// True for two numbers whose product is exact in double precision.
template <class A, class B>
inline constexpr bool has_exact_product = false;
template <std::uint64_t A, std::uint64_t B>
inline constexpr bool has_exact_product<number_node<A>, number_node<B>> =
    is_product_exact(number_node<A>::value, number_node<B>::value);
/// True for a number and a product n x if the product of the numbers is exact.
template <std::uint64_t A, class B, class X>
inline constexpr bool has_exact_product<number_node<A>, applied_node<op::product, B, X>> =
    has_exact_product<number_node<A>, B>;

/// True for a product n x with an integer n from 1 to 16. Only such an n is moved in front of other
/// factors, as a larger one could make a product overflow.
template <class T>
inline constexpr bool has_small_number = false;
template <std::uint64_t Bits, class X>
inline constexpr bool has_small_number<applied_node<op::product, number_node<Bits>, X>> =
    number_node<Bits>::value >= 1 && number_node<Bits>::value <= 16 &&
    number_node<Bits>::value == int(number_node<Bits>::value);
/// A product with such a number, or with any number before what is not a scalar.
template <class T>
inline constexpr bool has_leading_number = has_small_number<T> ||
                                           (has_number<T> && T::kind_of != kind::scalar);

/// True if a/b is exact in double precision.
[[nodiscard]] constexpr bool is_quotient_exact(double a, double b) {
  const double ratio = b == 0 ? 0 : a / b;
  return b != 0 && ratio * b == a && is_product_exact(ratio, b);
}

/// True for a number, a product with one, or a sum of such, whose numbers have exact quotients by
/// Divisor.
template <class T, class Divisor>
inline constexpr bool is_divided_exactly = false;
template <std::uint64_t A, std::uint64_t B>
inline constexpr bool is_divided_exactly<number_node<A>, number_node<B>> =
    is_quotient_exact(number_node<A>::value, number_node<B>::value);
template <std::uint64_t Bits, class B, class Divisor>
inline constexpr bool is_divided_exactly<applied_node<op::product, number_node<Bits>, B>, Divisor> =
    is_divided_exactly<number_node<Bits>, Divisor>;
template <class A, class B, class Divisor>
inline constexpr bool is_divided_exactly<applied_node<op::sum, A, B>, Divisor> =
    is_divided_exactly<A, Divisor>&& is_divided_exactly<B, Divisor>;
template <class A, class B, class Divisor>
inline constexpr bool is_divided_exactly<applied_node<op::difference, A, B>, Divisor> =
    is_divided_exactly<A, Divisor>&& is_divided_exactly<B, Divisor>;

[[nodiscard]] constexpr bool is_product_of_kinds(kind a, kind b) {
  return a == kind::scalar || b == kind::scalar ||
         (a == b && (a == kind::quaternion || a == kind::pose)) ||
         (is_matrix(a) && is_matrix(b) && (a != b || a != kind::vector));
}

} // namespace detail

namespace op {

/// a b; a scalar comes first, a number before other scalars.
struct product {
  static constexpr kind kind_of(kind a, kind b) { return a == kind::scalar ? b : a; }
  template <class A, class B>
  static constexpr auto simplified(A a, B b) {
    static_assert(detail::is_product_of_kinds(A::kind_of, B::kind_of),
                  "duet: a product is of scalars, of a scalar and anything, of two matrices, two "
                  "quaternions or two poses; vectors have dot and cross, rotations rotate(q, v)");
    using base_of_a = typename detail::base<A>::type;
    using base_of_b = typename detail::base<B>::type;
    if constexpr (is_matrix(A::kind_of) && is_matrix(B::kind_of)) {
      return apply<matrix_product>(a, b);
    } else if constexpr (is_zero<A> || is_zero<B>) {
      return zero_of<kind_of(A::kind_of, B::kind_of)>();
    } else if constexpr (is_one<A>) {
      return b;
    } else if constexpr (is_one<B>) {
      return a;
    } else if constexpr (is_number<B> && detail::has_exact_product<A, B>) {
      return number_node<detail::bits_of(A::value * B::value)>{};
    } else if constexpr (B::kind_of == kind::scalar &&
                         (A::kind_of != kind::scalar || (is_number<B> && !is_number<A>))) {
      return b * a;
    } else if constexpr (is_whole<A, -1>) {
      return -b;
    } else if constexpr (is_applied<A, negative>) {
      return -(operand<0>(a) * b);
    } else if constexpr (is_applied<B, negative>) {
      return -(a * operand<0>(b));
    } else if constexpr (detail::is_embedded_block<B>) {
      return detail::embedded_like(b, a * operand<0>(b));
    } else if constexpr (detail::has_exact_product<A, B>) {
      return (a * operand<0>(b)) * operand<1>(b);
    } else if constexpr (is_number<A>) {
      return;
    } else if constexpr (detail::has_leading_number<A>) {
      return operand<0>(a) * (operand<1>(a) * b);
    } else if constexpr (detail::has_leading_number<B>) {
      return operand<0>(b) * (a * operand<1>(b));
    } else if constexpr (detail::is_inverse<A>) {
      return b / operand<1>(a);
    } else if constexpr (detail::is_inverse<B>) {
      return a / operand<1>(b);
    } else if constexpr (A::kind_of == kind::scalar && std::is_same_v<base_of_a, base_of_b> &&
                         detail::exponent_of<A, base_of_a> > 0 &&
                         detail::exponent_of<B, base_of_b> > 0) {
      constexpr int n = detail::exponent_of<A, base_of_a> + detail::exponent_of<B, base_of_b>;
      return applied_node<whole_power<n>, base_of_a>{};
    }
  }
  static constexpr auto value(const auto& a, const auto& b) {
    return detail::componentwise([](const auto& x, const auto& y) { return x * y; }, a, b);
  }
  static constexpr auto differential(auto a, auto b, auto da, auto db) { return da * b + a * db; }
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
  static constexpr auto simplified(A a, B b) {
    if constexpr (is_number<A> || is_number<B>) {
      return a * b;
    } else if constexpr (is_applied<A, negative>) {
      return -apply<slope_product>(operand<0>(a), b);
    } else if constexpr (is_applied<B, negative>) {
      return -apply<slope_product>(a, operand<0>(b));
    } else if constexpr (detail::has_small_number<A>) {
      return operand<0>(a) * apply<slope_product>(operand<1>(a), b);
    } else if constexpr (detail::has_small_number<B>) {
      return operand<0>(b) * apply<slope_product>(a, operand<1>(b));
    }
  }
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
  template <class A, class B>
  static constexpr auto simplified(A a, B b) {
    static_assert(B::kind_of == kind::scalar,
                  "duet: formulas are divided by scalars; for rotations and poses there is conj");
    if constexpr (is_zero<A> || is_one<B>) {
      return a;
    } else if constexpr (is_number<A> && detail::is_divided_exactly<A, B>) {
      return number_node<detail::bits_of(A::value / B::value)>{};
    } else if constexpr (detail::is_embedded_block<A>) {
      return detail::embedded_like(a, operand<0>(a) / b);
    } else if constexpr (detail::starts_with_minus<A>) {
      return -(-a / b);
    } else if constexpr (detail::starts_with_minus<B>) {
      return -(a / -b);
    } else if constexpr (!detail::is_divided_exactly<A, B>) {
      return;
    } else if constexpr (is_applied<A, sum>) {
      // (4 x + 2)/2 becomes 2 x + 1, as in derivatives of polynomials with a divisor.
      return operand<0>(a) / b + operand<1>(a) / b;
    } else if constexpr (is_applied<A, difference>) {
      return operand<0>(a) / b - operand<1>(a) / b;
    } else {
      return (operand<0>(a) / b) * operand<1>(a);
    }
  }
  static constexpr auto value(const auto& a, const auto& b) {
    return detail::componentwise([](const auto& x, const auto& y) { return x / y; }, a, b);
  }
  static constexpr auto differential(auto a, auto b, auto da, auto db) {
    return (da - db * (a / b)) / b;
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

namespace duet::expression::detail {

/// True for −M, s M and M/s.
template <class T>
inline constexpr bool is_scaled =
    is_applied<T, op::negative> || is_applied<T, op::product> || is_applied<T, op::quotient>;
/// f of a scaled M for a linear f, with the scale outside: f(−M) = −f(M), f(s M) = s f(M).
template <class M>
[[nodiscard]] constexpr auto scaled_outside(applied_node<op::negative, M>, auto f) {
  return -f(M{});
}
template <class S, class M>
[[nodiscard]] constexpr auto scaled_outside(applied_node<op::product, S, M>, auto f) {
  return S{} * f(M{});
}
template <class M, class S>
[[nodiscard]] constexpr auto scaled_outside(applied_node<op::quotient, M, S>, auto f) {
  return f(M{}) / S{};
}

/// The scalar a if V has the form a W, otherwise 0.
template <class V, class W>
[[nodiscard]] constexpr auto factor_of(V v, W) {
  if constexpr (std::is_same_v<V, W>) {
    return whole<1>;
  } else if constexpr (is_scaled<V>) {
    return scaled_outside(v, [](auto x) { return factor_of(x, W{}); });
  } else {
    return whole<0>;
  }
}
/// The vector W of a scaled vector V = a W.
template <class V>
struct direction {
  using type = V;
};

template <class A, class B>
struct direction<applied_node<op::product, A, B>> : direction<B> {};
template <class A, class B>
struct direction<applied_node<op::quotient, A, B>> : direction<A> {};
template <class A>
struct direction<applied_node<op::negative, A>> : direction<A> {};
template <class V>
using direction_t = typename direction<V>::type;

/// The rate ȧ if V = a W moves by dV = ȧ W, otherwise 0.
template <class V, class DV>
using rate_along = decltype(factor_of(DV{}, direction_t<V>{}));

} // namespace duet::expression::detail
