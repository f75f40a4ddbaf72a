// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/math.hpp>
#include <duet/dual/rules_of_many.hpp>
#include <duet/expression/arithmetic.hpp>
#include <duet/expression/formula.hpp>
#include <duet/expression/function.hpp>
#include <duet/expression/node.hpp>
#include <duet/expression/number.hpp>
#include <duet/expression/power.hpp>
#include <duet/expression/printed.hpp>

#include <cmath>
#include <string>

/// \file
/// Functions of two scalars and more.

namespace duet::expression {

namespace detail {

/// The same for a function of several scalars.
template <class Function>
struct function_of_many {
  template <class... Kinds>
  static constexpr kind kind_of(Kinds...) {
    return kind::scalar;
  }
  template <class... P>
  static printed print(notation style, const printed& first, const P&... rest) {
    return printed_call(style, Function::name, (first.text + ... + (", " + rest.text)));
  }
};

} // namespace detail

namespace op {

struct atan2 : detail::function_of_many<atan2> {
  static constexpr detail::function_name name = {"atan2", ""};
  template <class Y, class X>
  static promote_t<Y, X> value(const Y& y, const X& x) {
    using std::atan2;
    return atan2(y, x);
  }
  template <class Y, class X>
  static constexpr auto differential(Y y, X x, auto dy, auto dx) {
    return (x * dy - y * dx) / (apply<whole_power<2>>(x) + apply<whole_power<2>>(y));
  }
};

/// √(x² + y²)
struct hypot : detail::function_of_many<hypot> {
  static constexpr detail::function_name name = {"hypot", ""};
  template <class X, class Y>
  static promote_t<X, Y> value(const X& x, const Y& y) {
    using std::hypot;
    return hypot(x, y);
  }
  template <class X, class Y>
  static constexpr auto differential(X x, Y y, auto dx, auto dy) {
    return (x * dx + y * dy) / apply<hypot>(x, y);
  }
};

/// x y + z, rounded once.
struct fma : detail::function_of_many<fma> {
  static constexpr detail::function_name name = {"fma", ""};
  template <class X, class Y, class Z>
  static promote_t<promote_t<X, Y>, Z> value(const X& x, const Y& y, const Z& z) {
    using std::fma;
    return fma(x, y, z);
  }
  template <class X, class Y, class Z>
  static constexpr auto differential(X x, Y y, Z, auto dx, auto dy, auto dz) {
    return dx * y + x * dy + dz;
  }
};

/// a + t (b − a)
struct lerp : detail::function_of_many<lerp> {
  static constexpr detail::function_name name = {"lerp", ""};
  template <class A, class B, class T>
  static auto value(const A& a, const B& b, const T& t) {
    using R = promote_t<promote_t<A, B>, T>;
    return duet::rule::lerp{}.value(R(a), R(b), R(t));
  }
  template <class A, class B, class T>
  static constexpr auto differential(A a, B b, T t, auto da, auto db, auto dt) {
    return (whole<1> - t) * da + t * db + (b - a) * dt;
  }
};

} // namespace op

/// The angle of the point (x, y), in (−π, π].
template <class Y, class X, class Tag = decltype([](op::hypot*) {})>
  requires Operands<Y, X>
[[nodiscard]] constexpr auto atan2(const Y& y, const X& x) {
  return apply<op::atan2>(detail::term<Tag>(y), detail::term<Tag>(x));
}
/// √(x² + y²)
template <class X, class Y, class Tag = decltype([](op::hypot*) {})>
  requires Operands<X, Y>
[[nodiscard]] constexpr auto hypot(const X& x, const Y& y) {
  return apply<op::hypot>(detail::term<Tag>(x), detail::term<Tag>(y));
}
/// √(x² + y² + z²)
template <class X, class Y, class Z, class Tag = decltype([](op::hypot*) {})>
  requires(Operands<X, Y>&& Term<Z>)
[[nodiscard]] constexpr auto hypot(const X& x, const Y& y, const Z& z) {
  return hypot(hypot<X, Y, Tag>(x, y), z);
}
/// x y + z, the value rounded once.
template <Term X, Term Y, Term Z>
[[nodiscard]] constexpr auto fma(const X& x, const Y& y, const Z& z) {
  return apply<op::fma>(x, y, z);
}
/// a + t (b − a) of scalars, exact at t = 0 and t = 1.
template <class A, class B, class T, class TagA = decltype([](op::hypot*) {}),
          class TagB = decltype([](op::hypot*) {})>
  requires(Operands<A, B, T>&& Term<T>)
[[nodiscard]] constexpr auto lerp(const A& a, const B& b, const T& t) {
  return apply<op::lerp>(detail::term<TagA>(a), detail::term<TagB>(b), t);
}

} // namespace duet::expression
