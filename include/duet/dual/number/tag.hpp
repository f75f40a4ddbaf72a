// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <string_view>
#include <type_traits>

/// \file
/// Tags that keep infinitesimals of different meaning apart.

namespace duet {

/// Tag of a derivative's ε. A driver that differentiates a function of type F uses
/// `derivative_tag<F>`, so that nested differentiations cannot mix up their infinitesimals; a bare
/// `dual<T>` carries `derivative_tag<>`.
template <class... F>
struct derivative_tag {};

/// Tag of the ε of dual numbers, dual vectors and dual quaternions of rigid motion (N10).
struct screw_tag {};

namespace detail {

template <class Tag>
[[nodiscard]] constexpr std::string_view tag_name() {
  return __PRETTY_FUNCTION__;
}

/// True where the level of `A` nests outside that of `B`.
///
/// The screw ε is outermost: a derivative dual is a scalar of the screw algebra. Among derivatives
/// the longer name is outside: the type of a function that is defined inside a differentiated
/// function, or holds one of its variables, contains the outer function's tag in its own name, and
/// the inner differentiation must be the outer level. Unrelated tags are put in some fixed order;
/// any will do, because drivers find their own tag at whatever depth it stands.
template <class A, class B>
[[nodiscard]] constexpr bool is_outside() {
  if constexpr (std::is_same_v<A, screw_tag> || std::is_same_v<B, screw_tag>) {
    return std::is_same_v<A, screw_tag>;
  } else {
    constexpr auto a = tag_name<A>();
    constexpr auto b = tag_name<B>();
    return a.size() != b.size() ? a.size() > b.size() : a > b;
  }
}

template <class A, class B>
[[nodiscard]] constexpr bool tags_can_be_told_apart() {
  return std::is_same_v<A, B> || is_outside<A, B>() != is_outside<B, A>();
}

} // namespace detail
} // namespace duet
