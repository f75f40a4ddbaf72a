// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/tree/printed.hpp>

#include <Eigen/Core>

#include <concepts>
#include <type_traits>

/// \file
/// Sums, products and quotients, with what is always right for finite numbers: 0, 1, signs, and
/// exact arithmetic of numbers that the compiler knows.

namespace duet::expression {

namespace op {

template <int Rows, int Columns, int I, int J>
struct placed;

} // namespace op

namespace detail {

// Results are held in numbers and vectors of their own, no expression templates. Of vectors this is
// done by component: Eigen would put three together in packets, which are slower to take apart.

/// A matrix of Eigen, among the values of formulas.
template <class T>
concept EigenMatrix = requires {
  T::SizeAtCompileTime;
};

template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr const auto& component_of(const T& x,
                                                                    [[maybe_unused]] int i) {
  if constexpr (EigenMatrix<T>) {
    return x.data()[i];
  } else {
    return x;
  }
}

/// f(a), by component of a vector.
template <class F, class A>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr A componentwise(const F& f, const A& a) {
  if constexpr (ThreeComponents<A>) {
    return A(f(a[0]), f(a[1]), f(a[2]));
  } else {
    return A(f(a));
  }
}
/// f(a, b), by component of vectors and matrices.
template <class F, class A, class B>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto componentwise(const F& f, const A& a, const B& b) {
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

/// A matrix that is 0 but for a block.
template <class T>
inline constexpr bool is_placed = false;
template <int Rows, int Columns, int I, int J, class X>
inline constexpr bool is_placed<applied_node<op::placed<Rows, Columns, I, J>, X>> = true;
/// Another block in the same place.
template <int Rows, int Columns, int I, int J, class X, class Y>
[[nodiscard]] constexpr auto placed_like(applied_node<op::placed<Rows, Columns, I, J>, X>, Y y) {
  return apply<op::placed<Rows, Columns, I, J>>(y);
}

/// A number below zero, or a product with one.
template <class T>
[[nodiscard]] constexpr bool starts_with_minus();

} // namespace detail

namespace op {

struct negative;
struct sum;
struct difference;
struct product;
struct quotient;

} // namespace op

template <Term A>
[[nodiscard]] constexpr auto operator-(const A& a) {
  return apply<op::negative>(a);
}
template <Term A>
[[nodiscard]] constexpr A operator+(const A& a) {
  return a;
}

template <Term A, Term B>
[[nodiscard]] constexpr auto operator+(const A& a, const B& b) {
  return apply<op::sum>(a, b);
}
template <class A, class B, class Tag = decltype([] {})>
  requires TermAndConstant<A, B>
[[nodiscard]] constexpr auto operator+(const A& a, const B& b) {
  return apply<op::sum>(detail::term<Tag>(a), detail::term<Tag>(b));
}
template <Term A, Term B>
[[nodiscard]] constexpr auto operator-(const A& a, const B& b) {
  return apply<op::difference>(a, b);
}
template <class A, class B, class Tag = decltype([] {})>
  requires TermAndConstant<A, B>
[[nodiscard]] constexpr auto operator-(const A& a, const B& b) {
  return apply<op::difference>(detail::term<Tag>(a), detail::term<Tag>(b));
}
template <Term A, Term B>
[[nodiscard]] constexpr auto operator*(const A& a, const B& b) {
  return apply<op::product>(a, b);
}
template <class A, class B, class Tag = decltype([] {})>
  requires TermAndConstant<A, B>
[[nodiscard]] constexpr auto operator*(const A& a, const B& b) {
  return apply<op::product>(detail::term<Tag>(a), detail::term<Tag>(b));
}
template <Term A, Term B>
[[nodiscard]] constexpr auto operator/(const A& a, const B& b) {
  return apply<op::quotient>(a, b);
}
template <class A, class B, class Tag = decltype([] {})>
  requires TermAndConstant<A, B>
[[nodiscard]] constexpr auto operator/(const A& a, const B& b) {
  return apply<op::quotient>(detail::term<Tag>(a), detail::term<Tag>(b));
}

/// Whether a product has the number a as its first factor.
template <class T>
inline constexpr bool has_number = false;
template <class A, class B>
inline constexpr bool has_number<applied_node<op::product, A, B>> = is_number<A>;

template <class T>
[[nodiscard]] constexpr bool detail::starts_with_minus() {
  if constexpr (is_number<T>) {
    return T::value < 0;
  } else if constexpr (has_number<T>) {
    return decltype(operand<0>(T{}))::value < 0;
  } else {
    return is_applied<T, op::negative>;
  }
}

namespace op {

struct negative {
  static constexpr kind kind_of(kind a) { return a; }
  template <class A>
  static constexpr auto simplified(A a) {
    if constexpr (is_zero<A>) {
      return a;
    } else if constexpr (is_number<A>) {
      return number_node<detail::bits_of(-A::value)>{};
    } else if constexpr (is_applied<A, negative>) {
      return operand<0>(a);
    } else if constexpr (is_applied<A, difference>) {
      return operand<1>(a) - operand<0>(a);
    } else if constexpr (has_number<A>) {
      return -operand<0>(a) * operand<1>(a);
    } else if constexpr (detail::is_placed<A>) {
      return detail::placed_like(a, -operand<0>(a));
    } else {
      return applied_node<negative, A>{};
    }
  }
  template <class A>
  DUET_ALWAYS_INLINE static constexpr auto value(const A& a) {
    return detail::componentwise([](const auto& x) DUET_INLINE_LAMBDA { return -x; }, a);
  }
  template <class A, class DA>
  static constexpr auto differential(A, DA da) {
    return -da;
  }
  static printed print(notation, const printed& a) {
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
    } else if constexpr (is_number<A> && is_number<B>) {
      if constexpr (detail::is_sum_exact(A::value, B::value)) {
        return number_node<detail::bits_of(A::value + B::value)>{};
      } else {
        return applied_node<sum, A, B>{};
      }
    } else if constexpr (std::is_same_v<A, B>) {
      return whole<2> * a;
    } else if constexpr (detail::starts_with_minus<B>()) {
      return a - -b;
    } else if constexpr (is_applied<A, negative>) {
      return b - -a;
    } else {
      return applied_node<sum, A, B>{};
    }
  }
  template <class A, class B>
  DUET_ALWAYS_INLINE static constexpr auto value(const A& a, const B& b) {
    return detail::componentwise(
        [](const auto& x, const auto& y) DUET_INLINE_LAMBDA { return x + y; }, a, b);
  }
  template <class A, class B, class DA, class DB>
  static constexpr auto differential(A, B, DA da, DB db) {
    return da + db;
  }
  static printed print(notation, const printed& a, const printed& b) {
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
    } else if constexpr (is_number<A> && is_number<B>) {
      if constexpr (detail::is_sum_exact(A::value, -B::value)) {
        return number_node<detail::bits_of(A::value - B::value)>{};
      } else {
        return applied_node<difference, A, B>{};
      }
    } else if constexpr (std::is_same_v<A, B>) {
      return zero_of<A::kind_of>();
    } else if constexpr (detail::starts_with_minus<B>()) {
      return a + -b;
    } else {
      return applied_node<difference, A, B>{};
    }
  }
  template <class A, class B>
  DUET_ALWAYS_INLINE static constexpr auto value(const A& a, const B& b) {
    return detail::componentwise(
        [](const auto& x, const auto& y) DUET_INLINE_LAMBDA { return x - y; }, a, b);
  }
  template <class A, class B, class DA, class DB>
  static constexpr auto differential(A, B, DA da, DB db) {
    return da - db;
  }
  static printed print(notation, const printed& a, const printed& b) {
    return {a.inside(precedence::sum) + " - " + b.inside(precedence::product), precedence::sum};
  }
};

} // namespace op
} // namespace duet::expression
