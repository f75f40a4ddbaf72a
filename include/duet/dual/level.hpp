// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual/partials.hpp>
#include <duet/dual/promotion.hpp>

#include <concepts>
#include <type_traits>

/// \file
/// Interface, operators and parts of infinitesimal numbers. `dual`, `taylor` and
/// `second_order_dual` implement the interface, in one header each; functions, rotations, matrices,
/// lanes and drivers use nothing else. Another one is a class that fulfils `Level`, has the kernels
/// that `detail::infinitesimal_operators` turns into operators, and specialises `scalar_traits`.
/// For those who extend duet.

namespace duet {
namespace detail {

/// Common part of `scalar_traits` of a level over T.
template <class T, class Tag, int Order>
struct level_traits {
  using value_type = T;
  using real_type = typename scalar_traits<T>::real_type;
  using tag = Tag;
  static constexpr bool is_infinitesimal = true;
  static constexpr int order = scalar_traits<T>::order + Order;
};

/// Sine and cosine of one argument, see rules/elementary.hpp.
template <class T>
struct sine_cosine;

struct some_function {
  template <class P, class... Rest>
  P operator()(const P& part, const Rest&...) const;
};
struct some_predicate {
  template <class P>
  bool operator()(const P& part) const;
};
struct some_rule {
  template <class T>
  T value(const T& x) const;
  template <class T>
  T slope(const T& x, const T& value) const;
};

} // namespace detail

/// An infinitesimal number D over T = `scalar_traits<D>::value_type`: its value and further parts,
/// all of them a T.
template <class D>
concept Level = Infinitesimal<D> &&
    requires(const D& x, const typename scalar_traits<D>::value_type& v,
             const detail::sine_cosine<typename scalar_traits<D>::value_type>& pair) {
  requires std::same_as<over<D, typename scalar_traits<D>::value_type>, D>;
  /// number of further parts; negative: its maximum
  { D::part_count } -> std::convertible_to<int>;
  /// the part without ε, on whose value branches depend
  { x.value() } -> std::convertible_to<typename scalar_traits<D>::value_type>;
  /// parts as read by drivers: 0 the value, then derivatives
  { x.part(0) } -> std::same_as<typename scalar_traits<D>::value_type>;
  /// x with another value
  { x.with_value(v) } -> std::same_as<D>;
  /// f(value…), then f of every other part of x and of numbers like it: D over the result type of f
  { x.zip(detail::some_function{}, x) } -> std::same_as<D>;
  /// true if the predicate holds for the value and for all other parts
  x.all_of(detail::some_predicate{});
  /// slope · x, where zero parts stay zero even if slopes are infinite
  { D::zero_preserving_product(x, x) } -> std::same_as<D>;
  /// the function of a rule, of one argument or more (with `slopes`)
  { D::lift(detail::some_rule{}, x) } -> std::same_as<D>;
  /// sine and cosine of x from those of its value; with 1 the hyperbolic ones
  { D::template lift_pair<-1>(pair, x) } -> std::same_as<detail::sine_cosine<D>>;
};

} // namespace duet

namespace duet::detail {

/// Type of a constant operand of type U in the kernels, usually T. Arithmetic constants stay plain
/// at any nesting depth of T, or their zero partials would meet infinite values; also if T is over
/// another field than the reals, so that x · 2 is the product of that field: a complex 2 would cost
/// digits and signs of zeros.
template <class T, class U>
using operand_t = std::conditional_t<Arithmetic<U>, constant_t<T>, T>;

/// Base of an infinitesimal number D over T, which supplies the kernels: `sum`, `difference`,
/// `product`, `quotient` of two D, `negated`, `plus`, `times`, `divided_by` with an operand_t, and
/// `dividing` with a T.
template <class D, class T>
struct infinitesimal_operators {
  /// Drops the derivatives; explicit for that reason.
  template <Arithmetic U>
    requires std::constructible_from<U, T>
  [[nodiscard]] constexpr explicit operator U() const {
    return static_cast<U>(static_cast<const D&>(*this).value());
  }

  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator+(const D& a) { return a; }
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator-(const D& a) { return a.negated(); }

  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator+(const D& a, const D& b) {
    return D::sum(a, b);
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator-(const D& a, const D& b) {
    return D::difference(a, b);
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator*(const D& a, const D& b) {
    return D::product(a, b);
  }
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator/(const D& a, const D& b) {
    return D::quotient(a, b);
  }

  // A constant operand is not widened to a number, which would multiply by zeros.
  template <ConstantOf<D> U>
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator+(const D& a, const U& b) {
    return a.plus(static_cast<operand_t<T, U>>(b));
  }
  template <ConstantOf<D> U>
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator+(const U& a, const D& b) {
    return b.plus(static_cast<operand_t<T, U>>(a));
  }
  template <ConstantOf<D> U>
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator-(const D& a, const U& b) {
    using operand = operand_t<T, U>;
    return a.plus(operand(-static_cast<operand>(b)));
  }
  template <ConstantOf<D> U>
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator-(const U& a, const D& b) {
    return b.negated().plus(static_cast<operand_t<T, U>>(a));
  }
  template <ConstantOf<D> U>
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator*(const D& a, const U& b) {
    return a.times(static_cast<operand_t<T, U>>(b));
  }
  template <ConstantOf<D> U>
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator*(const U& a, const D& b) {
    return b.times(static_cast<operand_t<T, U>>(a));
  }
  template <ConstantOf<D> U>
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator/(const D& a, const U& b) {
    return a.divided_by(static_cast<operand_t<T, U>>(b));
  }
  template <ConstantOf<D> U>
  [[nodiscard]] friend DUET_ALWAYS_INLINE constexpr D operator/(const U& a, const D& b) {
    return b.dividing(static_cast<T>(a));
  }

  template <std::convertible_to<D> U>
  friend DUET_ALWAYS_INLINE constexpr D& operator+=(D& a, const U& b) {
    return a = a + b;
  }
  template <std::convertible_to<D> U>
  friend DUET_ALWAYS_INLINE constexpr D& operator-=(D& a, const U& b) {
    return a = a - b;
  }
  template <std::convertible_to<D> U>
  friend DUET_ALWAYS_INLINE constexpr D& operator*=(D& a, const U& b) {
    return a = a * b;
  }
  template <std::convertible_to<D> U>
  friend DUET_ALWAYS_INLINE constexpr D& operator/=(D& a, const U& b) {
    return a = a / b;
  }
  friend DUET_ALWAYS_INLINE constexpr void swap(D& a, D& b) {
    const D c = a;
    a = b;
    b = c;
  }
  friend constexpr D& operator++(D& a) { return a = a.plus(T(1)); }
  friend constexpr D& operator--(D& a) { return a = a.plus(T(-1)); }
  friend constexpr D operator++(D& a, int) {
    const D before = a;
    ++a;
    return before;
  }
  friend constexpr D operator--(D& a, int) {
    const D before = a;
    --a;
    return before;
  }
};

#define DUET_REFUSES_ASSIGNMENT(op)                                                                \
  template <Arithmetic A, Infinitesimal D>                                                         \
  DUET_REFUSED("a sum or product of numbers with derivatives has their type: if x is one of "      \
               "them, write decltype(x) s = 0 instead of double s = 0")                            \
  A&                                                                                               \
  operator op(A&, const D&);
DUET_REFUSES_ASSIGNMENT(+=)
DUET_REFUSES_ASSIGNMENT(-=)
DUET_REFUSES_ASSIGNMENT(*=)
DUET_REFUSES_ASSIGNMENT(/=)
#undef DUET_REFUSES_ASSIGNMENT

// Concepts of two types list the second type first, for `template <class A, …<A> B>`.

/// At least one of the two is infinitesimal, and they can meet.
template <class B, class A>
concept MixedScalars = (Infinitesimal<A> || Infinitesimal<B>)&&(Scalar<A> || Arithmetic<A>)&&(
    Scalar<B> || Arithmetic<B>)&&Promotable<B, A>;

/// Their common numbers are ordered, which complex numbers are not.
template <class B, class A>
concept OrderedScalars = MixedScalars<B, A> && requires(const real_type_t<promote_t<A, B>>& x) {
  x < x;
};

/// Numbers whose functions follow from those of their components: of the numbers below an
/// infinitesimal one, of the lanes of a batch.
template <class T>
concept Lifted = Infinitesimal<T> || lane_traits<T>::is_batch;

/// Over the reals, where functions need not be analytic.
template <class T>
concept LiftedReal = Lifted<T> && Real<real_type_t<T>>;

/// Over the reals, or over complex numbers of built-in precision: for others `<complex>` provides
/// only exponentials, logarithms, roots and functions made of these.
template <class T>
concept LiftedAnalytic = LiftedReal<T> ||(Lifted<T>&& std::floating_point<constant_t<T>>);

/// At least one of the two is lifted, and they meet in numbers over the reals.
template <class B, class A>
concept MixedReals = (Lifted<A> || Lifted<B>)&&Promotable<B, A>&& LiftedReal<promote_t<A, B>>;

/// Neither is a constant for the other: both must be brought to their common nesting first.
template <class B, class A>
concept DifferentNestings = (Infinitesimal<A> || Infinitesimal<B>)&&Scalar<A>&& Scalar<B> &&
                            !std::is_same_v<A, B> && Promotable<B, A> && !ConstantOf<A, B> &&
                            !ConstantOf<B, A>;

/// Numbers of one differentiation, but with different numbers of partials or different orders.
template <class B, class A>
concept DifferentSizes = Infinitesimal<A> && Infinitesimal<B> && !Promotable<B, A> &&
                         Promotable<real_type_t<A>, real_type_t<B>>;

/// Appears in the declaration of deleted operators, for compilers to quote.
struct different_numbers_of_partials_or_orders {};

/// The value of x for a comparison of A and B. Fields other than the reals need not compare with
/// every arithmetic type; to built-in reals an integer is converted here, as a literal would be,
/// because of -Wconversion.
template <class A, class B, class X>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr decltype(auto) comparable(const X& x) {
  using number = real_type_t<promote_t<A, B>>;
  if constexpr (std::integral<X> && std::floating_point<number>) {
    return static_cast<number>(x);
  } else if constexpr (Real<number>) {
    return innermost(x);
  } else {
    return number(innermost(x));
  }
}

} // namespace duet::detail

namespace duet {
// Comparisons use values only, as an `if` in the differentiated function should.
#define DUET_COMPARES(op, Numbers)                                                                 \
  template <class A, detail::Numbers<A> B>                                                         \
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator op(const A& a, const B& b) {            \
    return detail::comparable<A, B>(a) op detail::comparable<A, B>(b);                             \
  }
DUET_COMPARES(==, MixedScalars)
DUET_COMPARES(!=, MixedScalars)
DUET_COMPARES(<, OrderedScalars)
DUET_COMPARES(<=, OrderedScalars)
DUET_COMPARES(>, OrderedScalars)
DUET_COMPARES(>=, OrderedScalars)
#undef DUET_COMPARES

#define DUET_OPERATOR_OF_TWO_TYPES(op)                                                             \
  template <class A, detail::DifferentNestings<A> B>                                               \
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operator op(const A& a, const B& b) {            \
    using common = promote_t<A, B>;                                                                \
    return static_cast<common>(a) op static_cast<common>(b);                                       \
  }                                                                                                \
  template <class A, detail::DifferentSizes<A> B>                                                  \
  auto operator op(const A&, const B&)->detail::different_numbers_of_partials_or_orders = delete;
DUET_OPERATOR_OF_TWO_TYPES(+)
DUET_OPERATOR_OF_TWO_TYPES(-)
DUET_OPERATOR_OF_TWO_TYPES(*)
DUET_OPERATOR_OF_TWO_TYPES(/)
#undef DUET_OPERATOR_OF_TWO_TYPES

} // namespace duet

namespace duet::detail {

/// f of every real number in x: its value first, then all its infinitesimal parts, always in the
/// same order.
template <class T, class F>
[[nodiscard]] T map_reals(const T& x, F&& f) {
  if constexpr (Infinitesimal<T>) {
    return x.zip([&](const auto& part) { return map_reals(part, f); });
  } else {
    return f(x);
  }
}

/// x with another real number as its innermost value; all infinitesimal parts stay.
template <class T>
[[nodiscard]] T with_innermost(const T& x, const real_type_t<T>& value) {
  if constexpr (Infinitesimal<T>) {
    return x.with_value(with_innermost(x.value(), value));
  } else {
    return value;
  }
}

/// True if all infinitesimal parts of x are exactly zero.
template <class T>
  requires(Scalar<T> || Arithmetic<T>)
[[nodiscard]] auto is_constant(const T& x) {
  return is_structural_zero(with_innermost(x, real_type_t<T>(0)));
}

/// Part of a scalar with respect to the level tagged `Tag`, at any nesting depth: 0 the value, k
/// the k-th partial of a dual or the k-th derivative of a Taylor number; for second derivatives
/// with respect to N variables 1 … N the gradient, then the Hessian row by row. A scalar without
/// that level does not depend on it.
template <class Tag, class T>
[[nodiscard]] constexpr auto part(const T& x, int k) {
  if constexpr (!contains_tag<T, Tag>()) {
    return k == 0 ? x : T(0);
  } else if constexpr (std::is_same_v<level_tag<T>, Tag>) {
    return x.part(k);
  } else {
    return x.zip([k](const auto& below) { return part<Tag>(below, k); });
  }
}

/// The k-th part, with respect to Tag, of every scalar of a result.
template <class Tag, class X>
[[nodiscard]] constexpr auto parts(const X& x, int k) {
  return map_scalars([k](const auto& s) { return part<Tag>(s, k); }, x);
}

} // namespace duet::detail

namespace std {

template <class A, duet::detail::MixedScalars<A> B>
struct common_type<A, B> {
  using type = duet::promote_t<A, B>;
};

} // namespace std
