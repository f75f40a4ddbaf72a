// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/type_id.hpp>
#include <duet/core/compiler/types.hpp>
#include <duet/core/config.hpp>
#include <duet/expression/tape/builder.hpp>
#include <duet/expression/tree/held.hpp>
#include <duet/expression/tree/node.hpp>

#include <boost/mp11/algorithm.hpp>
#include <boost/mp11/list.hpp>

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

/// \file
/// Conversion of the nodes of a formula, which are types, to entries of a tape.

namespace duet::expression {

template <kind K, int I>
struct unit_vector_node;

namespace op {

struct negative;
struct sum;
struct difference;
struct product;
struct quotient;
struct slope_product;
struct sin;
struct cos;
template <int Exponent>
struct whole_power;
template <bool Dual>
struct part_of_dual;
struct rotation;
struct translation;

} // namespace op
} // namespace duet::expression

namespace duet::expression::detail {

/// Computes a hash of the name of a type. Types of equal hash are distinguished by address.
template <class T>
[[nodiscard]] constexpr unsigned hash_of_name() {
  const std::string_view name = duet::detail::type_text<T>();
  unsigned hash = unsigned(name.size());
  for (std::size_t i = 60; i < name.size(); ++i) {
    hash = 33 * hash + unsigned(static_cast<unsigned char>(name[i]));
  }
  return hash;
}
template <class T>
inline constexpr unsigned name_hash = hash_of_name<T>();

/// Operations of one code each, from `tape_code::negative` on.
using coded_operations = boost::mp11::mp_list<op::negative, op::sum, op::difference, op::product,
                                              op::quotient, op::slope_product>;
/// Code of an operation.
template <class Operation>
inline constexpr tape_code
    code_of = boost::mp11::mp_contains<coded_operations, Operation>::value
                  ? tape_code(int(tape_code::negative) +
                              int(boost::mp11::mp_find<coded_operations, Operation>::value))
                  : tape_code::other;
template <>
inline constexpr tape_code code_of<op::sin> = tape_code::sine;
template <>
inline constexpr tape_code code_of<op::cos> = tape_code::cosine;
template <int Exponent>
inline constexpr tape_code code_of<op::whole_power<Exponent>> = tape_code::power;
template <class Operation>
inline constexpr int exponent_of_operation = 0;
template <int Exponent>
inline constexpr int exponent_of_operation<op::whole_power<Exponent>> = Exponent;

/// The operation of a code, of a power with its exponent.
template <tape_code Code, int Parameter>
struct operation_of_code {
  using type =
      boost::mp11::mp_at_c<coded_operations, std::size_t(Code) - std::size_t(tape_code::negative)>;
};
template <int Parameter>
struct operation_of_code<tape_code::power, Parameter> {
  using type = op::whole_power<Parameter>;
};

/// True for operations that take the parts of dual numbers with lines and motions apart.
template <class Operation>
inline constexpr bool drops_dual = false;
template <bool Dual>
inline constexpr bool drops_dual<op::part_of_dual<Dual>> = true;
template <>
inline constexpr bool drops_dual<op::rotation> = true;
template <>
inline constexpr bool drops_dual<op::translation> = true;

template <class Operation>
[[nodiscard]] constexpr unsigned operation_hash() {
  if constexpr (code_of<Operation> == tape_code::other) {
    return name_hash<Operation>;
  } else {
    return unsigned(code_of<Operation>) + 64 * unsigned(exponent_of_operation<Operation>);
  }
}

/// An operation whose rates can be made `Order` times.
template <class Operation, int Order, kind... K>
struct rate_on_tape;
template <class Operation, int Order, kind... K>
[[nodiscard]] constexpr tape_operation operation_on_tape() {
  static_assert(sizeof(duet::detail::registered_type<Operation>) > 0);
  tape_operation result = {&duet::detail::type_id<Operation>, name_hash<Operation>, nullptr,
                           drops_dual<Operation>};
  if constexpr (Order > 0) {
    result.rate = &rate_on_tape<Operation, Order, K...>::make;
  }
  return result;
}

/// Adds an operation that is not simplified.
template <class Operation, int Order, kind... K>
[[nodiscard]] constexpr int add_operation(tape_builder& tape, const int (&x)[sizeof...(K)]) {
  constexpr kind k = Operation::kind_of(K...);
  constexpr tape_code code = code_of<Operation>;
  if constexpr (code == tape_code::power) {
    return tape.power(x[0], exponent_of_operation<Operation>);
  } else if constexpr (code == tape_code::other) {
    return tape.other(k, operation_on_tape<Operation, Order, K...>(), x, int(sizeof...(K)));
  } else if constexpr (sizeof...(K) == 1) {
    return tape.plain(code, k, x[0]);
  } else {
    return tape.plain(code, k, x[0], x[1]);
  }
}

// Conversion of nodes.

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

/// True for the kinds of nodes that are differentiated on the tape; others are as types.
[[nodiscard]] constexpr bool is_kind_on_tape(kind k) {
  return k == kind::scalar || k == kind::condition || k == kind::vector;
}

/// Converts a node to an entry of a tape, here a leaf without a code.
template <class Node>
struct recipe {
  static constexpr bool is_differentiated = is_kind_on_tape(Node::kind_of);
  template <class Held>
  static constexpr unsigned hash = name_hash<Node>;
  template <int Order, class Held>
  static constexpr int add(tape_builder& tape) {
    static_assert(sizeof(duet::detail::registered_type<Node>) > 0);
    return tape.other(Node::kind_of, {&duet::detail::type_id<Node>, hash<Held>, nullptr}, nullptr,
                      0);
  }
};
template <std::uint64_t Bits>
struct recipe<number_node<Bits>> {
  static constexpr bool is_differentiated = true;
  template <class Held>
  static constexpr unsigned hash = unsigned(Bits >> 32) ^ unsigned(Bits);
  template <int, class>
  static constexpr int add(tape_builder& tape) {
    return tape.number(number_node<Bits>::value);
  }
};
template <kind K, int I>
struct recipe<unit_vector_node<K, I>> {
  static constexpr bool is_differentiated = is_kind_on_tape(K);
  template <class Held>
  static constexpr unsigned hash = 64 * unsigned(K) + unsigned(I);
  template <int, class>
  static constexpr int add(tape_builder& tape) {
    return tape.unit_vector(K, I);
  }
};
template <kind K>
struct recipe<zero_node<K>> {
  static constexpr bool is_differentiated = is_kind_on_tape(K);
  template <class Held>
  static constexpr unsigned hash = unsigned(K);
  template <int, class>
  static constexpr int add(tape_builder& tape) {
    return tape.zero(K);
  }
};
template <kind K, char... Letters>
struct recipe<symbol_node<K, Letters...>> {
  static constexpr bool is_differentiated = is_kind_on_tape(K);
  template <class Held>
  static constexpr unsigned hash = [] {
    unsigned result = unsigned(K);
    ((result = 31 * result + unsigned(static_cast<unsigned char>(Letters))), ...);
    return result;
  }();
  template <int, class Held>
  static constexpr int add(tape_builder& tape) {
    return tape.input(K, item_index<symbol_node<K, Letters...>, Held>);
  }
};
template <kind K, class Tag>
struct recipe<constant_node<K, Tag>> {
  static constexpr bool is_differentiated = is_kind_on_tape(K);
  template <class Held>
  static constexpr unsigned hash = unsigned(item_index<constant_node<K, Tag>, Held>);
  template <int, class Held>
  static constexpr int add(tape_builder& tape) {
    return tape.input(K, -1 - item_index<constant_node<K, Tag>, Held>);
  }
};
template <class Operation, class... X>
struct recipe<applied_node<Operation, X...>> {
  static constexpr bool is_differentiated =
      is_kind_on_tape(Operation::kind_of(X::kind_of...)) && (recipe<X>::is_differentiated && ...);
  template <class Held>
  static constexpr unsigned hash = [] {
    unsigned result = operation_hash<Operation>();
    ((result = 31 * result + recipe<X>::template hash<Held>), ...);
    return result;
  }();
  template <int Order, class Held>
  static constexpr int add(tape_builder& tape) {
    constexpr const char* id = &duet::detail::type_id<applied_node<Operation, X...>>;
    const int known = tape.recalled(hash<Held>, id);
    if (known >= 0) {
      return known;
    }
    const int x[] = {recipe<X>::template add<Order, Held>(tape)...};
    return tape.remember(hash<Held>, id, add_operation<Operation, Order, X::kind_of...>(tape, x));
  }
};

} // namespace duet::expression::detail
