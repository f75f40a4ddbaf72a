// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/type_id.hpp>
#include <duet/core/config.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/expression/arithmetic.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/screw.hpp>
#include <duet/expression/tape/builder.hpp>
#include <duet/expression/tape/recipe.hpp>
#include <duet/expression/tape/term.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/vector.hpp>

#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

/// \file
/// Derivatives on a tape: rates of all entries if inputs move, and velocities of rotations and
/// poses (N7, N18): three and six numbers instead of four and eight, in a frame. In spatial axes
/// the contribution of a factor of a product is displaced by the factors before it, in body axes by
/// those behind it.

namespace duet::expression::detail {

/// Symbol that moves with a rate, a node; a rotation or pose may move with a velocity in a frame.
template <class Symbol, class Rate, class Frame = void>
struct moving {};

/// Quantity by which the motion of an input is given.
enum class input_motion { with_rate, with_spatial_velocity, with_body_velocity };

/// An input that moves.
struct moving_input {
  int input = -1; ///< its index
  int by = 0;     ///< entry of its rate or velocity
  input_motion how = input_motion::with_rate;
};

/// Motion of some inputs, with the rates of the entries that are needed.
struct tape_motion {
  tape_numbers is_needed, rates, spatial_velocities, body_velocities;
  const moving_input* inputs = nullptr;
  int input_count = 0;
  bool has_velocities = false;

  constexpr explicit tape_motion(int capacity)
      : is_needed(capacity), rates(capacity), spatial_velocities(capacity),
        body_velocities(capacity) {}

  /// Marks an entry and all that it needs.
  constexpr void need(const tape_builder& tape, int i) {
    is_needed[i] = 1;
    mark_operands(tape, is_needed, i);
  }

  /// The input that an entry is, if it moves, otherwise null.
  [[nodiscard]] constexpr const moving_input* moving(const tape_entry& e) const {
    for (int m = 0; m < input_count && e.code == tape_code::input; ++m) {
      if (inputs[m].input == e.parameter) {
        return inputs + m;
      }
    }
    return nullptr;
  }

  /// Finds the rates of the needed entries before `size` if some inputs move.
  template <class Use>
  constexpr void add_rates(tape_builder& tape, int size, const moving_input* moving_inputs,
                           int count);
};

/// ω + ε(v ± x) of a twist ω + εv: the twist with the velocity of another point.
template <class Operation>
[[nodiscard]] constexpr auto at_point(auto twist, auto x) {
  return apply<op::dual_vector_of>(apply<op::part_of_dual<false>>(twist),
                                   apply<Operation>(apply<op::part_of_dual<true>>(twist), x));
}

/// The scalar a if v has the form a w, otherwise 0.
template <class Use>
[[nodiscard]] constexpr tape_term<Use> factor_of(tape_term<Use> v, tape_term<Use> w) {
  return v.index == w.index ? v.at(1)
         : v.is_scaled()    ? v.scaled_outside([&](auto x) { return factor_of(x, w); })
                            : v.at(0);
}
/// The vector w of a scaled vector v = a w.
template <class Use>
[[nodiscard]] constexpr tape_term<Use> direction_of(tape_term<Use> v) {
  while (v.is_scaled()) {
    v.index = v.tape->operand_without_scale(v.index);
  }
  return v;
}
/// The rate ȧ if v = a w moves by dv = ȧ w, otherwise 0.
template <class Use>
[[nodiscard]] constexpr tape_term<Use> rate_along(tape_term<Use> v, tape_term<Use> dv) {
  return factor_of(dv, direction_of(v));
}

/// Velocity of a rotation or pose: the vector or dual vector ω of q̇ = ½ ω q (spatial) or ½ q ω
/// (body).
template <class Use>
[[nodiscard]] constexpr tape_term<Use> velocity_of(tape_motion& motion, bool is_spatial,
                                                   tape_term<Use> q);

template <class Use>
[[nodiscard]] constexpr tape_term<Use> find_velocity(tape_motion& motion, bool is_spatial,
                                                     tape_term<Use> q) {
  const auto rate = [&](int i) { return q.at(motion.rates[q.operand(i).index]); };
  const auto velocity = [&](bool in_space, int i) {
    return velocity_of(motion, in_space, q.operand(i));
  };
  if (const moving_input* const x = motion.moving(q.entry());
      x != nullptr && x->how != input_motion::with_rate) {
    const tape_term<Use> v = q.at(x->by);
    const bool is_given = (x->how == input_motion::with_spatial_velocity) == is_spatial;
    return is_given ? v : apply<op::rotate>(is_spatial ? q : apply<op::conj>(q), v);
  }
  if (q.template is<op::product>() && q.operand(0).of_kind() != kind::scalar) {
    return is_spatial ? velocity(true, 0) + apply<op::rotate>(q.operand(0), velocity(true, 1))
                      : apply<op::rotate>(apply<op::conj>(q.operand(1)), velocity(false, 0)) +
                            velocity(false, 1);
  }
  if (q.template is<op::conj>()) {
    return -velocity(!is_spatial, 0);
  }
  if (q.template is<op::negative>()) {
    return velocity(is_spatial, 0);
  }
  if (q.template is<op::rotation>()) {
    return apply<op::part_of_dual<false>>(velocity(is_spatial, 0));
  }
  if (q.template is<op::axis_exponential>() && rate(0).is_zero()) {
    return rate(1) * q.operand(0);
  }
  if (q.template is<op::exp_vector>()) {
    const tape_term<Use> along = rate_along(q.operand(0), rate(0));
    if (!along.is_zero()) {
      return whole<2> * along * direction_of(q.operand(0));
    }
  }
  const tape_term<Use> dq = q.at(motion.rates[q.index]), inverse = apply<op::conj>(q);
  return whole<2> * apply<op::vec>(is_spatial ? dq * inverse : inverse * dq);
}

template <class Use>
constexpr tape_term<Use> velocity_of(tape_motion& motion, bool is_spatial, tape_term<Use> q) {
  if (q.tape->is_zero(motion.rates[q.index])) {
    return q.at(q.tape->zero(vector_kind(q.of_kind())));
  }
  motion.has_velocities = true;
  int& known = (is_spatial ? motion.spatial_velocities : motion.body_velocities)[q.index];
  if (known == 0) {
    known = find_velocity(motion, is_spatial, q).index;
  }
  return q.at(known);
}

template <class Use>
constexpr void tape_motion::add_rates(tape_builder& tape, int size,
                                      const moving_input* moving_inputs, int count) {
  using term = tape_term<Use>;
  inputs = moving_inputs;
  input_count = count;
  for (int i = 0; i < size && has_velocities; ++i) {
    spatial_velocities[i] = body_velocities[i] = 0;
  }
  has_velocities = false;
  for (int i = 0; i < size; ++i) {
    if (is_needed[i] == 0) {
      continue;
    }
    const tape_entry& e = tape[i];
    if (const moving_input* const x = moving(e)) {
      const term q{&tape, i}, v{&tape, x->by};
      rates[i] = x->how == input_motion::with_rate ? x->by
                 : x->how == input_motion::with_spatial_velocity
                     ? (whole<1> / whole<2> * (apply<op::pure>(v) * q)).index
                     : (whole<1> / whole<2> * (q * apply<op::pure>(v))).index;
      continue;
    }
    bool is_moving = false;
    const int* x = tape.operands(i);
    for (int k = 0; k < e.count; ++k) {
      is_moving = is_moving || !tape.is_zero(rates[x[k]]);
    }
    rates[i] = is_moving && e.kind_of != kind::condition ? tape.rate(i, *this, rates)
               : e.kind_of == kind::scalar               ? 0
                                                         : tape.zero(e.kind_of);
  }
}

// Rates by the rules of operations.

template <class Operation, class Use, std::size_t... I>
struct rate_on_tape<Operation, Use, std::index_sequence<I...>> {
  static constexpr int make(tape_builder& tape, const int* x, tape_motion& motion) {
    const term rate = by_rule(motion, term{&tape, x[I]}..., term{&tape, motion.rates[x[I]]}...);
    return rate.index >= 0 ? rate.index
                           : apply<op::pushforward<Operation, std::index_sequence<I...>>>(
                                 term{&tape, x[I]}..., term{&tape, motion.rates[x[I]]}...)
                                 .index;
  }

private:
  using term = tape_term<typename Use::lower>;
  template <std::size_t>
  using term_at = term;

  /// Rate by the rates of the operands: by a rule of the operation, its linearity or its slopes.
  static constexpr term by_rule([[maybe_unused]] tape_motion& motion, term_at<I>... x,
                                term_at<I>... dx) {
    const term first = first_term(x...);
    if constexpr (requires { Operation::rate_by_velocity(first, x..., dx...); }) {
      return Operation::rate_by_velocity(velocity_of(motion, true, first), x..., dx...);
    } else if constexpr (requires { Operation::differential(x..., dx...); }) {
      return first.at(
          index_on_tape<typename Use::lower>(*first.tape, Operation::differential(x..., dx...)));
    } else if constexpr (std::derived_from<Operation, linear_operation>) {
      return apply<Operation>(dx...);
    } else if constexpr (std::derived_from<Operation, bilinear_operation>) {
      return rate_of_product(x..., dx...);
    } else if constexpr (requires { Operation::template slope_by<0>(x...); }) {
      return (... + by_operand<I>(dx, x...));
    } else {
      return first.none();
    }
  }
  static constexpr term rate_of_product(term a, term b, term da, term db) {
    return apply<Operation>(da, b) + apply<Operation>(a, db);
  }
  /// Contribution of an operand: its slope times its rate.
  template <std::size_t K>
  static constexpr term by_operand(term rate, auto... x) {
    if (rate.is_zero()) {
      return rate;
    }
    return applied_by<op::slope_product>(rate, Operation::template slope_by<int(K)>(x...), rate);
  }
};

/// An input of a formula that moves.
template <class Use, class Held, class Symbol, class Rate, class Frame>
[[nodiscard]] constexpr moving_input moving_input_of(tape_builder& tape,
                                                     moving<Symbol, Rate, Frame>) {
  return {item_index<Symbol, Held>, recipe<Rate>::template add<Use, Held>(tape),
          std::is_void_v<Frame>                  ? input_motion::with_rate
          : std::is_same_v<Frame, spatial_frame> ? input_motion::with_spatial_velocity
                                                 : input_motion::with_body_velocity};
}

template <class Node, class... Moving>
struct recipe<rate_node<Node, Moving...>> {
  template <class Held>
  static constexpr unsigned hash = 31 * recipe<Node>::template hash<Held> + 1;
  template <class Use, class Held>
  static constexpr int add(tape_builder& tape) {
    constexpr const duet::detail::type_mark* id =
        &duet::detail::type_id<rate_node<Node, Moving...>>;
    const int known = tape.recalled(hash<Held>, id, Use::order);
    if (known >= 0) {
      return known;
    }
    const int x = recipe<Node>::template add<typename Use::higher, Held>(tape);
    const moving_input inputs[] = {moving_input_of<Use, Held>(tape, Moving{})...};
    tape_motion motion(tape.capacity());
    motion.need(tape, x);
    motion.template add_rates<Use>(tape, x + 1, inputs, int(sizeof...(Moving)));
    return tape.remember(hash<Held>, id, Use::order, motion.rates[x]);
  }
};

/// Column of a Jacobian of a formula of kind K: rate of a scalar, vector or matrix, velocity of a
/// rotation or pose.
template <kind K, class Frame, class Use>
[[nodiscard]] constexpr tape_term<Use> column_of(tape_motion& motion, tape_term<Use> f) {
  if constexpr (K != kind::quaternion && K != kind::pose) {
    return f.at(motion.rates[f.index]);
  } else {
    const auto v = velocity_of(motion, !std::is_same_v<Frame, body_frame>, f);
    if (std::is_same_v<Frame, hybrid_frame> && K == kind::pose && !v.is_zero()) { // ṗ = v + ω × p
      const auto omega = apply<op::part_of_dual<false>>(v);
      return at_point<op::sum>(v, apply<op::cross>(omega, apply<op::translation>(f)));
    }
    return v;
  }
}

/// Puts a formula and its derivatives up to `Order` on a tape: the columns of its Jacobian, in a
/// frame if it is a rotation or pose, and the rates of these, in the order of the upper triangle of
/// a Hessian, row by row.
template <class Node, int Order, class Frame, class... Motions>
struct build_derivatives {
  static constexpr int count = int(sizeof...(Motions));
  static constexpr int root_count = 1 + count + (Order > 1 ? count * (count + 1) / 2 : 0);
  static constexpr int initial_capacity = 128 << Order;

  // Some motions in a pass: compilers limit the steps of one constant expression.
  static constexpr int motions_in_pass = Order > 1 ? 8 : 32;
  static constexpr int passes_of_order = 1 + (count > 0 ? count - 1 : 0) / motions_in_pass;
  static constexpr int passes = Order * passes_of_order;

  template <class Held, int Pass>
  static constexpr void build(tape_builder& tape, int* roots) {
    if constexpr (Pass == 0) {
      roots[0] = recipe<Node>::template add<tape_use<Order>, Held>(tape);
    }
    constexpr bool is_first = Pass < passes_of_order;
    using use = tape_use<is_first ? Order - 1 : 0>;
    const moving_input inputs[] = {moving_input_of<use, Held>(tape, Motions{})..., moving_input()};
    tape_motion motion(tape.capacity());
    constexpr int first = Pass % passes_of_order * motions_in_pass;
    constexpr int end = first + motions_in_pass < count ? first + motions_in_pass : count;
    if constexpr (is_first) {
      motion.need(tape, roots[0]);
      for (int m = first; m < end; ++m) {
        motion.template add_rates<use>(tape, roots[0] + 1, inputs + m, 1);
        roots[1 + m] =
            column_of<Node::kind_of, Frame>(motion, tape_term<use>{&tape, roots[0]}).index;
      }
    } else {
      // Rows of the Hessian, which need the roots from the m-th on.
      int last = 0;
      for (int j = 0; j < count; ++j) {
        last = roots[1 + j] > last ? roots[1 + j] : last;
        if (j >= end) {
          motion.need(tape, roots[1 + j]);
        }
      }
      int k = 1 + count + end * count - end * (end - 1) / 2;
      for (int m = end - 1; m >= first; --m) {
        motion.need(tape, roots[1 + m]);
        motion.template add_rates<use>(tape, last + 1, inputs + m, 1);
        k -= count - m;
        for (int j = m; j < count; ++j) {
          roots[k + j - m] = motion.rates[roots[1 + j]];
        }
      }
    }
  }
};

} // namespace duet::expression::detail
