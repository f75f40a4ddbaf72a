// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/number_text.hpp>
#include <duet/expression/node.hpp>

#include <boost/mp11/set.hpp>

#include <concepts>
#include <string>
#include <type_traits>

/// \file
/// What a formula holds beside its type: the values of the constants in it, and by their types all
/// symbols it was written with, those that simplification removed included.

namespace duet::expression {

/// A constant of a place in the code, and what its value is held in.
template <class ConstantNode, class T>
struct held_constant {};

namespace detail {

/// A symbol: nothing to hold.
template <class Item>
struct holding {};
template <class ConstantNode, class T>
struct holding<held_constant<ConstantNode, T>> {
  T value;
};

} // namespace detail

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
  throw invalid_input("duet: a formula: one place in the code made two constants" + values +
                      ", which would be taken for one; make what changes a symbol");
}

/// An item of what either holds; instantiated for the item, not for all that is held beside it.
template <bool IsInFirst, bool IsInSecond>
struct chosen;
template <>
struct chosen<false, true> {
  template <class Item>
  [[nodiscard]] static constexpr const holding<Item>& of(const void*, const holding<Item>* b) {
    return *b;
  }
};
template <>
struct chosen<true, false> {
  template <class Item>
  [[nodiscard]] static constexpr const holding<Item>& of(const holding<Item>* a, const void*) {
    return *a;
  }
};
template <>
struct chosen<true, true> {
  template <class Item>
  [[nodiscard]] static constexpr const holding<Item>& of(const holding<Item>* a,
                                                         const holding<Item>* b) {
    if constexpr (!std::is_empty_v<holding<Item>>) {
      if (!are_same_value(a->value, b->value)) {
        refuse(a->value, b->value);
      }
    }
    return *a;
  }
};

template <class... Items, class A, class B>
[[nodiscard]] constexpr held<Items...> merged_into(held<Items...>*, const A& a, const B& b) {
  return {chosen<std::is_base_of_v<holding<Items>, A>,
                 std::is_base_of_v<holding<Items>, B>>::template of<Items>(&a, &b)...};
}

} // namespace detail

/// What either holds. \throws invalid_input where one place in the code, as in a function that was
/// called twice, made constants of different values
template <class A, class B>
[[nodiscard]] constexpr auto merged(const A& a, const B& b) {
  if constexpr (std::is_same_v<A, B> && std::is_empty_v<A>) {
    return a;
  } else {
    using all = boost::mp11::mp_set_union<A, B>;
    return detail::merged_into(static_cast<all*>(nullptr), a, b);
  }
}

template <class A, class B, class C, class... Rest>
[[nodiscard]] constexpr auto merged(const A& a, const B& b, const C& c, const Rest&... rest) {
  return merged(merged(a, b), c, rest...);
}
template <class A>
[[nodiscard]] constexpr A merged(const A& a) {
  return a;
}

} // namespace duet::expression
