// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/derivative.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/function.hpp>
#include <duet/expression/tree/node.hpp>

#include <boost/mp11/algorithm.hpp>
#include <boost/mp11/list.hpp>

#include <cstddef>
#include <type_traits>
#include <utility>

/// \file
/// Formulas as they are written: with derivatives of functions, which are evaluated by rules, put
/// together from other functions.

namespace duet::expression::detail {

template <class Node>
inline constexpr bool has_partial = false;
template <class Operation, class... X>
inline constexpr bool has_partial<applied_node<Operation, X...>> = (has_partial<X> || ...);
template <class Function, int... Orders, class... X>
inline constexpr bool has_partial<applied_node<op::partial<Function, Orders...>, X...>> = true;

/// What stands for the K-th argument of a function while its derivative is derived.
template <int K, class X>
using stand_in = std::conditional_t<is_number<X>, X, symbol_node<kind::scalar, '\0', char(K)>>;

/// A node with the arguments of a list in place of what stands for them.
template <class Node, class Arguments>
struct substituted {
  using type = Node;
};
template <char K, class Arguments>
struct substituted<symbol_node<kind::scalar, '\0', K>, Arguments> {
  using type = boost::mp11::mp_at_c<Arguments, std::size_t(K)>;
};
template <class Operation, class... X, class Arguments>
struct substituted<applied_node<Operation, X...>, Arguments> {
  using type = decltype(apply<Operation>(typename substituted<X, Arguments>::type{}...));
};

template <class Node, bool HasPartial = has_partial<Node>>
struct written {
  using type = Node;
};
template <class Node>
using written_t = typename written<Node>::type;
template <class Operation, class... X>
struct written<applied_node<Operation, X...>, true> {
  using type = decltype(apply<Operation>(written_t<X>{}...));
};

/// Of a function's derivative.
template <class Function, class Numbers, int... Orders>
struct written_partial;
template <class Function, int... K, int... Orders>
struct written_partial<Function, std::integer_sequence<int, K...>, Orders...> {
  static constexpr int argument = op::partial<Function, Orders...>::last_argument;

  template <class... X>
  static constexpr auto of(X... x) {
    if constexpr ((0 + ... + Orders) == 1 && sizeof...(X) == 1) {
      return Function::written_slope(x...);
    } else if constexpr ((0 + ... + Orders) == 1) {
      return Function::template written_slope<argument>(x...);
    } else {
      using lower = written_partial<Function, std::integer_sequence<int, K...>,
                                    (Orders - int(K == argument))...>;
      using symbols = boost::mp11::mp_list<stand_in<K, X>...>;
      using moving = movement_of_scalar<boost::mp11::mp_at_c<symbols, std::size_t(argument)>>;
      using slope = rate_t<decltype(lower::of(stand_in<K, X>{}...)), moving>;
      return typename substituted<written_t<slope>, boost::mp11::mp_list<X...>>::type{};
    }
  }
};
template <class Function, int... Orders, class Value, class... X>
struct written<applied_node<op::partial<Function, Orders...>, Value, X...>, true> {
  static constexpr auto make() {
    using partial =
        written_partial<Function, std::make_integer_sequence<int, int(sizeof...(Orders))>,
                        Orders...>;
    return partial::of(written_t<X>{}...);
  }
  using type = decltype(make());
};

} // namespace duet::expression::detail
