// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/types.hpp>
#include <duet/expression/tree/node.hpp>

#include <boost/mp11/algorithm.hpp>
#include <boost/mp11/list.hpp>

#include <type_traits>
#include <utility>

/// \file
/// List of all different nodes of some formulas, operands first, and the indices of nodes in it.

namespace duet::expression::detail {

namespace mp11 = boost::mp11;

template <class Node>
struct listed {};

// While the list grows, each node is a base class: std::is_base_of finds one faster than a search
// in a list of types.
struct no_nodes {};
template <class Before, class Node>
struct followed_by : Before, listed<Node> {};

/// Nodes with a node and its operands appended, unless it is there already.
template <class Nodes, class Node, bool IsThere = std::is_base_of_v<listed<Node>, Nodes>>
struct with_node {
  using type = Nodes;
};
template <class Nodes, class Node>
using with_node_t = typename with_node<Nodes, Node>::type;

/// Nodes with the operands of a node appended.
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

/// Index of the first value that is true, or -1.
[[nodiscard]] constexpr int index_of_true(const bool* all, int count) {
  for (int i = 0; i < count; ++i) {
    if (all[i]) {
      return i;
    }
  }
  return -1;
}

/// Ordered list of nodes.
template <class... Nodes>
class node_list {
  static constexpr int count = int(sizeof...(Nodes));
  // The comparison of types is built into compilers: it is faster than deducing a base class and,
  // unlike a comparison of addresses, constant under sanitizers, too. The last entry avoids an
  // empty array.
  template <class Node>
  static constexpr bool is_it[] = {DUET_IS_SAME(Nodes, Node)..., false};

public:
  using indices = std::make_integer_sequence<int, count>;
  /// Index of a node, or -1 if it is not in the list.
  template <class Node>
  static constexpr int index = index_of_true(is_it<Node>, count);
};

/// A grown list as a `node_list`, four nodes in a step.
template <class Grown, class... Nodes>
struct evaluation_order;
template <class... Nodes>
struct evaluation_order<no_nodes, Nodes...> {
  using type = node_list<Nodes...>;
};
template <class Before, class Node, class... Nodes>
struct evaluation_order<followed_by<Before, Node>, Nodes...>
    : evaluation_order<Before, Node, Nodes...> {};
template <class Before, class A, class B, class C, class D, class... Nodes>
struct evaluation_order<followed_by<followed_by<followed_by<followed_by<Before, A>, B>, C>, D>,
                        Nodes...> : evaluation_order<Before, A, B, C, D, Nodes...> {};

/// The list of some nodes and all their operands, operands first.
template <class... Roots>
using nodes_of =
    typename evaluation_order<mp11::mp_fold<mp11::mp_list<Roots...>, no_nodes, with_node_t>>::type;

} // namespace duet::expression::detail
