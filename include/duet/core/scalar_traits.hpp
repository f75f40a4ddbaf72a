// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <concepts>
#include <limits>
#include <type_traits>

/// \file
/// Scalar concepts and traits. A scalar is a real number, a number of another field that was opted
/// in (complex, rational), or an infinitesimal extension of a scalar (`dual`, `taylor`), to any
/// depth. For those who extend duet.

namespace duet {

/// A built-in number, integers and `bool` among them.
template <class T>
concept Arithmetic = std::is_arithmetic_v<T>;

/// Properties of a scalar type. The primary template describes plain numbers; infinitesimal ones
/// specialise it, and define there the meaning of their ε, `tag`, and their type over another
/// scalar, `over<U>`.
template <class T>
struct scalar_traits {
  using value_type = T; ///< the scalar one level below; for a plain number itself
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

/// A field other than the real numbers for dual and Taylor numbers: opt in by a specialisation.
/// `<duet/dual/complex.hpp>` and `<duet/interop/boost_rational.hpp>` define theirs.
template <class T>
struct field_traits {
  static constexpr bool is_field = false;
  /// Type to which arithmetic constants are converted before they meet such a number. If it is an
  /// integer, only integers are constants.
  using constant_type = T;
};

/// A number that is not an infinitesimal extension of another.
template <class T>
concept Field = Real<T> || field_traits<T>::is_field;

/// Any scalar of duet: a number or an infinitesimal extension of one.
template <class T>
concept Scalar = Field<T> || Infinitesimal<T>;

/// The number at the bottom of T.
template <class T>
using real_type_t = typename scalar_traits<T>::real_type;

/// Properties of a number that stands for several at once: `batch` specialises it. Any other has
/// one lane, itself.
template <class T>
struct lane_traits {
  static constexpr bool is_batch = false;
  static constexpr int lanes = 1;
  using type = T; ///< type of a lane
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

/// The number at the bottom of `x`. Branches depend on this value only, so that derivatives of
/// every order see one smooth branch.
template <class T>
[[nodiscard]] constexpr decltype(auto) innermost(const T& x) {
  if constexpr (Infinitesimal<T>) {
    return innermost(x.value());
  } else {
    return (x);
  }
}

namespace detail {

/// Type to which arithmetic constants are converted before they meet the numbers at the bottom of
/// T.
template <class T>
using constant_t = typename field_traits<real_type_t<T>>::constant_type;

/// A formula: it stands for numbers that are bound later.
template <class X>
inline constexpr bool is_symbolic = false;

/// A number that records its operations, as those of `trace`: nothing is known of its value but
/// what is written.
template <class T>
inline constexpr bool is_recording = false;

/// The integer n for an expression with T: an int if T is over the reals, which all accept one.
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
