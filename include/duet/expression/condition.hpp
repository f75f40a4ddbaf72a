// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/math.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/tree/printed.hpp>

#include <cmath>
#include <string>
#include <utility>

/// \file
/// Comparisons of formulas, `select`, `min`, `max` and |x|.

namespace duet::expression {

namespace detail {

/// a if the condition holds, otherwise b, by the `select` that argument-dependent lookup finds for
/// the type of the condition.
[[nodiscard]] constexpr auto chosen(const auto& condition, const auto& a, const auto& b) {
  using duet::select;
  return select(
      condition, [&] { return a; }, [&] { return b; });
}

} // namespace detail

namespace op {

/// a < b or a ≤ b of the innermost values, without derivatives.
template <bool OrEqual>
struct less {
  static constexpr kind kind_of(kind, kind) { return kind::condition; }
  static constexpr auto value(const auto& a, const auto& b) {
    return OrEqual ? innermost(a) <= innermost(b) : innermost(a) < innermost(b);
  }
  static printed print(notation style, const printed& a, const printed& b) {
    const std::string sign = !OrEqual ? " < " : style != notation::text ? " \\le " : " <= ";
    return {a.inside(precedence::sum) + sign + b.inside(precedence::sum), precedence::condition};
  }
};

/// a if the condition holds, otherwise b.
struct select {
  static constexpr kind kind_of(kind, kind a, kind) { return a; }
  template <kind C, kind A, kind B>
  static constexpr void require() {
    static_assert(C == kind::condition && A == B,
                  "duet: select takes a condition, as a < b, and two formulas of one kind");
  }
  static constexpr auto simplified(auto, auto a, auto b) {
    return a.index == b.index ? a : a.none();
  }
  static constexpr auto value(const auto& condition, const auto& a, const auto& b) {
    return detail::chosen(condition, a, b);
  }
  static constexpr auto differential(auto c, auto, auto, auto, auto da, auto db) {
    return apply<select>(c, da, db);
  }
  static printed print(notation style, const printed& c, const printed& a, const printed& b) {
    if (style != notation::text) {
      return {"\\begin{cases}" + a.text + " & " + c.text + "\\\\" + b.text +
              " & \\text{else}\\end{cases}"};
    }
    return {"select(" + c.text + ", " + a.text + ", " + b.text + ")"};
  }
};

/// 1, or −1 where the sign bit is set.
struct sign {
  static constexpr detail::function_name name = {"sign", ""};
  static constexpr kind kind_of(kind a) { return a; }
  template <class X>
  static X value(const X& x) {
    using std::signbit;
    return duet::select(
        signbit(innermost(x)), [] { return X(-1); }, [] { return X(1); });
  }
  static constexpr auto differential(auto, auto) { return whole<0>; }
};

/// |x|, with the derivative ±1 at ±0.
struct abs {
  static constexpr detail::function_name name = {"abs", "\\left|#\\right|"};
  static constexpr kind kind_of(kind a) { return a; }
  template <class X>
  static X value(const X& x) {
    using std::abs;
    return X(abs(x));
  }
  static constexpr auto differential(auto x, auto dx) { return apply<sign>(x) * dx; }
};

} // namespace op

template <class A, Operands<A> B, class Tag = decltype([](op::less<true>*) {})>
[[nodiscard]] constexpr auto operator<(const A& a, const B& b) {
  return apply<op::less<false>>(detail::term<Tag>(a), detail::term<Tag>(b));
}
template <class A, Operands<A> B, class Tag = decltype([](op::less<true>*) {})>
[[nodiscard]] constexpr auto operator<=(const A& a, const B& b) {
  return apply<op::less<true>>(detail::term<Tag>(a), detail::term<Tag>(b));
}
template <class A, Operands<A> B, class Tag = decltype([](op::less<true>*) {})>
[[nodiscard]] constexpr auto operator>(const A& a, const B& b) {
  return apply<op::less<false>>(detail::term<Tag>(b), detail::term<Tag>(a));
}
template <class A, Operands<A> B, class Tag = decltype([](op::less<true>*) {})>
[[nodiscard]] constexpr auto operator>=(const A& a, const B& b) {
  return apply<op::less<true>>(detail::term<Tag>(b), detail::term<Tag>(a));
}

/// a if the condition holds, otherwise b, of one kind. Both are evaluated, and must be safe to
/// evaluate for all arguments; the derivative is that of the selected one.
template <Term C, class A, class B, class Tag = decltype([](op::less<true>*) {})>
[[nodiscard]] constexpr auto select(const C& condition, const A& a, const B& b) {
  return detail::apply_to<op::select, Tag>(std::index_sequence_for<C, A, B>{}, condition, a, b);
}

/// |x|, with the derivative ±1 at ±0.
[[nodiscard]] constexpr auto abs(const ScalarTerm auto& x) { return apply<op::abs>(x); }
/// The larger of two scalars, with its derivatives; of equal ones the first.
template <class A, Operands<A> B, class Tag = decltype([](op::less<true>*) {})>
[[nodiscard]] constexpr auto max(const A& a, const B& b) {
  const auto first = detail::term<Tag>(a);
  const auto second = detail::term<Tag>(b);
  return select(first < second, second, first);
}
/// The smaller of two scalars, with its derivatives; of equal ones the first.
template <class A, Operands<A> B, class Tag = decltype([](op::less<true>*) {})>
[[nodiscard]] constexpr auto min(const A& a, const B& b) {
  const auto first = detail::term<Tag>(a);
  const auto second = detail::term<Tag>(b);
  return select(second < first, second, first);
}

} // namespace duet::expression
