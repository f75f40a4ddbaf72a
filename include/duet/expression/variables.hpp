// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/screw.hpp>
#include <duet/expression/tape/derivation.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/vector.hpp>

#include <boost/mp11/list.hpp>

#include <tuple>

/// \file
/// Variables of differentiation and the directions in which they move.

namespace duet::expression {

namespace detail {

template <class... Motions>
struct motion_list {};

/// The directions in which a symbol can move, one for each coordinate of its tangent space.
template <class Symbol, class Frame, kind K = Symbol::kind_of>
struct directions;

template <class Symbol, class Frame>
struct directions<Symbol, Frame, kind::scalar> {
  using type = motion_list<moving_scalar<Symbol>>;
};

template <class Symbol, class Frame, kind K, int... I>
using moving_along_axes = motion_list<moving<Symbol, unit_vector_node<K, I>, Frame>...>;

template <class Symbol, class Frame>
struct directions<Symbol, Frame, kind::vector> {
  using type = moving_along_axes<Symbol, void, kind::vector, 0, 1, 2>;
};
/// Components of n + εm in the order [m; n], that of twists.
template <class Symbol, class Frame>
struct directions<Symbol, Frame, kind::dual_vector> {
  using type = moving_along_axes<Symbol, void, kind::dual_vector, 3, 4, 5, 0, 1, 2>;
};

/// Axes of a rotation.
template <class Symbol, class Frame>
struct directions<Symbol, Frame, kind::quaternion> {
  using type = moving_along_axes<Symbol, Frame, kind::vector, 0, 1, 2>;
};
template <class Symbol>
struct directions<Symbol, hybrid_frame, kind::quaternion>
    : directions<Symbol, spatial_frame, kind::quaternion> {};
/// Unit twists of a pose in the order [v; ω].
template <class Symbol, class Frame>
struct directions<Symbol, Frame, kind::pose> {
  using type = moving_along_axes<Symbol, Frame, kind::dual_vector, 3, 4, 5, 0, 1, 2>;
};
template <class Symbol>
struct directions<Symbol, hybrid_frame, kind::pose> {
  template <int I>
  static constexpr auto spatial_twist() { // v = ṗ − ω × p
    constexpr auto e = unit_vector_node<kind::dual_vector, I>{};
    constexpr auto omega = apply<op::part_of_dual<false>>(e);
    return at_point<op::difference>(e, apply<op::cross>(omega, apply<op::translation>(Symbol{})));
  }
  template <int... I>
  using moving_at_point =
      motion_list<moving<Symbol, decltype(spatial_twist<I>()), spatial_frame>...>;
  using type = moving_at_point<3, 4, 5, 0, 1, 2>;
};

template <class T>
inline constexpr bool is_variables = false;

} // namespace detail

/// Ordered variables of differentiation; made by `wrt`.
template <class... Symbols>
struct variables {
  /// Motions of the variables, one for each column; rotations and poses move in a frame.
  template <class Frame>
  using motions_in = boost::mp11::mp_append<detail::motion_list<>,
                                            typename detail::directions<Symbols, Frame>::type...>;
  using motions = motions_in<void>;
};

namespace detail {

template <class... Symbols>
inline constexpr bool is_variables<variables<Symbols...>> = true;

/// Arguments that do not begin with `variables`.
template <class... X>
concept NoVariables = sizeof...(X) == 0 || !is_variables<std::tuple_element_t<0, std::tuple<X...>>>;

} // namespace detail

/// Variables of differentiation u, w …, whose order is that of the columns of a Jacobian. A scalar
/// has one column, a vector or a rotation three, a dual vector n + εm, in the order [m; n], or a
/// pose six, a matrix one for each entry, column by column.
template <Symbol... U>
  requires(sizeof...(U) > 0)
[[nodiscard]] constexpr variables<typename U::node_type...> wrt(const U&...) { return {}; }
template <class... X>
  requires(sizeof...(X) == 0 || (!Symbol<X> || ...))
DUET_REFUSED("wrt(u, w) takes symbols, as symbol<\"u\"> u")
variables<> wrt(const X&...);

} // namespace duet::expression
