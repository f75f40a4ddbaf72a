// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/expression/derivative.hpp>
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
  using type = motion_list<movement_of_scalar<Symbol>>;
};

template <class Symbol, kind K, int... I>
using moving_along_axes = motion_list<movement<moving<Symbol, unit_vector_node<K, I>>>...>;

template <class Symbol, class Frame>
struct directions<Symbol, Frame, kind::vector> {
  using type = moving_along_axes<Symbol, kind::vector, 0, 1, 2>;
};
/// In the order of [m; n], that of twists.
template <class Symbol, class Frame>
struct directions<Symbol, Frame, kind::dual_vector> {
  using type = moving_along_axes<Symbol, kind::dual_vector, 3, 4, 5, 0, 1, 2>;
};

template <class T>
inline constexpr bool is_variables = false;

} // namespace detail

/// Variables in an order; made by `wrt`.
template <class... Symbols>
struct variables {
  /// How they move, where rotations and poses move in a frame.
  template <class Frame>
  using motions_in = boost::mp11::mp_append<detail::motion_list<>,
                                            typename detail::directions<Symbols, Frame>::type...>;
  using motions = motions_in<void>;
};

namespace detail {

template <class... Symbols>
inline constexpr bool is_variables<variables<Symbols...>> = true;

/// What is called as `wrt` says is.
template <class... X>
concept NoVariables = sizeof...(X) == 0 || !is_variables<std::tuple_element_t<0, std::tuple<X...>>>;

} // namespace detail

/// With respect to u, w …: the columns of a Jacobian in this order. They are one for a scalar,
/// three for a vector or a rotation, six for a dual vector n + εm, in the order [m; n], or a pose,
/// one for each entry of a matrix, column by column.
template <Symbol... U>
  requires(sizeof...(U) > 0)
[[nodiscard]] constexpr variables<typename U::node_type...> wrt(const U&...) { return {}; }
template <class... X>
  requires(sizeof...(X) == 0 || (!Symbol<X> || ...))
DUET_REFUSED("wrt(u, w) takes symbols, as symbol<\"u\"> u")
variables<> wrt(const X&...);

} // namespace duet::expression
