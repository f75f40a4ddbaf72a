// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/expression/evaluate/given.hpp>
#include <duet/expression/tree/held.hpp>
#include <duet/expression/tree/node.hpp>

#include <type_traits>

/// \file
/// Arguments by name, and what the compiler says of those that are missing, unknown or double.

namespace duet::expression::detail {

template <class T>
inline constexpr bool is_argument = false;
template <class Symbol, class T>
inline constexpr bool is_argument<argument<Symbol, T>> = true;

template <class Symbol, class... Arguments>
inline constexpr int times_given = (0 + ... +
                                    int(std::is_same_v<Symbol, typename Arguments::symbol_type>));

template <class Item, class... Arguments>
inline constexpr bool has_value = true; // a constant
template <kind K, char... Letters, class... Arguments>
inline constexpr bool has_value<symbol_node<K, Letters...>, Arguments...> =
    times_given<symbol_node<K, Letters...>, Arguments...> > 0;

template <class Item, class... Arguments>
[[nodiscard]] constexpr bool require_value() {
  static_assert(has_value<Item, Arguments...>,
                "duet: a symbol of the formula has no value; say f(u = 0.3, ...) with all of them");
  return has_value<Item, Arguments...>;
}

template <class Argument, class Held, class... Arguments>
[[nodiscard]] constexpr bool require_known_once() {
  using symbol = typename Argument::symbol_type;
  constexpr bool is_known = std::is_base_of_v<holding<symbol>, Held>;
  constexpr bool is_single = times_given<symbol, Arguments...> == 1;
  static_assert(is_known, "duet: a value is given for a symbol that the formula does not have");
  static_assert(is_single, "duet: two values are given for one symbol");
  return is_known && is_single;
}

template <class Held>
struct call_of;
template <class... Items>
struct call_of<held<Items...>> {
  /// Every symbol that the formula was written with has one value, and nothing else has.
  template <class... Arguments>
  [[nodiscard]] static constexpr bool is_complete() {
    constexpr bool by_name = (is_argument<Arguments> && ...);
    static_assert(by_name, "duet: formulas are called by name, as f(u = 0.3)");
    if constexpr (by_name) {
      constexpr bool known = (require_known_once<Arguments, held<Items...>, Arguments...>() && ...);
      constexpr bool given = (require_value<Items, Arguments...>() && ...);
      return known && given;
    } else {
      return false;
    }
  }
};

/// What is made of a formula and called by name as the formula is: `Made::of` of its node where
/// `given` holds values that are complete.
template <class Made, class F>
class called_by_name {
public:
  constexpr explicit called_by_name(const F& f) : f_(f) {}

  template <class... Arguments>
  [[nodiscard]] DUET_ALWAYS_INLINE auto operator()(const Arguments&... arguments) const {
    using held = typename F::held_type;
    if constexpr (call_of<held>::template is_complete<Arguments...>()) {
      using node = typename F::node_type;
      return Made::template of<node>(given<held, Arguments...>{f_.held(), arguments...});
    }
  }

private:
  F f_;
};

} // namespace duet::expression::detail
