// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/derivative.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/vector.hpp>

#include <boost/mp11/list.hpp>

#include <type_traits>

/// \file
/// By which symbols a formula is differentiated, and in which directions each of them moves.

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

template <class Symbol, class Frame>
struct directions<Symbol, Frame, kind::vector> {
  using type = motion_list<movement<moving<Symbol, unit_vector_node<kind::vector, 0>>>,
                           movement<moving<Symbol, unit_vector_node<kind::vector, 1>>>,
                           movement<moving<Symbol, unit_vector_node<kind::vector, 2>>>>;
};

/// In the order of [m; n], that of twists.
template <class Symbol, class Frame>
struct directions<Symbol, Frame, kind::dual_vector> {
  using type = motion_list<movement<moving<Symbol, unit_vector_node<kind::dual_vector, 3>>>,
                           movement<moving<Symbol, unit_vector_node<kind::dual_vector, 4>>>,
                           movement<moving<Symbol, unit_vector_node<kind::dual_vector, 5>>>,
                           movement<moving<Symbol, unit_vector_node<kind::dual_vector, 0>>>,
                           movement<moving<Symbol, unit_vector_node<kind::dual_vector, 1>>>,
                           movement<moving<Symbol, unit_vector_node<kind::dual_vector, 2>>>>;
};

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

/// With respect to u, w …: the columns of a Jacobian in this order, one for a scalar, three for a
/// vector or a rotation, six for a dual vector n + εm, in the order [m; n], or a pose, one for each
/// entry of a matrix, column by column.
template <Symbol... U>
[[nodiscard]] constexpr variables<typename U::node_type...> wrt(const U&...) {
  static_assert(sizeof...(U) > 0, "duet: wrt needs at least one symbol");
  return {};
}

} // namespace duet::expression
