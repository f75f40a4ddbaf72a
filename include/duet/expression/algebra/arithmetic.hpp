// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/latex_arithmetic.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/tree/printed.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <type_traits>

/// \file
/// Sums, products and quotients. Simplifications hold for all finite numbers: those of 0, 1 and
/// signs, and exact arithmetic of numbers known at compile time.

namespace duet::expression {

namespace op {

struct negative;
struct sum;
struct difference;
struct product;
struct quotient;
template <int Rows, int Columns, int I, int J>
struct embedded_block;

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

/// True if T is a matrix of zeros with a block X.
template <class T>
inline constexpr bool is_embedded_block = false;
template <int Rows, int Columns, int I, int J, class X>
inline constexpr bool is_embedded_block<applied_node<op::embedded_block<Rows, Columns, I, J>, X>> =
    true;
/// The matrix of zeros with a block y at the position of X.
template <int Rows, int Columns, int I, int J, class X, class Y>
[[nodiscard]] constexpr auto embedded_like(applied_node<op::embedded_block<Rows, Columns, I, J>, X>,
                                           Y y) {
  return apply<op::embedded_block<Rows, Columns, I, J>>(y);
}

/// True for a negative number, a product with one, and a negated term.
template <class T>
inline constexpr bool starts_with_minus = is_applied<T, op::negative>;
template <std::uint64_t Bits>
inline constexpr bool starts_with_minus<number_node<Bits>> = number_node<Bits>::value < 0;
template <class A, class B>
inline constexpr bool starts_with_minus<applied_node<op::product, A, B>> =
    is_number<A>&& starts_with_minus<A>;

/// True for two numbers whose sum is exact in double precision.
template <class A, class B>
inline constexpr bool has_exact_sum = false;
template <std::uint64_t A, std::uint64_t B>
inline constexpr bool has_exact_sum<number_node<A>, number_node<B>> =
    is_sum_exact(number_node<A>::value, number_node<B>::value);

/// True if T is the operation applied to a number or constant and U, such as 2 − u.
template <class T, class Operation, class U>
inline constexpr bool is_of_number_and = false;
template <class Operation, std::uint64_t Bits, class U>
inline constexpr bool
    is_of_number_and<applied_node<Operation, number_node<Bits>, U>, Operation, U> = true;
template <class Operation, class Tag, class U>
inline constexpr bool
    is_of_number_and<applied_node<Operation, constant_node<kind::scalar, Tag>, U>, Operation, U> =
        true;

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

/// True for a product whose first factor is a number. For those who extend duet.
template <class T>
inline constexpr bool has_number = false;
template <class A, class B>
inline constexpr bool has_number<applied_node<op::product, A, B>> = is_number<A>;

namespace op {

struct negative : linear_operation {
  static constexpr kind kind_of(kind a) { return a; }
  template <class A>
  static constexpr auto simplified(A a) {
    if constexpr (is_number<A>) {
      return number_node<detail::bits_of(-A::value)>{};
    } else if constexpr (is_applied<A, negative>) {
      return operand<0>(a);
    } else if constexpr (is_applied<A, difference>) {
      return operand<1>(a) - operand<0>(a);
    } else if constexpr (has_number<A>) {
      return -operand<0>(a) * operand<1>(a);
    } else if constexpr (detail::is_embedded_block<A>) {
      return detail::embedded_like(a, -operand<0>(a));
    }
  }
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
  template <class A, class B>
  static constexpr auto simplified(A a, B b) {
    static_assert(
        A::kind_of == B::kind_of,
        "duet: a sum of formulas of different kinds or sizes, as of a scalar and a vector");
    if constexpr (is_zero<A>) {
      return b;
    } else if constexpr (is_zero<B>) {
      return a;
    } else if constexpr (detail::has_exact_sum<A, B>) {
      return number_node<detail::bits_of(A::value + B::value)>{};
    } else if constexpr (std::is_same_v<A, B>) {
      return whole<2> * a;
    } else if constexpr (detail::is_of_number_and<A, sum, B>) {
      return operand<0>(a) + whole<2> * b; // doubling is exact
    } else if constexpr (detail::is_of_number_and<B, sum, A>) {
      return operand<0>(b) + whole<2> * a;
    } else if constexpr (detail::starts_with_minus<B>) {
      return a - -b;
    } else if constexpr (is_applied<A, negative>) {
      return b - -a;
    }
  }
  static constexpr auto differential(auto, auto, auto da, auto db) { return da + db; }
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
  template <class A, class B>
  static constexpr auto simplified(A a, B b) {
    static_assert(A::kind_of == B::kind_of,
                  "duet: a difference of formulas of different kinds or sizes, as of a scalar and "
                  "a vector");
    if constexpr (is_zero<A>) {
      return -b;
    } else if constexpr (is_zero<B>) {
      return a;
    } else if constexpr (detail::has_exact_sum<A, decltype(-b)>) {
      return a + -b;
    } else if constexpr (std::is_same_v<A, B>) {
      return zero_of<A::kind_of>();
    } else if constexpr (detail::is_of_number_and<A, difference, B>) {
      return operand<0>(a) - whole<2> * b;
    } else if constexpr (detail::starts_with_minus<B>) {
      return a + -b;
    }
  }
  static constexpr auto differential(auto, auto, auto da, auto db) { return da - db; }
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
} // namespace duet::expression
