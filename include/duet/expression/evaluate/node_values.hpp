// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/vector_sine_cosine.hpp>
#include <duet/core/config.hpp>
#include <duet/dual/rules/elementary.hpp>
#include <duet/expression/evaluate/bindings.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/node_list.hpp>

#include <boost/mp11/algorithm.hpp>
#include <boost/mp11/list.hpp>

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>

/// \file
/// Evaluation of formulas: all different nodes in one list, operands first, each evaluated once.
/// Each stage first computes all sines and cosines whose arguments are known, together.
///
/// Nodes are identified by their indices in the list: functions whose names contain long lists of
/// types would take most of the compile time.

namespace duet::expression {

namespace op {

struct sin;
struct cos;

} // namespace op

namespace detail {

/// Values of nodes by index: in an array if they have one type, otherwise each in a base class.
template <int I, class T>
struct slot {
  T value;
};
template <class Indices, class... T>
struct different_slots;
template <int... I, class... T>
struct different_slots<std::integer_sequence<int, I...>, T...> : slot<I, T>... {};
template <class T, int Count>
struct equal_slots {
  T values[std::size_t(Count)];
};

template <class Indices, class... T>
struct slots {
  using type = different_slots<Indices, T...>;
};
template <class Indices, class T, class... Rest>
  requires std::is_same_v<mp11::mp_list<T, Rest...>, mp11::mp_list<Rest..., T>>
struct slots<Indices, T, Rest...> {
  using type = equal_slots<T, int(Indices::size())>;
};

template <int I, class T>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr T& value_at(slot<I, T>& s) {
  return s.value;
}
template <int I, class T, int Count>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr T& value_at(equal_slots<T, Count>& s) {
  return s.values[I];
}

/// Values of all nodes, of which those with the indices I … are accessible.
template <class Slots, int... I>
struct chosen_values : Slots {
  template <int K>
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr auto& get() {
    constexpr int indices[] = {I...};
    return value_at<indices[K]>(static_cast<Slots&>(*this));
  }
  /// Calls f for Count of the accessible values, from the First-th on.
  template <int First, int Count, class F>
  DUET_ALWAYS_INLINE constexpr void each(const F& f) {
    [&]<int... K>(std::integer_sequence<int, K...>) DUET_INLINE_LAMBDA {
      (f(get<First + K>()), ...);
    }
    (std::make_integer_sequence<int, Count>{});
  }
};

/// Stage in which a node is evaluated: the depth to which sines and cosines are nested in it.
template <class Node>
inline constexpr int stage_of = 0;
template <class Operation, class... Operands>
inline constexpr int
    stage_of<applied_node<Operation, Operands...>> = std::max({stage_of<Operands>...});
template <class X>
inline constexpr int stage_of<applied_node<op::sin, X>> = stage_of<X> + 1;
template <class X>
inline constexpr int stage_of<applied_node<op::cos, X>> = stage_of<X> + 1;

/// Sets the I-th value to that of an operation on other values.
template <int I, class Operation, int... Operands>
struct instruction {
  template <class Slots>
  DUET_ALWAYS_INLINE static constexpr void run(Slots& s) {
    value_at<I>(s) = Operation::value(std::as_const(value_at<Operands>(s))...);
  }
};

/// Computes sine, cosine or both of the I-th value. The index of a result that is not needed is −1.
template <int I, int Sine, int Cosine>
struct sine_instruction {
  template <class Slots>
  DUET_ALWAYS_INLINE static constexpr void run(Slots& s) {
    const auto& x = value_at<I>(s);
    if constexpr (Cosine < 0) {
      value_at<Sine>(s) = duet::rule::sin{}.value(x);
    } else if constexpr (Sine < 0) {
      value_at<Cosine>(s) = duet::rule::cos{}.value(x);
    } else {
      const auto y = duet::detail::sine_and_cosine_of(x);
      set(s, y.sine, y.cosine);
    }
  }
  template <class Slots, class T>
  DUET_ALWAYS_INLINE static constexpr void set(Slots& s, const T& sine, const T& cosine) {
    if constexpr (Sine >= 0) {
      value_at<Sine>(s) = sine;
    }
    if constexpr (Cosine >= 0) {
      value_at<Cosine>(s) = cosine;
    }
  }
};

/// Instructions for a node in a stage.
template <class List, int Stage, class Node>
struct work {
  using operations = mp11::mp_list<>;
  using sines = mp11::mp_list<>;
};
template <class List, int Stage, class Operation, class... Operands>
  requires(stage_of<applied_node<Operation, Operands...>> == Stage)
struct work<List, Stage, applied_node<Operation, Operands...>> {
  using operations =
      mp11::mp_list<instruction<List::template index<applied_node<Operation, Operands...>>,
                                Operation, List::template index<Operands>...>>;
  using sines = mp11::mp_list<>;
};
template <class List, class X>
using sines_of = mp11::mp_list<
    sine_instruction<List::template index<X>, List::template index<applied_node<op::sin, X>>,
                     List::template index<applied_node<op::cos, X>>>>;
template <class List, int Stage, class X>
  requires(stage_of<applied_node<op::sin, X>> == Stage)
struct work<List, Stage, applied_node<op::sin, X>> {
  using operations = mp11::mp_list<>;
  using sines = sines_of<List, X>;
};
template <class List, int Stage, class X>
  requires(stage_of<applied_node<op::cos, X>> == Stage)
struct work<List, Stage, applied_node<op::cos, X>> {
  using operations = mp11::mp_list<>;
  using sines = mp11::mp_if_c<(List::template index<applied_node<op::sin, X>> < 0),
                              sines_of<List, X>, mp11::mp_list<>>; // else with the sine
};

template <class Slots, class... Instructions>
DUET_ALWAYS_INLINE constexpr void run(Slots& s, mp11::mp_list<Instructions...>) {
  // An array, as clang limits fold expressions to 256 operands.
  [[maybe_unused]] const bool done[] = {true, (Instructions::run(s), true)...};
}
template <bool AtOnce, class Slots, int... I, int... Sine, int... Cosine>
DUET_ALWAYS_INLINE constexpr void take_sines(Slots& s,
                                             mp11::mp_list<sine_instruction<I, Sine, Cosine>...>) {
  if constexpr (AtOnce && duet::detail::takes_sines_at_once<
                              std::remove_cvref_t<decltype(value_at<I>(s))>...>) {
    if (!std::is_constant_evaluated()) {
      const duet::detail::sines_at_once<sizeof...(I)> y(value_at<I>(s)...);
      int i = 0;
      ((sine_instruction<I, Sine, Cosine>::set(s, y.sine(i), y.cosine(i)), ++i), ...);
      return;
    }
  }
  (sine_instruction<I, Sine, Cosine>::run(s), ...);
}

template <int Stage, class List>
struct stage;
template <int Stage, class... Nodes>
struct stage<Stage, node_list<Nodes...>> {
  using list = node_list<Nodes...>;
  using operations =
      mp11::mp_append<mp11::mp_list<>, typename work<list, Stage, Nodes>::operations...>;
  using sines = mp11::mp_append<mp11::mp_list<>, typename work<list, Stage, Nodes>::sines...>;
  static constexpr bool is_last = Stage >= std::max({0, stage_of<Nodes>...});
};

/// Runs the stages from `Stage` on: first the sines and cosines of each, then its operations.
template <int Stage, class List, bool AtOnce, class Slots>
DUET_ALWAYS_INLINE constexpr void run_from(Slots& s) {
  using now = stage<Stage, List>;
  take_sines<AtOnce>(s, typename now::sines{});
  run(s, typename now::operations{});
  if constexpr (!now::is_last) {
    run_from<Stage + 1, List, AtOnce>(s);
  }
}

template <class Node>
using is_symbol_node = mp11::mp_bool<is_symbol<Node>>;
template <class Node>
inline constexpr bool is_constant_node = false;
template <kind K, class Tag>
inline constexpr bool is_constant_node<constant_node<K, Tag>> = true;
template <class Node>
using is_constant = mp11::mp_bool<is_constant_node<Node>>;
template <class Node>
using is_other_leaf =
    mp11::mp_bool<!is_symbol<Node> && !is_constant_node<Node> && !is_operation<Node>>;

template <class List, class Slots, class Bindings, class... Symbols, class... Constants,
          class... Others>
DUET_ALWAYS_INLINE constexpr void load(Slots& s, const Bindings& b, node_list<Symbols...>,
                                       node_list<Constants...>, node_list<Others...>) {
  using real = typename Bindings::real;
  ((value_at<List::template index<Symbols>>(s) = value_in<Symbols>(b)), ...);
  ((value_at<List::template index<Constants>>(s) = constant_over<real>(value_in<Constants>(b))),
   ...);
  ((value_at<List::template index<Others>>(s) = leaf<Others, numbers_as<real>>::value({})), ...);
}

template <class... Nodes, class Bindings>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto evaluated(node_list<Nodes...>, const Bindings& b) {
  using list = node_list<Nodes...>;
  typename slots<typename list::indices, typename value_of<Nodes, Bindings>::type...>::type s;
  load<list>(s, b, mp11::mp_copy_if<list, is_symbol_node>{}, mp11::mp_copy_if<list, is_constant>{},
             mp11::mp_copy_if<list, is_other_leaf>{});
  run_from<0, list, !Bindings::has_library_sines>(s);
  return s;
}

/// Evaluates some nodes.
template <class... Roots, class Bindings>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto evaluated_nodes(const Bindings& b) {
  using list = nodes_of<Roots...>;
  auto s = evaluated(list{}, b);
  return chosen_values<decltype(s), list::template index<Roots>...>{s};
}

} // namespace detail
} // namespace duet::expression
