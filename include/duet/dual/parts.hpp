// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual/partials.hpp>
#include <duet/dual/promotion.hpp>

#include <type_traits>

/// \file
/// Parts of infinitesimal numbers: those of one level, at any nesting depth, and the real numbers
/// at the bottom of all of them.

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
