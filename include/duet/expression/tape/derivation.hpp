// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/evaluate/variables.hpp>
#include <duet/expression/tape/builder.hpp>
#include <duet/expression/tape/program.hpp>
#include <duet/expression/tape/recipe.hpp>
#include <duet/expression/tape/term.hpp>
#include <duet/expression/tree/node.hpp>

#include <cstddef>

/// \file
/// Derivatives of formulas of scalars and vectors on a tape.

namespace duet::expression::detail {

template <class Motion>
struct moved_input;
template <class Symbol, class Rate>
struct moved_input<movement<moving<Symbol, Rate>>> {
  using symbol = Symbol;
  using rate = Rate;
};
template <class Motion>
inline constexpr bool is_motion_on_tape = false;
template <class Symbol, class Rate>
inline constexpr bool
    is_motion_on_tape<movement<moving<Symbol, Rate>>> = is_kind_on_tape(Symbol::kind_of);
/// True for formulas that are differentiated as data, others are as types.
template <class Node, class... Motions>
inline constexpr bool is_differentiated_on_tape = recipe<Node>::is_differentiated &&
                                                  (is_motion_on_tape<Motions> && ...);

/// Rates of the needed entries before `size`, if an input moves.
constexpr void add_rates(tape_builder& tape, const bool* is_needed, int size, int moving_input,
                         int rate_of_input, int* rates) {
  for (int i = 0; i < size; ++i) {
    if (!is_needed[i]) {
      continue;
    }
    const tape_entry& e = tape[i];
    if (e.code == tape_code::input && e.parameter == moving_input) {
      rates[i] = rate_of_input;
      continue;
    }
    bool is_moving = false;
    const int* x = tape.operands(i);
    for (int k = 0; k < e.count; ++k) {
      is_moving = is_moving || !tape.is_zero(rates[x[k]]);
    }
    rates[i] = is_moving && e.kind_of != kind::condition ? tape.rate(i, rates)
               : e.kind_of == kind::scalar               ? 0
                                                         : tape.zero(e.kind_of);
  }
}

/// Puts a formula and its derivatives up to `Order` on a tape: gradient, and upper triangle of the
/// Hessian, row by row.
template <class Node, int Order, class... Motions>
struct build_derivatives {
  static constexpr int count = int(sizeof...(Motions));
  static constexpr int root_count = 1 + count + (Order > 1 ? count * (count + 1) / 2 : 0);
  static constexpr int initial_capacity = 128 << Order;

  static constexpr int passes = Order;

  template <class Held, int Pass, int Capacity>
  static constexpr void build(tape_builder& tape, int* roots) {
    if constexpr (Pass == 0) {
      roots[0] = recipe<Node>::template add<Order, Held>(tape);
    }
    const int inputs[] = {item_index<typename moved_input<Motions>::symbol, Held>...};
    const int input_rates[] = {
        recipe<typename moved_input<Motions>::rate>::template add<0, Held>(tape)...};
    int rates[std::size_t(Capacity)] = {};
    bool is_needed[std::size_t(Capacity)] = {};
    const int size = tape.size();
    if constexpr (Pass == 0) {
      is_needed[roots[0]] = true;
      mark(tape, is_needed);
      for (int m = 0; m < count; ++m) {
        add_rates(tape, is_needed, size, inputs[m], input_rates[m], rates);
        roots[1 + m] = rates[roots[0]];
      }
    } else {
      int k = root_count;
      for (int m = count - 1; m >= 0; --m) { // with what the roots from the m-th on need
        is_needed[roots[1 + m]] = true;
        mark(tape, is_needed);
        add_rates(tape, is_needed, size, inputs[m], input_rates[m], rates);
        k -= count - m;
        for (int j = m; j < count; ++j) {
          roots[k + j - m] = rates[roots[1 + j]];
        }
      }
    }
  }
};

} // namespace duet::expression::detail
