// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/algebra/power.hpp>
#include <duet/expression/algebra/product.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/tape/builder.hpp>
#include <duet/expression/tape/recipe.hpp>
#include <duet/expression/tree/held.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/vector.hpp>

#include <concepts>
#include <type_traits>
#include <utility>

/// \file
/// Rates of operations on a tape: their rules are applied to terms, which are entries of the tape.

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
template <kind K, int Order>
inline constexpr int order_of(tape_term<K, Order>) {
  return Order;
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
/// Found by arguments.
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

} // namespace duet::expression::detail
