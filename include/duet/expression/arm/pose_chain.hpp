// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/expression/arm/moving_frame.hpp>
#include <duet/expression/screw.hpp>
#include <duet/expression/tape/derivation.hpp>
#include <duet/expression/tape/program.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/variables.hpp>
#include <duet/expression/vector.hpp>

#include <boost/mp11/algorithm.hpp>
#include <boost/mp11/list.hpp>

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>

/// \file
/// Products of rigid motions and their Jacobians in doubles, factor by factor: the spatial column
/// of a joint is its axis, displaced by the factors before it. The columns of a product in body
/// axes are the spatial ones of its inverse with the opposite sign; the factors of the inverse are
/// the inverse factors in the opposite order.

namespace duet::expression::detail {

namespace mp11 = boost::mp11;

/// The factors of a product.
template <class Node>
struct factors {
  using type = mp11::mp_list<Node>;
};
template <class A, class B>
  requires(A::kind_of == kind::pose && B::kind_of == kind::pose)
struct factors<applied_node<op::product, A, B>> {
  using type = mp11::mp_append<typename factors<A>::type, typename factors<B>::type>;
};

/// True for a coordinate axis as a vector or a line, and its index.
template <class Node>
inline constexpr int axis_of = -1;
template <kind K, int I>
  requires(I < 3)
inline constexpr int axis_of<unit_vector_node<K, I>> = I;
template <class Node>
inline constexpr int axis_of<applied_node<op::part_of_dual<false>, Node>> = axis_of<Node>;
template <class Node>
inline constexpr bool is_axis = axis_of<Node> >= 0;

/// True for a product of at least two rigid motions.
template <class Node>
inline constexpr bool is_pose_chain = false;
template <class A, class B>
inline constexpr bool is_pose_chain<applied_node<op::product, A, B>> =
    A::kind_of == kind::pose&& B::kind_of == kind::pose;

/// Class of a factor for `moving_frame`, the entries whose values it is appended with, and its
/// rate: a velocity, or the rate of a scalar.
template <class Factor>
struct link_of {
  using link = any_motion;
  static constexpr kind kind_of_rate = Factor::kind_of;
  static constexpr int value_count = 1;
  template <class Held>
  static constexpr int add(tape_builder& tape, int* values) {
    return *values = recipe<Factor>::template add<tape_use<1>, Held>(tape);
  }
};
template <int I, class Angle, class S, class C>
  requires(I < 3)
struct link_of<
    applied_node<op::axis_exponential, unit_vector_node<kind::dual_vector, I>, Angle, S, C>> {
  using link = about_axis<I>;
  static constexpr kind kind_of_rate = kind::scalar;
  static constexpr int value_count = 2;
  template <class Held>
  static constexpr int add(tape_builder& tape, int* values) {
    values[0] = recipe<S>::template add<tape_use<0>, Held>(tape);
    values[1] = recipe<C>::template add<tape_use<0>, Held>(tape);
    return recipe<Angle>::template add<tape_use<1>, Held>(tape);
  }
};
template <class N, class D>
  requires is_axis<N>
struct link_of<applied_node<op::translation_along, N, D>> {
  using link = along_axis<axis_of<N>>;
  static constexpr kind kind_of_rate = kind::scalar;
  static constexpr int value_count = 1;
  template <class Held>
  static constexpr int add(tape_builder& tape, int* values) {
    return *values = recipe<D>::template add<tape_use<1>, Held>(tape);
  }
};

/// Puts the values of factors, two entries each, and their rates in the frame on a tape: those of a
/// factor for all motions, one factor after the other.
template <class Frame, class Factors, class... Motions>
struct build_chain;
template <class Frame, class... Factors, class... Motions>
struct build_chain<Frame, mp11::mp_list<Factors...>, Motions...> {
  static constexpr int factors = int(sizeof...(Factors)), motions = int(sizeof...(Motions));
  static constexpr int root_count = factors * (2 + motions);
  static constexpr int initial_capacity = 256;
  static constexpr int motions_in_pass = 16; // compilers limit the steps of a constant expression
  static constexpr int passes = 1 + (motions - 1) / motions_in_pass;

  static constexpr int rate_root(int factor, int motion) {
    return 2 * factors + motions * factor + motion;
  }
  template <class Held, int Pass>
  static constexpr void build(tape_builder& tape, int* roots) {
    using use = tape_use<0>;
    int* values = roots;
    const int moving[] = {link_of<Factors>::template add<Held>(tape, (values += 2) - 2)...};
    const moving_input inputs[] = {moving_input_of<use, Held>(tape, Motions{})...};
    tape_motion motion(tape.capacity());
    int size = 0;
    for (int i : moving) {
      motion.need(tape, i);
      size = i < size ? size : i + 1;
    }
    constexpr int end =
        (Pass + 1) * motions_in_pass < motions ? (Pass + 1) * motions_in_pass : motions;
    for (int m = Pass * motions_in_pass; m < end; ++m) {
      motion.template add_rates<use>(tape, size, inputs + m, 1);
      int k = 0;
      ((roots[rate_root(k, m)] = column_of<link_of<Factors>::kind_of_rate, Frame>(
                                     motion, tape_term<use>{&tape, moving[k]})
                                     .index,
        ++k),
       ...);
    }
  }
};

/// Evaluation of a product of rigid motions, factor by factor.
///
/// \tparam Frame  of the Jacobian: `spatial_frame` or `body_frame`
template <class Frame, class Factors, class... Motions>
struct pose_chain;
template <class Frame, class... Factors, class... Motions>
struct pose_chain<Frame, mp11::mp_list<Factors...>, Motions...> {
  /// Returns the pose and writes its Jacobian into 6 × n doubles, column by column.
  [[nodiscard]] DUET_ALWAYS_INLINE static dual_quaternion<double> evaluate(double* jacobian,
                                                                           const auto& b) {
    return evaluated_program<build>(b, [jacobian](auto& values) DUET_INLINE_LAMBDA {
      using program = typename std::remove_reference_t<decltype(values)>::program;
      moving_frame f;
      [&]<int... Step>(std::integer_sequence<int, Step...>) DUET_INLINE_LAMBDA {
        (append<program, Step>(f, jacobian, values), ...);
      }
      (std::make_integer_sequence<int, count>{});
      for (int m = 0; m < motions; ++m) {
        if (writes<program>.first_factor[m] == count) {
          std::fill_n(jacobian + 6 * m, 6, 0.0);
        }
      }
      if constexpr (is_inverse) {
        return conj(f.pose());
      } else {
        return f.pose();
      }
    });
  }

private:
  using build = build_chain<Frame, mp11::mp_list<Factors...>, Motions...>;
  static constexpr int count = build::factors, motions = build::motions;
  /// True if the inverse is evaluated, from the last factor to the first.
  static constexpr bool is_inverse = std::is_same_v<Frame, body_frame>;

  static constexpr int factor_at(int step) { return is_inverse ? count - 1 - step : step; }

  /// The motions that move each factor, and the first of the steps' factors that each motion moves.
  struct factor_motions {
    int size[std::size_t(count)] = {};
    int motion[std::size_t(count)][std::size_t(motions)] = {};
    int first_factor[std::size_t(motions)] = {};
  };
  template <class Program>
  static constexpr factor_motions writes = [] {
    factor_motions result;
    for (int m = 0; m < motions; ++m) {
      result.first_factor[m] = count;
      for (int step = count - 1; step >= 0; --step) {
        const int k = factor_at(step);
        if (!Program::is_zero_root(build::rate_root(k, m))) {
          result.motion[k][result.size[k]++] = m;
          result.first_factor[m] = k;
        }
      }
    }
    return result;
  }();
  static constexpr int first_rotation = [] {
    constexpr bool rotates[] = {link_of<Factors>::link::rotates...};
    int step = 0;
    while (step < count && !rotates[factor_at(step)]) {
      ++step;
    }
    return step;
  }();

  /// Writes the columns of a factor, and appends it, or its inverse, to the frame.
  template <class Program, int Step>
  DUET_ALWAYS_INLINE static void append(moving_frame& f, [[maybe_unused]] double* jacobian,
                                        auto& values) {
    constexpr int k = factor_at(Step);
    using factor = link_of<mp11::mp_at_c<mp11::mp_list<Factors...>, std::size_t(k)>>;
    using link = typename factor::link;
    [&]<int... W>(std::integer_sequence<int, W...>) DUET_INLINE_LAMBDA {
      (write<Program, k, writes<Program>.motion[k][W]>(link{}, f, jacobian, values), ...);
    }
    (std::make_integer_sequence<int, writes<Program>.size[k]>{});
    constexpr bool is_first = Step <= first_rotation;
    const auto& value = values.template get<2 * k>();
    if constexpr (factor::value_count == 2) {
      const double sine = is_inverse ? -value : value;
      f.template append<is_first>(link{}, sine, values.template get<2 * k + 1>());
    } else if constexpr (!is_inverse) {
      f.template append<is_first>(link{}, value);
    } else if constexpr (factor::kind_of_rate == kind::scalar) {
      f.template append<is_first>(link{}, -value);
    } else {
      f.template append<is_first>(link{}, conj(value));
    }
  }
  template <class Program, int K, int M, class Link>
  DUET_ALWAYS_INLINE static void write(Link link, moving_frame& f, double* jacobian, auto& values) {
    f.template write<writes<Program>.first_factor[M] == K>(
        link, jacobian + 6 * M, values.template get<build::rate_root(K, M)>());
  }
};

} // namespace duet::expression::detail
