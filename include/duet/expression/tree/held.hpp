// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/expression/tree/node.hpp>

#include <boost/mp11/algorithm.hpp>
#include <boost/mp11/list.hpp>

#include <concepts>
#include <string>
#include <type_traits>

/// \file
/// Constants of a formula with their values, and, as types, all symbols it was written with, even
/// those that simplification removed. For those who extend duet.

namespace duet::expression {

/// A constant as an item of `held`, and the type of its value.
template <class ConstantNode, class T>
struct held_constant {};

namespace detail {

/// Storage for an item of a formula: the value of a constant, nothing for a symbol.
template <class Item>
struct holding {};
template <class ConstantNode, class T>
struct holding<held_constant<ConstantNode, T>> {
  T value;
};

} // namespace detail

/// The constants of a formula and the symbols it was written with.
template <class... Items>
struct held : detail::holding<Items>... {};

namespace detail {

template <class T>
[[nodiscard]] constexpr bool are_same_value(const T& a, const T& b) {
  return a == b || (a != a && b != b);
}

template <class T>
void refuse(const T& a, const T& b) {
  std::string values;
  if constexpr (std::floating_point<T>) {
    values = ", " + to_text(a) + " and " + to_text(b);
  }
  duet::detail::raise(invalid_input("duet: a formula: one place in the code made two constants" +
                                    values +
                                    ", which would be taken for one; make what changes a symbol"));
}

/// Raises `invalid_input` if a constant has different values in a and b.
template <class Item, class A, class B>
constexpr void require_same_value(const A& a, const B& b) {
  if constexpr (!std::is_empty_v<holding<Item>> && std::is_base_of_v<holding<Item>, A>) {
    const holding<Item>& first = a;
    const holding<Item>& second = b;
    if (!are_same_value(first.value, second.value)) {
      refuse(first.value, second.value);
    }
  }
}

/// List of an item, empty if A holds it already.
template <class A, class Item>
using if_new = boost::mp11::mp_if_c<std::is_base_of_v<holding<Item>, A>, boost::mp11::mp_list<>,
                                    boost::mp11::mp_list<Item>>;

template <class... InA, class... InB, class... New>
[[nodiscard]] constexpr held<InA..., New...>
merged_with(const held<InA...>& a, const held<InB...>& b, boost::mp11::mp_list<New...>) {
  (require_same_value<InB>(a, b), ...);
  return {static_cast<const holding<InA>&>(a)..., static_cast<const holding<New>&>(b)...};
}

} // namespace detail

/// Constants and symbols that a or b holds.
///
/// \throws invalid_input if one constant has two values, as in formulas of a function that was
/// called with different numbers
template <class... InA, class... InB>
[[nodiscard]] constexpr auto merged(const held<InA...>& a, const held<InB...>& b) {
  using added =
      boost::mp11::mp_append<boost::mp11::mp_list<>, detail::if_new<held<InA...>, InB>...>;
  return detail::merged_with(a, b, added{});
}

[[nodiscard]] constexpr auto merged(const auto& a, const auto& b, const auto& c,
                                    const auto&... rest) {
  return merged(merged(a, b), c, rest...);
}
[[nodiscard]] constexpr auto merged(const auto& a) { return a; }

} // namespace duet::expression
