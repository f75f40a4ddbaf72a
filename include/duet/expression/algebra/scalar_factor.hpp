// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/algebra/arithmetic.hpp>
#include <duet/expression/algebra/product.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>

#include <type_traits>

/// \file
/// Vectors as a scalar times a vector, by which axes that stand still are known.

namespace duet::expression::detail {

/// a of V = a W where a scalar a can be seen, and otherwise 0; and W.
template <class V, class W>
struct factor {
  static constexpr auto make() { return whole<0>; }
};
template <class V, class W>
[[nodiscard]] constexpr auto factor_of(V, W) {
  if constexpr (std::is_same_v<V, W>) {
    return whole<1>;
  } else {
    return factor<V, W>::make();
  }
}
template <class V>
struct direction {
  using type = V;
};
template <class V>
using direction_t = typename direction<V>::type;

template <class A, class B, class W>
struct factor<applied_node<op::product, A, B>, W> {
  static constexpr auto make() { return A{} * factor_of(B{}, W{}); }
};
template <class A, class B>
struct direction<applied_node<op::product, A, B>> : direction<B> {};
template <class A, class B, class W>
struct factor<applied_node<op::quotient, A, B>, W> {
  static constexpr auto make() { return factor_of(A{}, W{}) / B{}; }
};
template <class A, class B>
struct direction<applied_node<op::quotient, A, B>> : direction<A> {};
template <class A, class W>
struct factor<applied_node<op::negative, A>, W> {
  static constexpr auto make() { return -factor_of(A{}, W{}); }
};
template <class A>
struct direction<applied_node<op::negative, A>> : direction<A> {};

} // namespace duet::expression::detail
