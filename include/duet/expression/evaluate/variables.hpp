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
/// Components of n + εm in the order [m; n], that of twists.
template <class Symbol, class Frame>
struct directions<Symbol, Frame, kind::dual_vector> {
  using type = moving_along_axes<Symbol, kind::dual_vector, 3, 4, 5, 0, 1, 2>;
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
