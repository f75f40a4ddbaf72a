// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/type_id.hpp>
#include <duet/core/compiler/types.hpp>
#include <duet/core/config.hpp>
#include <duet/expression/tape/builder.hpp>
#include <duet/expression/tape/term.hpp>
#include <duet/expression/tree/held.hpp>
#include <duet/expression/tree/node.hpp>

#include <cstdint>
#include <utility>

/// \file
/// Conversion of the nodes of a formula, which are types, to entries of a tape.

namespace duet::expression {

template <kind K, int I>
struct unit_vector_node;

} // namespace duet::expression

namespace duet::expression::detail {

template <class Item>
struct item_node {
  using type = Item;
};
template <class Node, class T>
struct item_node<held_constant<Node, T>> {
  using type = Node;
};

/// Index of an item in the list of what a formula holds.
template <class Node, class Held>
inline constexpr int item_index = -1;
template <class Node, class... Items>
inline constexpr int item_index<Node, held<Items...>> = [] {
  int i = 0;
  static_cast<void>(((DUET_IS_SAME(Node, typename item_node<Items>::type) || (++i, false)) || ...));
  return i;
}();

/// Converts a node to an entry of a tape, here a leaf without a code.
template <class Node>
struct recipe {
  template <class Held>
  static constexpr unsigned hash = name_hash<Node>;
  template <class Use, class Held>
  static constexpr int add(tape_builder& tape) {
    return tape.other(Node::kind_of, operation_on_tape<Node, leaf_use<Use>, std::index_sequence<>>,
                      nullptr, 0);
  }

private:
  template <class Use>
  using leaf_use = tape_use<0, Use::is_printed>;
};
template <std::uint64_t Bits>
struct recipe<number_node<Bits>> {
  template <class Held>
  static constexpr unsigned hash = unsigned(Bits >> 32) ^ unsigned(Bits);
  template <class, class>
  static constexpr int add(tape_builder& tape) {
    return tape.number(number_node<Bits>::value);
  }
};
template <kind K, int I>
struct recipe<unit_vector_node<K, I>> {
  template <class Held>
  static constexpr unsigned hash = 64 * unsigned(K) + unsigned(I);
  template <class, class>
  static constexpr int add(tape_builder& tape) {
    return tape.unit_vector(K, I);
  }
};
template <kind K>
struct recipe<zero_node<K>> {
  template <class Held>
  static constexpr unsigned hash = unsigned(K);
  template <class, class>
  static constexpr int add(tape_builder& tape) {
    return tape.zero(K);
  }
};
template <kind K, char... Letters>
struct recipe<symbol_node<K, Letters...>> {
  template <class Held>
  static constexpr unsigned hash = [] {
    unsigned result = unsigned(K);
    ((result = 31 * result + unsigned(static_cast<unsigned char>(Letters))), ...);
    return result;
  }();
  template <class, class Held>
  static constexpr int add(tape_builder& tape) {
    return tape.input(K, item_index<symbol_node<K, Letters...>, Held>);
  }
};
template <kind K, class Tag>
struct recipe<constant_node<K, Tag>> {
  template <class Held>
  static constexpr unsigned hash = unsigned(item_index<constant_node<K, Tag>, Held>);
  template <class, class Held>
  static constexpr int add(tape_builder& tape) {
    return tape.input(K, -1 - item_index<constant_node<K, Tag>, Held>);
  }
};
template <class Operation, class... X>
struct recipe<applied_node<Operation, X...>> {
  template <class Held>
  static constexpr unsigned hash = [] {
    unsigned result = code_of<Operation> == tape_code::other
                          ? name_hash<Operation>
                          : unsigned(code_of<Operation>) + 64 * unsigned(parameter_of<Operation>);
    ((result = 31 * result + recipe<X>::template hash<Held>), ...);
    return result;
  }();
  template <class Use, class Held>
  static constexpr int add(tape_builder& tape) {
    constexpr const duet::detail::type_mark* id =
        &duet::detail::type_id<applied_node<Operation, X...>>;
    const int known = tape.recalled(hash<Held>, id, Use::order);
    if (known >= 0) {
      return known;
    }
    const int x[] = {recipe<X>::template add<Use, Held>(tape)...};
    return tape.remember(hash<Held>, id, Use::order,
                         apply_on_tape<Operation, Use>(tape, x, std::index_sequence_for<X...>{}));
  }
};

} // namespace duet::expression::detail
