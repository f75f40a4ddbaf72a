// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/dual/sine_cosine.hpp>
#include <duet/expression/given.hpp>
#include <duet/expression/node.hpp>
#include <duet/expression/sines.hpp>

#include <boost/mp11/algorithm.hpp>
#include <boost/mp11/list.hpp>
#include <boost/mp11/set.hpp>

#include <algorithm>
#include <cstddef>
#include <type_traits>

/// \file
/// Evaluation: all different nodes of some formulas in one list, operands first, each evaluated
/// once. It goes by stages, so that all sines that can be taken at once are.

namespace duet::expression {

namespace op {

struct sin;
struct cos;

} // namespace op

namespace detail {

namespace mp11 = boost::mp11;

/// The list with a node and what it needs added, operands first.
template <class List, class... Nodes>
struct with_nodes {
  using type = List;
};
template <class List, class Node>
struct operands_added {
  using type = List;
};
template <class List, class Operation, class... Operands>
struct operands_added<List, applied_node<Operation, Operands...>> : with_nodes<List, Operands...> {
};
template <class List, class First, class... Rest>
struct with_nodes<List, First, Rest...> {
  template <bool IsThere, class L>
  struct added {
    using type = L;
  };
  template <class L>
  struct added<false, L> {
    using type = mp11::mp_push_back<typename operands_added<L, First>::type, First>;
  };
  using type =
      typename with_nodes<typename added<mp11::mp_set_contains<List, First>::value, List>::type,
                          Rest...>::type;
};

template <class Node, class T>
struct slot {
  T value;
};

template <class Node, class T>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr const T& value_in_slot(const slot<Node, T>& s) {
  return s.value;
}

/// How many sines or cosines must have been taken before a node can be evaluated.
template <class Node>
inline constexpr int stage_of = 0;
template <class Operation, class... Operands>
inline constexpr int
    stage_of<applied_node<Operation, Operands...>> = std::max({stage_of<Operands>...});
template <class X>
inline constexpr int stage_of<applied_node<op::sin, X>> = stage_of<X> + 1;
template <class X>
inline constexpr int stage_of<applied_node<op::cos, X>> = stage_of<X> + 1;

template <class Node>
inline constexpr bool is_sine = is_applied<Node, op::sin> || is_applied<Node, op::cos>;

/// The arguments whose sines or cosines are taken at the end of a stage.
template <int Stage, class Arguments, class... Nodes>
struct sines_of_stage {
  using type = Arguments;
};
template <int Stage, class Arguments, class Node, class... Rest>
struct sines_of_stage<Stage, Arguments, Node, Rest...> : sines_of_stage<Stage, Arguments, Rest...> {
};
template <int Stage, class Arguments, class X, class... Rest>
struct sines_of_stage<Stage, Arguments, applied_node<op::sin, X>, Rest...>
    : sines_of_stage<
          Stage,
          mp11::mp_if_c<stage_of<X> == Stage, mp11::mp_set_push_back<Arguments, X>, Arguments>,
          Rest...> {};
template <int Stage, class Arguments, class X, class... Rest>
struct sines_of_stage<Stage, Arguments, applied_node<op::cos, X>, Rest...>
    : sines_of_stage<
          Stage,
          mp11::mp_if_c<stage_of<X> == Stage, mp11::mp_set_push_back<Arguments, X>, Arguments>,
          Rest...> {};

/// The nodes and their values.
template <class Given, class... Nodes>
class frame : slot<Nodes, typename value_of<Nodes, Given>::type>... {
public:
  DUET_ALWAYS_INLINE constexpr explicit frame(const Given& g) { fill_from<0>(g); }

  /// The value of one of the nodes.
  template <class Node>
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr const auto& operator[](Node) const {
    return value_in_slot<Node>(*this);
  }

private:
  template <class Node>
  using slot_of = slot<Node, typename value_of<Node, Given>::type>;
  template <class Node>
  static constexpr bool has = mp11::mp_set_contains<mp11::mp_list<Nodes...>, Node>::value;

  template <int Stage>
  DUET_ALWAYS_INLINE constexpr void fill_from(const Given& g) {
    // No fold: clang lets them nest 256 deep.
    [[maybe_unused]] const bool filled[] = {(fill<Stage>(g, Nodes{}), true)...};
    if constexpr (Stage < std::max({0, stage_of<Nodes>...})) {
      take_sines(typename sines_of_stage<Stage, mp11::mp_list<>, Nodes...>::type{});
      fill_from<Stage + 1>(g);
    }
  }

  template <int Stage, class Node>
  DUET_ALWAYS_INLINE constexpr void fill(const Given& g, Node) {
    if constexpr (stage_of<Node> == Stage) {
      slot_of<Node>::value = leaf<Node, Given>::value(g);
    }
  }
  template <int Stage, class Operation, class... Operands>
  DUET_ALWAYS_INLINE constexpr void fill(const Given&, applied_node<Operation, Operands...>) {
    using node = applied_node<Operation, Operands...>;
    if constexpr (stage_of<node> == Stage && !is_sine<node>) {
      slot_of<node>::value = Operation::value((*this)[Operands{}]...);
    }
  }

  template <class... X>
  DUET_ALWAYS_INLINE constexpr void take_sines(mp11::mp_list<X...>) {
    if constexpr (takes_sines_at_once<Given, typename value_of<X, Given>::type...>) {
      if (!std::is_constant_evaluated()) {
        const sines_at_once<sizeof...(X)> y((*this)[X{}]...);
        int i = 0;
        ((set_sine<X>(y.sine(i), y.cosine(i)), ++i), ...);
        return;
      }
    }
    (take_sine<X>(), ...);
  }
  template <class X>
  DUET_ALWAYS_INLINE constexpr void take_sine() {
    using duet::detail::sine_and_cosine_of;
    const auto& x = (*this)[X{}];
    using T = std::remove_cvref_t<decltype(x)>;
    if constexpr (!has<applied_node<op::cos, X>>) {
      slot_of<applied_node<op::sin, X>>::value = duet::rule::sin{}.value(x);
    } else if constexpr (!has<applied_node<op::sin, X>>) {
      slot_of<applied_node<op::cos, X>>::value = duet::rule::cos{}.value(x);
    } else {
      const duet::detail::sine_cosine<T> y = sine_and_cosine_of(x);
      set_sine<X>(y.sine, y.cosine);
    }
  }
  template <class X, class T>
  DUET_ALWAYS_INLINE constexpr void set_sine(const T& sine, const T& cosine) {
    if constexpr (has<applied_node<op::sin, X>>) {
      slot_of<applied_node<op::sin, X>>::value = sine;
    }
    if constexpr (has<applied_node<op::cos, X>>) {
      slot_of<applied_node<op::cos, X>>::value = cosine;
    }
  }
};

template <class List, class Given>
struct frame_over;
template <template <class...> class List, class... Nodes, class Given>
struct frame_over<List<Nodes...>, Given> {
  using type = frame<Given, Nodes...>;
};

/// The values of some nodes and of all they need.
template <class... Roots, class Given>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto evaluated_nodes(const Given& g) {
  using list = typename with_nodes<mp11::mp_list<>, Roots...>::type;
  return typename frame_over<list, Given>::type(g);
}

} // namespace detail
} // namespace duet::expression
