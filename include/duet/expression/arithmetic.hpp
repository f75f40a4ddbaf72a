// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/partials.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual/rules/of_many.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/function.hpp>
#include <duet/expression/tree/latex_arithmetic.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/tree/printed.hpp>

#include <Eigen/Core>

#include <cmath>
#include <concepts>
#include <type_traits>

/// \file
/// Sums, products, quotients and powers. (Products of matrices are in matrix/product.hpp.)

namespace duet::expression {

namespace op {

struct negative;
struct sum;
struct difference;
struct product;
struct quotient;

} // namespace op

namespace detail {

// Values are numbers and matrices, not expression templates of Eigen. Vectors of three are computed
// by component: Eigen would use packets, which are slower to take apart.

template <class T>
[[nodiscard]] constexpr const auto& component_of(const T& x, [[maybe_unused]] int i) {
  if constexpr (EigenMatrix<T>) {
    return x.data()[i];
  } else {
    return x;
  }
}

/// f(a, b), by component if a or b is a vector or matrix.
template <class F, class A, class B>
[[nodiscard]] constexpr auto componentwise(const F& f, const A& a, const B& b) {
  if constexpr (ThreeComponents<A> || ThreeComponents<B>) {
    using S = promote_t<std::remove_cvref_t<decltype(component_of(a, 0))>,
                        std::remove_cvref_t<decltype(component_of(b, 0))>>;
    return vector3<S>(S(f(component_of(a, 0), component_of(b, 0))),
                      S(f(component_of(a, 1), component_of(b, 1))),
                      S(f(component_of(a, 2), component_of(b, 2))));
  } else if constexpr (Scalar<A> && Scalar<B>) {
    return static_cast<promote_t<A, B>>(f(a, b));
  } else if constexpr (EigenMatrix<A> || EigenMatrix<B>) {
    using S = promote_t<std::remove_cvref_t<decltype(component_of(a, 0))>,
                        std::remove_cvref_t<decltype(component_of(b, 0))>>;
    using matrix = std::conditional_t<EigenMatrix<A>, A, B>;
    Eigen::Matrix<S, matrix::RowsAtCompileTime, matrix::ColsAtCompileTime> result;
    for (int i = 0; i < int(result.size()); ++i) {
      result.data()[i] = S(f(component_of(a, i), component_of(b, i)));
    }
    return result;
  } else {
    return f(a, b);
  }
}

} // namespace detail

[[nodiscard]] constexpr auto operator-(const Term auto& a) { return apply<op::negative>(a); }
[[nodiscard]] constexpr auto operator+(const Term auto& a) { return a; }

[[nodiscard]] constexpr auto operator+(const Term auto& a, const Term auto& b) {
  return apply<op::sum>(a, b);
}
template <class A, TermAndConstant<A> B, class Tag = decltype([] {})>
[[nodiscard]] constexpr auto operator+(const A& a, const B& b) {
  return apply<op::sum>(detail::term<Tag>(a), detail::term<Tag>(b));
}
[[nodiscard]] constexpr auto operator-(const Term auto& a, const Term auto& b) {
  return apply<op::difference>(a, b);
}
template <class A, TermAndConstant<A> B, class Tag = decltype([] {})>
[[nodiscard]] constexpr auto operator-(const A& a, const B& b) {
  return apply<op::difference>(detail::term<Tag>(a), detail::term<Tag>(b));
}
[[nodiscard]] constexpr auto operator*(const Term auto& a, const Term auto& b) {
  return apply<op::product>(a, b);
}
template <class A, TermAndConstant<A> B, class Tag = decltype([] {})>
[[nodiscard]] constexpr auto operator*(const A& a, const B& b) {
  return apply<op::product>(detail::term<Tag>(a), detail::term<Tag>(b));
}
[[nodiscard]] constexpr auto operator/(const Term auto& a, const Term auto& b) {
  return apply<op::quotient>(a, b);
}
template <class A, TermAndConstant<A> B, class Tag = decltype([] {})>
[[nodiscard]] constexpr auto operator/(const A& a, const B& b) {
  return apply<op::quotient>(detail::term<Tag>(a), detail::term<Tag>(b));
}

namespace op {

struct negative : linear_operation {
  static constexpr kind kind_of(kind a) { return a; }
  static constexpr auto value(const auto& a) {
    const auto minus = [](const auto& x, const auto&) { return -x; };
    return detail::componentwise(minus, a, a);
  }
  static printed print(notation style, const printed& a) {
    if (style != notation::text) {
      return detail::latex_product_of(
          {"-1", precedence::negative_number, style, factor_order::number}, a);
    }
    return {"-" + a.inside(precedence::product), precedence::sum};
  }
};

/// a + b of one kind.
struct sum {
  static constexpr kind kind_of(kind a, kind) { return a; }
  template <kind A, kind B>
  static constexpr void require() {
    static_assert(
        A == B, "duet: a sum of formulas of different kinds or sizes, as of a scalar and a vector");
  }
  static constexpr auto value(const auto& a, const auto& b) {
    return detail::componentwise([](const auto& x, const auto& y) { return x + y; }, a, b);
  }
  static printed print(notation style, const printed& a, const printed& b) {
    if (style != notation::text) {
      return detail::latex_sum_of(a, 1, b);
    }
    return {a.inside(precedence::sum) + " + " + b.inside(precedence::sum), precedence::sum};
  }
};

/// a − b of one kind.
struct difference {
  static constexpr kind kind_of(kind a, kind) { return a; }
  template <kind A, kind B>
  static constexpr void require() {
    static_assert(A == B, "duet: a difference of formulas of different kinds or sizes, as of a "
                          "scalar and a vector");
  }
  static constexpr auto value(const auto& a, const auto& b) {
    return detail::componentwise([](const auto& x, const auto& y) { return x - y; }, a, b);
  }
  static printed print(notation style, const printed& a, const printed& b) {
    if (style != notation::text) {
      return detail::latex_sum_of(a, -1, b);
    }
    return {a.inside(precedence::sum) + " - " + b.inside(precedence::product), precedence::sum};
  }
};

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

struct log;

/// x^n for an integer n known at compile time: by products from −4 to 5, with an error of at most 4
/// units in the last place, otherwise by `pow`.
template <int Exponent>
struct whole_power {
  static_assert(Exponent >= 2 || Exponent <= -1);
  static constexpr kind kind_of(kind a) { return a; }
  template <class X>
  static constexpr X value(const X& x) {
    if constexpr (!detail::is_accurate_by_products(Exponent) &&
                  std::floating_point<real_type_t<X>> && !Infinitesimal<X>) {
      if (!std::is_constant_evaluated()) {
        using std::pow;
        return X(pow(x, X(Exponent)));
      }
    }
    return detail::power_by_products<Exponent>(x);
  }
};

/// x^p.
struct power : detail::function<power, duet::rule::pow> {
  static constexpr bool slopes_take_value = true;
  /// Powers by integers from −16 to 16 are `whole_power`.
  static constexpr auto simplified(auto x, auto p) {
    const double n = p.is_zero() ? 0 : p.entry().number;
    const bool is_whole = x.tape->is_number(p.index) && n >= -16 && n <= 16 && n == int(n);
    return x.index == 1 || p.is_zero() ? x.at(1)
           : is_whole                  ? x.at(x.tape->power(x.index, int(n)))
                                       : x.none();
  }
  template <class X, class P>
  static auto value(const X& x, const P& p) {
    using std::pow;
    return static_cast<promote_t<X, P>>(pow(x, p));
  }
  /// The slope with respect to x is that for constant p, and vice versa.
  template <int I, class Y, class X, class P>
  static Y slope_at(const Y& y, const X& x, const P& p) {
    if constexpr (I == 0 && std::is_same_v<X, Y>) {
      return duet::rule::power<P>{p}.slope(x, y);
    } else if constexpr (I == 1 && std::is_same_v<P, Y>) {
      return duet::rule::exponential<X>{x}.slope(p, y);
    } else {
      return duet::rule::pow{}.slopes(y, Y(x), Y(p))[I];
    }
  }
  template <int I, class X, class P>
  static constexpr auto symbolic_derivative(X x, P p) {
    if constexpr (I == 0) {
      return p * apply<power>(x, p - whole<1>);
    } else {
      return apply<power>(x, p) * apply<log>(x);
    }
  }
  static printed print(notation style, const printed& x, const printed& p) {
    if (style != notation::text) {
      return detail::latex_power(x, p);
    }
    return {x.inside(precedence::atom) + "^" + p.inside(precedence::atom), precedence::power};
  }
};

} // namespace op

/// x^p of scalars. Integer exponents known at compile time, such as `c<2>`, are simplified.
template <class X, class P, class Tag = decltype([](op::power*) {})>
  requires Operands<X, P> &&(!QuaternionTerm<X> && !PoseTerm<X>)
      [[nodiscard]] constexpr auto pow(const X& x, const P& p) {
    return apply<op::power>(detail::term<Tag>(x), detail::term<Tag>(p));
  }

} // namespace duet::expression
