// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

/// \file
/// Rejection of results that refer to local variables: expressions of Eigen. For those who extend
/// duet.

namespace Eigen {

template <class Derived>
struct EigenBase;
template <class Scalar, int Options, class Index>
class SparseVector;

} // namespace Eigen

namespace duet::detail {

template <class Derived>
void as_eigen(const Eigen::EigenBase<Derived>&);
template <class X>
  requires std::derived_from<X, typename X::PlainObject>
void as_plain(const X&);
template <class Scalar, int Options, class Index>
void as_plain(const Eigen::SparseVector<Scalar, Options, Index>&);

/// True if an X refers to numbers that it does not own. An expression of Eigen refers to its
/// operands: usually the local variables of the function that returned it, which are destroyed. So
/// do containers of expressions.
template <class X>
inline constexpr bool refers_elsewhere = [] {
  if constexpr (std::is_reference_v<X>) {
    return true;
  } else if constexpr (requires(const X& x) { as_eigen(x); }) {
    return !requires(const X& x) { as_plain(x); };
  } else if constexpr (requires { typename X::value_type; }) {
    using element = typename X::value_type;
    if constexpr (std::is_same_v<element, X>) { // as for the numbers of Boost.Multiprecision
      return false;
    } else {
      return refers_elsewhere<element>;
    }
  } else {
    return false;
  }
}();
template <class X>
inline constexpr bool refers_elsewhere<const X> = refers_elsewhere<X>;
template <class... T>
inline constexpr bool refers_elsewhere<std::tuple<T...>> = (refers_elsewhere<T> || ...);
template <class A, class B>
inline constexpr bool refers_elsewhere<std::pair<A, B>> =
    refers_elsewhere<A> || refers_elsewhere<B>;

/// Rejects result types that a function called by duet must not return.
template <class X>
constexpr void require_owning_result() {
  static_assert(!refers_elsewhere<X>,
                "duet: a function returns an expression of Eigen, which refers to variables that "
                "are gone by then: return (...).eval(), or declare the type of the result: "
                "[](const auto& x) -> duet::vector3<...> { ... }");
}

} // namespace duet::detail
