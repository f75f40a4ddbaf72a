// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/expression/call.hpp>
#include <duet/expression/moving_frame.hpp>
#include <duet/expression/node.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/screw.hpp>
#include <duet/expression/variables.hpp>
#include <duet/expression/vector.hpp>
#include <duet/expression/velocity.hpp>

#include <boost/mp11/algorithm.hpp>
#include <boost/mp11/list.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

/// \file
/// Products of rigid motions in doubles, and their spatial Jacobians, factor by factor: what a
/// joint adds to the Jacobian is its axis where it stands.

namespace duet::expression::detail {

/// The factors of a product.
template <class Node>
struct factors {
  using type = mp11::mp_list<Node>;
};
template <class A, class B>
  requires(A::kind_of == kind::pose)
struct factors<applied_node<op::product, A, B>> {
  using type = mp11::mp_append<typename factors<A>::type, typename factors<B>::type>;
};

/// A product of at least two rigid motions.
template <class Node>
inline constexpr bool is_pose_chain = false;
template <class A, class B>
inline constexpr bool is_pose_chain<applied_node<op::product, A, B>> = A::kind_of == kind::pose;

/// What is asked of a factor: the nodes that it needs, its twist, and being appended.
template <class Factor>
struct link {
  static constexpr bool turns = true;
  using nodes = mp11::mp_list<Factor>;
  template <class Motion>
  using twist = decltype(velocity_of<spatial_frame, Factor, Motion>());

  template <bool IsFirst, class Frame>
  DUET_ALWAYS_INLINE static void append(moving_frame& f, const Frame& values) {
    f.append(values[Factor{}]);
  }
  template <bool IsSet, class Motion, class Frame>
  DUET_ALWAYS_INLINE static void write(const moving_frame& f, double* column, const Frame& values) {
    f.write_twist_of<IsSet>(column, values[twist<Motion>{}]);
  }
};

/// A turn about a coordinate axis.
template <int I, class Angle, class S, class C>
  requires(I < 3)
struct link<applied_node<op::turn, unit_vector_node<kind::dual_vector, I>, Angle, S, C>> {
  static constexpr bool turns = true;
  using nodes = mp11::mp_list<S, C>;
  template <class Motion>
  using twist = rate_t<Angle, Motion>;

  template <bool IsFirst, class Frame>
  DUET_ALWAYS_INLINE static void append(moving_frame& f, const Frame& values) {
    f.turn<I, IsFirst>(values[S{}], values[C{}]);
  }
  template <bool IsSet, class Motion, class Frame>
  DUET_ALWAYS_INLINE static void write(const moving_frame& f, double* column, const Frame& values) {
    f.write_turn<IsSet, I>(column, values[twist<Motion>{}]);
  }
};

/// A translation along a coordinate axis.
template <int I, class D>
struct link<applied_node<op::slide, unit_vector_node<kind::vector, I>, D>> {
  static constexpr bool turns = false;
  using nodes = mp11::mp_list<D>;
  template <class Motion>
  using twist = rate_t<D, Motion>;

  template <bool IsFirst, class Frame>
  DUET_ALWAYS_INLINE static void append(moving_frame& f, const Frame& values) {
    f.slide<I>(values[D{}]);
  }
  template <bool IsSet, class Motion, class Frame>
  DUET_ALWAYS_INLINE static void write(const moving_frame& f, double* column, const Frame& values) {
    f.write_slide<IsSet, I>(column, values[twist<Motion>{}]);
  }
};

/// Those of the motions that move a factor, a short list as a rule: what a compiler spends on a
/// chain grows with these, not with the product of factors and motions.
template <class Factor, class... Motions>
struct motions_of_factor {
  template <class Motion>
  using moves = mp11::mp_bool<!is_zero<typename link<Factor>::template twist<Motion>>>;
  using type = mp11::mp_copy_if<mp11::mp_list<Motions...>, moves>;
};

template <class Factors, class Motions,
          class Indices = std::make_index_sequence<mp11::mp_size<Factors>::value>>
struct pose_chain;
template <class... Factors, class... Motions, std::size_t... K>
struct pose_chain<mp11::mp_list<Factors...>, motion_list<Motions...>, std::index_sequence<K...>> {
  template <class Factor>
  using moved_by = typename motions_of_factor<Factor, Motions...>::type;

  template <class Factor, class List>
  struct twists_of;
  template <class Factor, class... M>
  struct twists_of<Factor, mp11::mp_list<M...>> {
    using type = mp11::mp_list<typename link<Factor>::template twist<M>...>;
  };
  using roots = mp11::mp_append<typename link<Factors>::nodes...,
                                typename twists_of<Factors, moved_by<Factors>>::type...>;

  /// The pose; its Jacobian is written into 6 × n doubles, column by column.
  template <class Held, class... Arguments>
  [[nodiscard]] DUET_ALWAYS_INLINE static dual_quaternion<double>
  evaluate(double* jacobian, const Held& held, const Arguments&... arguments) {
    const auto values = values_of(roots{}, held, arguments...);
    moving_frame f;
    (step<K, Factors>(moved_by<Factors>{}, f, jacobian, values), ...);
    (clear_column<Motions>(jacobian), ...);
    return f.pose();
  }

private:
  using moving = mp11::mp_append<moved_by<Factors>...>;
  static constexpr std::array<std::size_t, sizeof...(Factors)> moved_counts = {
      mp11::mp_size<moved_by<Factors>>::value...};

  /// Whether a motion moves one of the factors before the K-th.
  template <std::size_t At, class Motion>
  static constexpr bool moves_before = [] {
    std::size_t before = 0;
    for (std::size_t i = 0; i < At; ++i) {
      before += moved_counts[i];
    }
    return mp11::mp_find<moving, Motion>::value < before;
  }();

  template <class Motion>
  static constexpr int column = 6 * int(mp11::mp_find<mp11::mp_list<Motions...>, Motion>::value);

  template <class... Roots, class Held, class... Arguments>
  DUET_ALWAYS_INLINE static auto values_of(mp11::mp_list<Roots...>, const Held& held,
                                           const Arguments&... arguments) {
    return called<Roots...>(held, arguments...);
  }
  template <std::size_t At, class Factor, class... M, class Frame>
  DUET_ALWAYS_INLINE static void step(mp11::mp_list<M...>, moving_frame& f,
                                      [[maybe_unused]] double* jacobian, const Frame& values) {
    (link<Factor>::template write<!moves_before<At, M>, M>(f, jacobian + column<M>, values), ...);
    constexpr bool is_first = ((K >= At || !link<Factors>::turns) && ...);
    link<Factor>::template append<is_first>(f, values);
  }
  template <class Motion>
  DUET_ALWAYS_INLINE static void clear_column(double* jacobian) {
    if constexpr (!moves_before<sizeof...(Factors), Motion>) {
      std::fill_n(jacobian + column<Motion>, 6, 0.0);
    }
  }
};

} // namespace duet::expression::detail
