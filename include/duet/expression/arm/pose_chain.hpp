// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/types.hpp>
#include <duet/core/config.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/expression/arm/moving_frame.hpp>
#include <duet/expression/evaluate/variables.hpp>
#include <duet/expression/screw.hpp>
#include <duet/expression/tape/program.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/vector.hpp>
#include <duet/expression/velocity.hpp>

#include <boost/mp11/algorithm.hpp>
#include <boost/mp11/list.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

/// \file
/// Products of rigid motions and their spatial Jacobians in doubles, factor by factor: the column
/// of a joint is its axis, displaced by the factors before it.

namespace duet::expression::detail {

namespace mp11 = boost::mp11;

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
  /// Index of a node, or -1 if it is not in the list.
  template <class Node>
  static constexpr int index = index_of_true(is_it<Node>, count);
};

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

/// True for a product of at least two rigid motions.
template <class Node>
inline constexpr bool is_pose_chain = false;
template <class A, class B>
inline constexpr bool is_pose_chain<applied_node<op::product, A, B>> = A::kind_of == kind::pose;

/// The different symbols of a node.
template <class Node>
struct symbols_of {
  using type = mp11::mp_if_c<is_symbol<Node>, mp11::mp_list<Node>, mp11::mp_list<>>;
};
template <class Operation, class... X>
struct symbols_of<applied_node<Operation, X...>> {
  using type = mp11::mp_unique<mp11::mp_append<mp11::mp_list<>, typename symbols_of<X>::type...>>;
};

/// Class of a factor for `moving_frame`, the nodes whose values it is appended with, and the node
/// of its twist if symbols move.
template <class Factor>
struct link_of {
  using link = any_motion;
  using nodes = mp11::mp_list<Factor>;
  template <class Motion>
  using twist = decltype(velocity_of<spatial_frame, Factor, Motion>());
};
template <int I, class Angle, class S, class C>
  requires(I < 3)
struct link_of<
    applied_node<op::axis_exponential, unit_vector_node<kind::dual_vector, I>, Angle, S, C>> {
  using link = about_axis<I>;
  using nodes = mp11::mp_list<S, C>;
  template <class Motion>
  using twist = rate_t<Angle, Motion>;
};
template <int I, class D>
struct link_of<applied_node<op::translation_along, unit_vector_node<kind::vector, I>, D>> {
  using link = along_axis<I>;
  using nodes = mp11::mp_list<D>;
  template <class Motion>
  using twist = rate_t<D, Motion>;
};

/// The motions that move a factor, with its twists. They are found by the symbols of the factor, so
/// that compile time does not grow with the number of all pairs of factors and motions.
template <class Factor, class Motions>
struct moved_factor {
  template <class Symbol>
  using directions_of = typename directions<Symbol, spatial_frame>::type;
  using of_symbols = mp11::mp_apply<
      mp11::mp_append,
      mp11::mp_push_front<mp11::mp_transform<directions_of, typename symbols_of<Factor>::type>,
                          motion_list<>>>;
  template <class Motion>
  using moves = mp11::mp_bool<(Motions::template index<Motion> >= 0) &&
                              !is_zero<typename link_of<Factor>::template twist<Motion>>>;
  using motions = mp11::mp_copy_if<of_symbols, moves>;
  using twists = mp11::mp_transform<link_of<Factor>::template twist, motions>;
  using roots = mp11::mp_append<typename link_of<Factor>::nodes, twists>;
};

/// Evaluation step of a factor: it writes its columns of the Jacobian and is appended to the frame.
/// Values are given by index.
template <class Link, bool IsFirst, class Values, class Writes>
struct factor_step;
template <int Column, bool IsSet, int Twist>
struct column_write {};

template <class Link, bool IsFirst, int... Values, int... Column, bool... IsSet, int... Twist>
struct factor_step<Link, IsFirst, std::integer_sequence<int, Values...>,
                   mp11::mp_list<column_write<Column, IsSet, Twist>...>> {
  template <class Slots>
  DUET_ALWAYS_INLINE static void run(moving_frame& f, [[maybe_unused]] double* jacobian, Slots& s) {
    (f.write<IsSet>(Link{}, jacobian + 6 * Column, s.template get<Twist>()), ...);
    f.append<IsFirst>(Link{}, s.template get<Values>()...);
  }
};

template <class Factors, class Motions,
          class Indices = std::make_index_sequence<mp11::mp_size<Factors>::value>>
struct pose_chain;
template <class... Factors, class... Motions, std::size_t... K>
struct pose_chain<mp11::mp_list<Factors...>, motion_list<Motions...>, std::index_sequence<K...>> {
  /// Returns the pose and writes its Jacobian into 6 × n doubles, column by column.
  [[nodiscard]] DUET_ALWAYS_INLINE static dual_quaternion<double> evaluate(double* jacobian,
                                                                           const auto& b) {
    return evaluated_program<mp11::mp_rename<nodes, build_nodes>>(
        b, [jacobian](auto& values) DUET_INLINE_LAMBDA {
          moving_frame f;
          run(f, jacobian, values,
              typename step<K, Factors, typename link_of<Factors>::nodes,
                            typename moved_factor<Factors, motions>::motions>::type{}...);
          if constexpr (std::find(first_moved.begin(), first_moved.end(), count) !=
                        first_moved.end()) {
            for (std::size_t i = 0; i < first_moved.size(); ++i) {
              if (first_moved[i] == count) {
                std::fill_n(jacobian + 6 * i, 6, 0.0);
              }
            }
          }
          return f.pose();
        });
  }

private:
  using motions = node_list<Motions...>;
  using nodes =
      mp11::mp_apply<node_list, mp11::mp_append<typename moved_factor<Factors, motions>::roots...>>;
  static constexpr std::size_t count = sizeof...(Factors);

  /// Index of the first factor that a motion moves, for each motion.
  using firsts = std::array<std::size_t, sizeof...(Motions)>;
  template <class... M>
  static constexpr void note(firsts& first, [[maybe_unused]] std::size_t factor,
                             motion_list<M...>) {
    ((first[std::size_t(motions::template index<M>)] =
          std::min(first[std::size_t(motions::template index<M>)], factor)),
     ...);
  }
  static constexpr firsts first_moved = [] {
    firsts first;
    first.fill(count);
    (note(first, K, typename moved_factor<Factors, motions>::motions{}), ...);
    return first;
  }();

  template <class Factor>
  using rotates = mp11::mp_bool<link_of<Factor>::link::rotates>;
  static constexpr std::size_t first_rotation =
      mp11::mp_find_if<mp11::mp_list<Factors...>, rotates>::value;

  template <std::size_t At, class Factor, class Values, class Moved>
  struct step;
  template <std::size_t At, class Factor, class... Values, class... M>
  struct step<At, Factor, mp11::mp_list<Values...>, motion_list<M...>> {
    template <class Motion>
    static constexpr int column = motions::template index<Motion>;
    using type =
        factor_step<typename link_of<Factor>::link, At <= first_rotation,
                    std::integer_sequence<int, nodes::template index<Values>...>,
                    mp11::mp_list<column_write<
                        column<M>, first_moved[std::size_t(column<M>)] == At,
                        nodes::template index<typename link_of<Factor>::template twist<M>>>...>>;
  };

  template <class... Steps, class Slots>
  DUET_ALWAYS_INLINE static void run(moving_frame& f, double* jacobian, Slots& s, Steps...) {
    (Steps::run(f, jacobian, s), ...);
  }
};

} // namespace duet::expression::detail
