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
/// Operators of formulas, sums and differences.

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
} // namespace duet::expression
