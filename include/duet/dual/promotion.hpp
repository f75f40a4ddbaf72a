// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/types.hpp>
#include <duet/core/scalar_traits.hpp>

#include <concepts>
#include <type_traits>

/// \file
/// Tags that distinguish infinitesimals of different meaning, and the common type of two scalars:
/// one nesting of levels that holds both. For those who extend duet.

namespace duet {

/// Tag of a derivative's ε. A driver that differentiates a function of type F uses
/// `derivative_tag<F>`, so that nested differentiations cannot mix up their infinitesimals; a bare
/// `dual<T>` carries `derivative_tag<>`.
template <class... F>
struct derivative_tag {};

/// Tag of the ε of dual numbers, dual vectors and dual quaternions of rigid motion (N10).
struct screw_tag {};

namespace detail {

/// True if the level of `A` nests outside that of `B`.
///
/// The screw ε is outermost: a derivative dual is a scalar of the screw algebra. Among derivatives
/// the longer name is outside: the type of a function that is defined inside a differentiated
/// function, or holds one of its variables, contains the outer function's tag in its own name, and
/// the inner differentiation must be the outer level. Unrelated tags are put in some fixed order;
/// any will do, because drivers find their tag at any nesting depth.
template <class A, class B>
[[nodiscard]] constexpr bool is_outside() {
  if constexpr (std::is_same_v<A, screw_tag> || std::is_same_v<B, screw_tag>) {
    return std::is_same_v<A, screw_tag>;
  } else {
    constexpr auto a = type_text<A>();
    constexpr auto b = type_text<B>();
    return a.size() != b.size() ? a.size() > b.size() : a > b;
  }
}

template <class A, class B>
[[nodiscard]] constexpr bool tags_are_distinguishable() {
  return std::is_same_v<A, B> || is_outside<A, B>() != is_outside<B, A>();
}

} // namespace detail

/// Tag of the outermost ε of T: its meaning.
template <class T>
using level_tag = typename scalar_traits<T>::tag;

/// The outermost level of T over another scalar.
template <class T, class U>
using over = typename scalar_traits<T>::template over<U>;

namespace detail {

/// True if any level of T carries this tag.
template <class T, class Tag>
[[nodiscard]] constexpr bool contains_tag() {
  if constexpr (Infinitesimal<T>) {
    return std::is_same_v<level_tag<T>, Tag> ||
           contains_tag<typename scalar_traits<T>::value_type, Tag>();
  } else {
    return false;
  }
}

struct no_promotion {};

/// True if arithmetic constants of type U are numbers at the bottom of T: 0.5 is not, for a field
/// over the integers.
template <class U, class T>
concept ArithmeticOf = Arithmetic<U> &&(std::integral<U> || !std::integral<constant_t<T>>);

template <class A, class B>
[[nodiscard]] constexpr auto promotion();

template <class A, class B>
using promotion_t = typename decltype(promotion<A, B>())::type;

/// The level of A over the promotion of the scalar below it with B.
template <class A, class Below, class B>
[[nodiscard]] constexpr auto promotion_below() {
  using below = promotion_t<Below, B>;
  if constexpr (std::is_same_v<below, no_promotion>) {
    return std::type_identity<no_promotion>{};
  } else {
    return std::type_identity<over<A, below>>{};
  }
}

template <class A, class B>
[[nodiscard]] constexpr auto promotion_of_levels() {
  using value_a = typename scalar_traits<A>::value_type;
  using value_b = typename scalar_traits<B>::value_type;
  using tag_a = level_tag<A>;
  using tag_b = level_tag<B>;
  constexpr bool a_in_b = contains_tag<B, tag_a>();
  constexpr bool b_in_a = contains_tag<A, tag_b>();
  if constexpr (std::is_same_v<tag_a, tag_b>) {
    if constexpr (std::is_same_v<over<A, value_b>, B>) {
      return promotion_below<A, value_a, value_b>();
    } else {
      return std::type_identity<no_promotion>{}; // another number of partials or another order
    }
  } else if constexpr (a_in_b && b_in_a) {
    return std::type_identity<no_promotion>{};
  } else if constexpr (a_in_b) {
    return promotion_below<B, value_b, A>();
  } else if constexpr (b_in_a) {
    return promotion_below<A, value_a, B>();
  } else {
    static_assert(tags_are_distinguishable<tag_a, tag_b>(),
                  "duet: two differentiations of functions with the same name meet here and cannot "
                  "be distinguished; give one a separate tag: derivative<struct my_tag>(f, x)");
    if constexpr (is_outside<tag_a, tag_b>()) {
      return promotion_below<A, value_a, B>();
    } else {
      return promotion_below<B, value_b, A>();
    }
  }
}

/// Two numbers, at least one of a field other than the reals: no digits may be lost.
template <class A, class B>
[[nodiscard]] constexpr auto promotion_of_fields() {
  if constexpr (Arithmetic<B>) {
    using constant = constant_t<A>;
    return std::type_identity<std::conditional_t<
        std::is_same_v<std::common_type_t<constant, B>, constant>, A, no_promotion>>{};
  } else if constexpr (Field<A> && Field<B> && requires { typename std::common_type_t<A, B>; }) {
    return std::common_type<A, B>{};
  } else {
    return std::type_identity<no_promotion>{};
  }
}

template <class A, class B>
[[nodiscard]] constexpr auto promotion() {
  if constexpr (std::is_same_v<A, B>) {
    return std::type_identity<A>{};
  } else if constexpr ((!Infinitesimal<A> && Infinitesimal<B>) ||
                       (Arithmetic<A> && !Arithmetic<B>)) {
    return promotion<B, A>();
  } else if constexpr (Infinitesimal<A> && ArithmeticOf<B, A>) {
    return std::type_identity<A>{}; // a literal takes the precision of the other operand
  } else if constexpr (Infinitesimal<A> && Infinitesimal<B>) {
    return promotion_of_levels<A, B>();
  } else if constexpr (Infinitesimal<A> && Field<B>) {
    return promotion_below<A, typename scalar_traits<A>::value_type, B>();
  } else if constexpr (Arithmetic<A> && Arithmetic<B>) {
    return std::common_type<A, B>{};
  } else if constexpr (Real<A> && Arithmetic<B>) {
    return std::type_identity<A>{};
  } else if constexpr (field_traits<A>::is_field || field_traits<B>::is_field) {
    return promotion_of_fields<A, B>();
  } else {
    return std::type_identity<no_promotion>{};
  }
}

} // namespace detail

/// The scalar that holds both A and B: levels merged into one nesting, the screw ε outermost.
/// Arithmetic types take the precision of the scalar they meet.
template <class A, class B>
using promote_t = detail::promotion_t<A, B>;

/// True if A and B can meet in one expression. (In this order for
/// `template <class A, Promotable<A> B>`.)
template <class B, class A>
concept Promotable = !std::same_as<promote_t<A, B>, detail::no_promotion>;

namespace detail {

/// Integers are computed with and differentiated as reals.
template <class X>
using differentiable_t = std::conditional_t<std::integral<X>, double, X>;
/// Integers that meet a T are converted to the reals of T.
template <class X, class T>
using as_real_of = std::conditional_t<std::integral<X>, real_type_t<T>, X>;

} // namespace detail

/// U is a constant for the level of D: an arithmetic type or a scalar of a level below.
template <class U, class D>
concept ConstantOf = Infinitesimal<D> &&
    (detail::ArithmeticOf<U, D> ||
     (!Arithmetic<U> && Scalar<U> && !std::same_as<U, D> &&
      std::same_as<promote_t<typename scalar_traits<D>::value_type, U>,
                   typename scalar_traits<D>::value_type>));

namespace detail {

/// Appears in the declaration of a deleted conversion, for compilers to quote.
struct epsilon_of_a_rigid_motion_is_not_that_of_a_derivative {};

/// U has a screw ε and D a derivative's, or conversely, and U is not a constant for D.
template <class U, class D>
concept OtherKindOfEpsilon = Infinitesimal<U> && Infinitesimal<D> && !ConstantOf<U, D> &&
                             contains_tag<U, screw_tag>() != contains_tag<D, screw_tag>();

} // namespace detail

} // namespace duet
