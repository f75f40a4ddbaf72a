// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/algebra/arithmetic.hpp>
#include <duet/expression/algebra/product.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>

#include <type_traits>

/// \file
/// What is a scalar times something else: linear operations go past the scalar, and axes that stand
/// still are known by it.

namespace duet::expression::detail {

/// −M, s M or M/s of what is no scalar.
template <class T>
inline constexpr bool is_scaled =
    is_applied<T, op::negative> || is_applied<T, op::product> || is_applied<T, op::quotient>;
/// f(−M) = −f(M), and so on, of a linear f.
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

/// a of V = a W where a scalar a can be seen, and otherwise 0.
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
/// W of V = a W.
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

/// The scalar rate at which V moves along itself by dV; 0 where none can be seen.
template <class V, class DV>
using rate_along = decltype(factor_of(DV{}, direction_t<V>{}));

} // namespace duet::expression::detail
