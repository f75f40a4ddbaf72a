// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/node.hpp>

#include <boost/mp11/algorithm.hpp>
#include <boost/mp11/list.hpp>

#include <type_traits>
#include <utility>

/// \file
/// All different nodes of some formulas in one list, operands first, and their places in it.

namespace duet::expression::detail {

namespace mp11 = boost::mp11;

template <class Node>
struct listed {};

// While the list grows, every node is a base: whether one is there, the compiler knows without
// looking through a list of types.
struct no_nodes {};
template <class Before, class Node>
struct followed_by : Before, listed<Node> {};

template <class Nodes, class Node, bool IsThere = std::is_base_of_v<listed<Node>, Nodes>>
struct with_node {
  using type = Nodes;
};
template <class Nodes, class Node>
using with_node_t = typename with_node<Nodes, Node>::type;

/// With what a node needs.
template <class Nodes, class Node>
struct with_operands {
  using type = Nodes;
};
template <class Nodes, class Operation, class... Operands>
struct with_operands<Nodes, applied_node<Operation, Operands...>> {
  using type = mp11::mp_fold<mp11::mp_list<Operands...>, Nodes, with_node_t>;
};
template <class Nodes, class Node>
struct with_node<Nodes, Node, false> {
  using type = followed_by<typename with_operands<Nodes, Node>::type, Node>;
};

/// One address for each type: to look for it costs compilers less than to deduce a base.
template <class T>
inline constexpr char identity = 0;

/// Where one of them stands among some that end with a null pointer, -1 if nowhere.
[[nodiscard]] constexpr int place_among(const char* const* all, const char* one) {
  for (int i = 0; all[i] != nullptr; ++i) {
    if (all[i] == one) {
      return i;
    }
  }
  return -1;
}

/// Nodes in an order.
template <class... Nodes>
class node_list {
  static constexpr const char* identities[] = {&identity<Nodes>..., nullptr};

public:
  using places = std::make_integer_sequence<int, int(sizeof...(Nodes))>;
  /// The number of a node, -1 of others.
  template <class Node>
  static constexpr int place = place_among(identities, &identity<Node>);
};

template <class Grown, class... Nodes>
struct in_order;
template <class... Nodes>
struct in_order<no_nodes, Nodes...> {
  using type = node_list<Nodes...>;
};
template <class Before, class Node, class... Nodes>
struct in_order<followed_by<Before, Node>, Nodes...> : in_order<Before, Node, Nodes...> {};
template <class Before, class A, class B, class C, class D, class... Nodes>
struct in_order<followed_by<followed_by<followed_by<followed_by<Before, A>, B>, C>, D>, Nodes...>
    : in_order<Before, A, B, C, D, Nodes...> {};

/// The nodes that some need, and themselves.
template <class... Roots>
using nodes_of =
    typename in_order<mp11::mp_fold<mp11::mp_list<Roots...>, no_nodes, with_node_t>>::type;

} // namespace duet::expression::detail
