// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/promotion.hpp>

#include <type_traits>

/// \file
/// The scalar of which a type is made.

namespace duet {
namespace detail {

template <class X>
struct scalar_within {};
template <class X>
  requires(!Scalar<X> && !Arithmetic<X> && requires { typename structure<X>::scalar; })
struct scalar_within<X> : scalar_within<typename structure<X>::scalar> {};
template <class X>
  requires(!Scalar<X> && !Structured<X> && requires { typename X::scalar_type; })
struct scalar_within<X> : scalar_within<typename X::scalar_type> {};
template <class X>
  requires(Scalar<X> || Arithmetic<X>)
struct scalar_within<X> {
  static constexpr auto of_scalar() {
    if constexpr (contains_tag<X, screw_tag>()) { // the screw ε is outermost
      return std::type_identity<typename scalar_traits<X>::value_type>{};
    } else {
      return std::type_identity<X>{};
    }
  }
  using type = typename decltype(of_scalar())::type;
};

} // namespace detail

/// The scalar of which X is made: X itself if it is a scalar, T of a vector, matrix, `std::array`
/// or `std::vector` of T, of a quaternion and of a pose over T, of a curve over T, and of a chain
/// or tree with a table of T.
///
/// References and `const` are ignored. Tuples, whose elements may differ, have none.
///
/// Example: `const auto f = [](const auto& q) { using T = scalar_t<decltype(q)>; ... }`
template <class X>
using scalar_t = typename detail::scalar_within<std::remove_cvref_t<X>>::type;

} // namespace duet
