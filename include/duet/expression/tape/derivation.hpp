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

  // Some motions in a pass: compilers limit the steps of one constant expression.
  static constexpr int motions_in_pass = Order > 1 ? 8 : 32;
  static constexpr int passes_of_order = 1 + (count > 0 ? count - 1 : 0) / motions_in_pass;
  static constexpr int passes = Order * passes_of_order;

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
    constexpr int first = Pass % passes_of_order * motions_in_pass;
    constexpr int end = first + motions_in_pass < count ? first + motions_in_pass : count;
    if constexpr (Pass < passes_of_order) {
      is_needed[roots[0]] = true;
      mark(tape, is_needed);
      for (int m = first; m < end; ++m) {
        add_rates(tape, is_needed, roots[0] + 1, inputs[m], input_rates[m], rates);
        roots[1 + m] = rates[roots[0]];
      }
    } else {
      // Rows of the Hessian, which need the roots from the m-th on.
      int last = 0;
      for (int j = 0; j < count; ++j) {
        last = roots[1 + j] > last ? roots[1 + j] : last;
        is_needed[roots[1 + j]] = j >= end;
      }
      int k = 1 + count + end * count - end * (end - 1) / 2;
      for (int m = end - 1; m >= first; --m) {
        is_needed[roots[1 + m]] = true;
        mark(tape, is_needed);
        add_rates(tape, is_needed, last + 1, inputs[m], input_rates[m], rates);
        k -= count - m;
        for (int j = m; j < count; ++j) {
          roots[k + j - m] = rates[roots[1 + j]];
        }
      }
    }
  }
};

} // namespace duet::expression::detail
