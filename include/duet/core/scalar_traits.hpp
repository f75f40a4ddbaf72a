// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <concepts>
#include <limits>
#include <type_traits>

/// \file
/// What a scalar is made of. A scalar is a real number, a number of another field that was opted in
/// (complex, rational), or an infinitesimal extension of a scalar (`dual`, `taylor`), to any depth.
/// For those who extend duet.

namespace duet {

/// A built-in number, integers and `bool` among them.
template <class T>
concept Arithmetic = std::is_arithmetic_v<T>;

/// Facts on a scalar type. The primary template describes plain numbers; infinitesimal ones
/// specialise it, and say there too what their ε means, `tag`, and what they are over another
/// scalar, `over<U>`.
template <class T>
struct scalar_traits {
  using value_type = T; ///< the scalar one level below; a plain number is its own
  using real_type = T;  ///< the number at the bottom: real, or of the field that was opted in
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

/// A field other than the real numbers, over which dual and Taylor numbers are wanted too: opt in
/// by a specialisation. `<duet/dual/complex.hpp>` and `<duet/interop/boost_rational.hpp>` have
/// theirs.
template <class T>
struct field_traits {
  static constexpr bool is_field = false;
  /// What arithmetic constants become before they meet such a number. Where it is an integer, only
  /// integers are constants.
  using constant_type = T;
};

/// A number that is no infinitesimal extension of another.
template <class T>
concept Field = Real<T> || field_traits<T>::is_field;

/// Anything duet computes with: a number or an infinitesimal extension of one.
template <class T>
concept Scalar = Field<T> || Infinitesimal<T>;

/// The number at the bottom of T.
template <class T>
using real_type_t = typename scalar_traits<T>::real_type;

/// Facts on a number that stands for several at once: `batch` specialises it. Any other is its own
/// only lane.
template <class T>
struct lane_traits {
  static constexpr bool is_batch = false;
  static constexpr int lanes = 1;
  using type = T; ///< what is in a lane
};

/// Several numbers at once, or an infinitesimal extension of them.
template <class T>
concept Batched = lane_traits<real_type_t<T>>::is_batch;

/// The real number in one lane of T.
template <class T>
using lane_type_t = typename lane_traits<real_type_t<T>>::type;

/// An infinitesimal extension of the real numbers, where functions need not be analytic.
template <class T>
concept RealInfinitesimal = Infinitesimal<T> && Real<real_type_t<T>>;

/// The number at the bottom of `x`. Branches on values look at this one only, so that derivatives
/// of every order see one smooth branch.
template <class T>
[[nodiscard]] constexpr decltype(auto) innermost(const T& x) {
  if constexpr (Infinitesimal<T>) {
    return innermost(x.value());
  } else {
    return (x);
  }
}

namespace detail {

/// What arithmetic constants become before they meet the numbers at the bottom of T.
template <class T>
using constant_t = typename field_traits<real_type_t<T>>::constant_type;

/// A formula: it stands for numbers that are given later.
template <class X>
inline constexpr bool is_symbolic = false;

/// The integer n for an expression with T: as it is where T is over the reals, which all take an
/// int.
template <class T>
[[nodiscard]] constexpr auto integer(int n) {
  if constexpr (Real<real_type_t<T>>) {
    return n;
  } else {
    return constant_t<T>(n);
  }
}

} // namespace detail
} // namespace duet
