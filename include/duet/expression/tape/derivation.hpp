// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/algebra/power.hpp>
#include <duet/expression/algebra/product.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/evaluate/variables.hpp>
#include <duet/expression/tape/builder.hpp>
#include <duet/expression/tape/program.hpp>
#include <duet/expression/tape/recipe.hpp>
#include <duet/expression/tree/held.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/vector.hpp>

#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

/// \file
/// Derivatives of formulas of scalars and vectors on a tape. The rules of operations are applied to
/// terms, which are entries of the tape.

namespace duet::expression::op {

struct select;

} // namespace duet::expression::op

namespace duet::expression::detail {

/// A node on the tape. Rules may be applied to it `Order` times.
template <kind K, int Order>
struct tape_term {
  static constexpr kind kind_of = K;
  tape_builder* tape;
  int index;
};

template <class T>
inline constexpr bool is_tape_term = false;
template <kind K, int Order>
inline constexpr bool is_tape_term<tape_term<K, Order>> = true;

/// Simplified entry of an operation that the algebra does not know, or −1.
template <class Operation>
struct simplified_on_tape {
  static constexpr int of(tape_builder&, const int*) { return -1; }
};
template <>
struct simplified_on_tape<op::cross> {
  static constexpr int of(tape_builder& tape, const int* x) {
    return x[0] == x[1] ? tape.zero(tape[x[0]].kind_of) : -1;
  }
};
template <int I>
struct simplified_on_tape<op::component<I>> {
  static constexpr int of(tape_builder& tape, const int* x) {
    const tape_entry& v = tape[x[0]];
    return v.code == tape_code::unit_vector ? tape.number(v.parameter == I ? 1 : 0) : -1;
  }
};
template <>
struct simplified_on_tape<op::select> {
  static constexpr int of(tape_builder&, const int* x) { return x[1] == x[2] ? x[1] : -1; }
};

/// Applies an operation and simplifies the result.
template <class Operation, int Order, kind... K>
[[nodiscard]] constexpr int apply_on_tape(tape_builder& tape, const int (&x)[sizeof...(K)]) {
  constexpr tape_code code = code_of<Operation>;
  if constexpr (code == tape_code::negative) {
    return tape.negative(x[0]);
  } else if constexpr (code == tape_code::sine) {
    return tape.sine(x[0]);
  } else if constexpr (code == tape_code::cosine) {
    return tape.cosine(x[0]);
  } else if constexpr (code == tape_code::sum) {
    return tape.sum(x[0], x[1]);
  } else if constexpr (code == tape_code::difference) {
    return tape.difference(x[0], x[1]);
  } else if constexpr (code == tape_code::product) {
    return tape.product(x[0], x[1]);
  } else if constexpr (code == tape_code::quotient) {
    return tape.quotient(x[0], x[1]);
  } else if constexpr (code == tape_code::slope_product) {
    return tape.slope_product(x[0], x[1]);
  } else {
    if constexpr (std::derived_from<Operation, linear_operation>) {
      bool is_zero = true;
      for (int i : x) {
        is_zero = is_zero && tape.is_zero(i);
      }
      if (is_zero) {
        return tape.zero(Operation::kind_of(K...));
      }
    } else if constexpr (std::derived_from<Operation, bilinear_operation>) {
      if (tape.is_zero(x[0]) || tape.is_zero(x[1])) {
        return tape.zero(Operation::kind_of(K...));
      }
    }
    if (const int known = simplified_on_tape<Operation>::of(tape, x); known >= 0) {
      return known;
    }
    return add_operation<Operation, Order, K...>(tape, x);
  }
}

// Terms of rules.

template <int Order, kind K>
[[nodiscard]] constexpr int index_on_tape(tape_builder&, tape_term<K, Order> x) {
  return x.index;
}
template <int Order, Node N>
[[nodiscard]] constexpr int index_on_tape(tape_builder& tape, N) {
  return recipe<N>::template add<Order, held<>>(tape);
}

template <int Order, class Operation, class... X>
[[nodiscard]] constexpr auto applied_on_tape(tape_builder& tape, X... x) {
  const int indices[] = {index_on_tape<Order>(tape, x)...};
  return tape_term<Operation::kind_of(X::kind_of...), Order>{
      &tape, apply_on_tape<Operation, Order, X::kind_of...>(tape, indices)};
}

template <class A, class B>
concept TapeTerms = (is_tape_term<A> && (is_tape_term<B> || Node<B>)) ||
                    (Node<A> && is_tape_term<B>);

/// The tape of some terms and nodes.
template <kind K, int Order, class... Rest>
[[nodiscard]] constexpr tape_term<K, Order> tape_of(tape_term<K, Order> x, Rest...) {
  return x;
}
template <Node N, class... Rest>
[[nodiscard]] constexpr auto tape_of(N, Rest... rest) {
  return tape_of(rest...);
}
template <class Operation, kind K, int Order>
[[nodiscard]] constexpr auto applied_by(tape_term<K, Order> any, auto... x) {
  return applied_on_tape<Order, Operation>(*any.tape, x...);
}

template <kind K, int Order>
[[nodiscard]] constexpr auto operator-(tape_term<K, Order> a) {
  return applied_by<op::negative>(a, a);
}
template <class A, TapeTerms<A> B>
[[nodiscard]] constexpr auto operator+(A a, B b) {
  return applied_by<op::sum>(tape_of(a, b), a, b);
}
template <class A, TapeTerms<A> B>
[[nodiscard]] constexpr auto operator-(A a, B b) {
  return applied_by<op::difference>(tape_of(a, b), a, b);
}
template <class A, TapeTerms<A> B>
[[nodiscard]] constexpr auto operator*(A a, B b) {
  return applied_by<op::product>(tape_of(a, b), a, b);
}
template <class A, TapeTerms<A> B>
[[nodiscard]] constexpr auto operator/(A a, B b) {
  return applied_by<op::quotient>(tape_of(a, b), a, b);
}
/// Applies an operation to terms and nodes; rules find it by the type of the terms.
template <class Operation, class... X>
  requires(is_tape_term<X> || ...)
[[nodiscard]] constexpr auto apply(X... x) { return applied_by<Operation>(tape_of(x...), x...); }

// Rates.

template <class Operation, int Order, kind... K>
struct rate_on_tape {
  static constexpr int make(tape_builder& tape, const int* x, const int* rates) {
    return index_on_tape<Order - 1>(
        tape, by_rule(std::make_integer_sequence<int, int(sizeof...(K))>{}, tape, x, rates));
  }

private:
  template <kind L>
  using term = tape_term<L, Order - 1>;

  template <int... I>
  static constexpr auto by_rule(std::integer_sequence<int, I...>, tape_builder& tape, const int* x,
                                const int* rates) {
    if constexpr (
        requires {
          Operation::differential(term<K>{&tape, x[I]}..., term<K>{&tape, rates[x[I]]}...);
        }) {
      return Operation::differential(term<K>{&tape, x[I]}..., term<K>{&tape, rates[x[I]]}...);
    } else if constexpr (std::derived_from<Operation, linear_operation>) {
      return apply<Operation>(term<K>{&tape, rates[x[I]]}...);
    } else if constexpr (std::derived_from<Operation, bilinear_operation>) {
      return rate_of_product<Operation>(term<K>{&tape, x[I]}..., term<K>{&tape, rates[x[I]]}...);
    } else if constexpr (requires { Operation::template slope_by<0>(term<K>{&tape, x[I]}...); }) {
      return (... + by_operand<I>(term<K>{&tape, rates[x[I]]}, term<K>{&tape, x[I]}...));
    } else {
      return apply<op::pushforward<Operation, std::make_index_sequence<sizeof...(K)>>>(
          term<K>{&tape, x[I]}..., term<K>{&tape, rates[x[I]]}...);
    }
  }
  /// Contribution of the I-th operand: its slope times its rate.
  template <int I, kind L>
  static constexpr auto by_operand(term<L> rate, auto... x) {
    if constexpr (L == kind::scalar && Operation::kind_of(K...) == kind::scalar) {
      return term<L>{rate.tape, rate.tape->is_zero(rate.index)
                                    ? 0
                                    : applied_by<op::slope_product>(
                                          rate, Operation::template slope_by<I>(x...), rate)
                                          .index};
    } else {
      return Operation::template slope_by<I>(x...) * rate;
    }
  }
};

// Derivatives.

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
/// True for formulas that are differentiated as data, others as types.
template <class Node, class... Motions>
inline constexpr bool is_differentiated_on_tape = recipe<Node>::is_differentiated &&
                                                  (is_motion_on_tape<Motions> && ...);

/// Finds the rates of the needed entries before `size` if an input moves. Entries are indices.
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
