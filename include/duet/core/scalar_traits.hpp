// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <concepts>
#include <limits>
#include <type_traits>

/// \file
/// What a scalar is made of. A scalar is a real number, or an infinitesimal extension of a scalar
/// (`dual`, `taylor`), to any depth.

namespace duet {

template <class T>
concept Arithmetic = std::is_arithmetic_v<T>;

/// Facts on a scalar type. The primary template describes real numbers; `dual` and `taylor`
/// specialise it.
template <class T>
struct scalar_traits {
  using value_type = T; ///< the scalar one level below; a real number is its own
  using real_type = T;  ///< the real number at the bottom
  static constexpr bool is_infinitesimal = false;
  /// Highest total order of derivatives the type carries.
  static constexpr int order = 0;
};

/// A number with an infinitesimal part: `dual` or `taylor`.
template <class T>
concept Infinitesimal = scalar_traits<T>::is_infinitesimal;

/// A floating-point number, built in or of Boost.Multiprecision.
template <class T>
concept Real = std::floating_point<T> ||
    (!Infinitesimal<T> && !Arithmetic<T> && std::numeric_limits<T>::is_specialized &&
     !std::numeric_limits<T>::is_integer);

/// Anything duet computes with: a real number or an infinitesimal extension of one.
template <class T>
concept Scalar = Real<T> || Infinitesimal<T>;

template <class T>
using real_type_t = typename scalar_traits<T>::real_type;

/// The real number at the bottom of `x`. Branches on values look at this one only, so that
/// derivatives of every order see one smooth branch.
template <class T>
[[nodiscard]] constexpr decltype(auto) innermost(const T& x) {
  if constexpr (Infinitesimal<T>) {
    return innermost(x.value());
  } else {
    return (x);
  }
}

} // namespace duet
