// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/type_id.hpp>
#include <duet/core/compiler/types.hpp>
#include <duet/core/config.hpp>
#include <duet/expression/tape/builder.hpp>
#include <duet/expression/tree/held.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/printed.hpp>

#include <boost/mp11/algorithm.hpp>
#include <boost/mp11/list.hpp>

#include <concepts>
#include <cstddef>
#include <string_view>
#include <utility>

/// \file
/// Operations, which are types, on a tape. Their rules, of simplification and of differentiation,
/// are applied to terms, which are entries.

namespace duet::expression::op {

struct negative;
struct sum;
struct difference;
struct product;
struct quotient;
struct slope_product;
struct conj;
struct transpose;
struct trace;
struct trace_of_product;
struct matrix_product;
struct sin;
struct cos;
template <int Exponent>
struct whole_power;
template <int I>
struct component;
template <int I, int J, int Rows, int Columns>
struct block;
template <int Rows, int Columns, int I, int J>
struct embedded_block;
template <int Rows, int Columns>
struct entries;
template <bool Dual>
struct part_of_dual;
struct rotation;
struct translation;
template <class Function, class Indices>
struct pushforward;

} // namespace duet::expression::op

namespace duet::expression::detail {

/// Purpose of entries of a tape: rates can be made `Order` times; if they are printed,
/// derivatives of functions are formulas of other functions.
template <int Order, bool IsPrinted = false>
struct tape_use {
  static constexpr int order = Order;
  static constexpr bool is_printed = IsPrinted;
  using lower = tape_use<Order - 1, IsPrinted>;
  using higher = tape_use<Order + 1, IsPrinted>;
};

/// Computes a hash of the name of a type. Types of equal hash are distinguished by address.
template <class T>
[[nodiscard]] constexpr unsigned hash_of_name() {
  const std::string_view name = duet::detail::type_text<T>();
  unsigned hash = unsigned(name.size());
  for (std::size_t i = 60; i < name.size(); ++i) {
    hash = 33 * hash + unsigned(static_cast<unsigned char>(name[i]));
  }
  return hash;
}
template <class T>
inline constexpr unsigned name_hash = hash_of_name<T>();

/// Operations of one code each, without a parameter, from `tape_code::negative` on.
using coded_operations =
    boost::mp11::mp_list<op::negative, op::sum, op::difference, op::product, op::quotient,
                         op::slope_product, op::conj, op::transpose, op::trace,
                         op::trace_of_product, op::matrix_product>;
/// Code of an operation, and its parameter.
template <class Operation>
inline constexpr tape_code
    code_of = boost::mp11::mp_contains<coded_operations, Operation>::value
                  ? tape_code(int(tape_code::negative) +
                              int(boost::mp11::mp_find<coded_operations, Operation>::value))
                  : tape_code::other;
template <>
inline constexpr tape_code code_of<op::sin> = tape_code::sine;
template <>
inline constexpr tape_code code_of<op::cos> = tape_code::cosine;
template <int Exponent>
inline constexpr tape_code code_of<op::whole_power<Exponent>> = tape_code::power;
template <int I>
inline constexpr tape_code code_of<op::component<I>> = tape_code::component;
template <int I, int J, int Rows, int Columns>
inline constexpr tape_code code_of<op::block<I, J, Rows, Columns>> = tape_code::block;
template <int Rows, int Columns, int I, int J>
inline constexpr tape_code code_of<op::embedded_block<Rows, Columns, I, J>> =
    tape_code::embedded_block;
template <int Rows, int Columns>
inline constexpr tape_code code_of<op::entries<Rows, Columns>> = tape_code::entries;
template <class Operation>
inline constexpr int parameter_of = 0;
template <int Exponent>
inline constexpr int parameter_of<op::whole_power<Exponent>> = Exponent;
template <int I>
inline constexpr int parameter_of<op::component<I>> = I;
template <int I, int J, int Rows, int Columns>
inline constexpr int parameter_of<op::block<I, J, Rows, Columns>> = 8 * I + J;
template <int Rows, int Columns, int I, int J>
inline constexpr int parameter_of<op::embedded_block<Rows, Columns, I, J>> = 8 * I + J;

/// The operation of a code with a parameter and a result of a kind.
template <tape_code Code, int Parameter, kind K>
struct operation_of_code {
  using type =
      boost::mp11::mp_at_c<coded_operations, std::size_t(Code) - std::size_t(tape_code::negative)>;
};
template <int Parameter, kind K>
struct operation_of_code<tape_code::entries, Parameter, K> {
  using type = op::entries<rows_of(K), columns_of(K)>;
};
template <int Parameter, kind K>
struct operation_of_code<tape_code::power, Parameter, K> {
  using type = op::whole_power<Parameter>;
};
template <int Parameter, kind K>
struct operation_of_code<tape_code::component, Parameter, K> {
  using type = op::component<Parameter>;
};
template <int Parameter, kind K>
struct operation_of_code<tape_code::block, Parameter, K> {
  using type = op::block<Parameter / 8, Parameter % 8, rows_of(K), columns_of(K)>;
};
template <int Parameter, kind K>
struct operation_of_code<tape_code::embedded_block, Parameter, K> {
  using type = op::embedded_block<rows_of(K), columns_of(K), Parameter / 8, Parameter % 8>;
};

/// True for operations that take the parts of dual numbers with lines and motions apart.
template <class Operation>
inline constexpr bool drops_dual = false;
template <bool Dual>
inline constexpr bool drops_dual<op::part_of_dual<Dual>> = true;
template <>
inline constexpr bool drops_dual<op::rotation> = true;
template <>
inline constexpr bool drops_dual<op::translation> = true;

/// An entry of a tape, to which rules are applied.
template <class Use>
struct tape_term {
  using use = Use;
  tape_builder* tape;
  int index; ///< −1 for the result of a rule that does not apply

  [[nodiscard]] constexpr tape_term at(int i) const { return {tape, i}; }
  [[nodiscard]] constexpr tape_term none() const { return {tape, -1}; }
  [[nodiscard]] constexpr const tape_entry& entry() const { return (*tape)[index]; }
  [[nodiscard]] constexpr kind of_kind() const { return entry().kind_of; }
  [[nodiscard]] constexpr tape_code code() const { return entry().code; }
  [[nodiscard]] constexpr bool is_zero() const { return code() == tape_code::zero; }
  /// True if the term is an operation.
  template <class Operation>
  [[nodiscard]] constexpr bool is() const {
    if constexpr (code_of<Operation> == tape_code::other) {
      return code() == tape_code::other &&
             duet::detail::is_same_type(entry().operation->id, &duet::detail::type_id<Operation>);
    } else {
      return code() == code_of<Operation>;
    }
  }
  [[nodiscard]] constexpr tape_term operand(int i) const { return at(tape->operand(index, i)); }
  /// f of the term for a linear f, with its scale outside: f(−x) = −f(x), f(s x) = s f(x).
  [[nodiscard]] constexpr tape_term scaled_outside(const auto& f) const {
    return at(tape->scaled_like(index, f(at(tape->operand_without_scale(index))).index));
  }
  [[nodiscard]] constexpr bool is_scaled() const { return tape->is_scaled(index); }
};

template <class T>
inline constexpr bool is_tape_term = false;
template <class Use>
inline constexpr bool is_tape_term<tape_term<Use>> = true;

/// Rate of an operation whose rates can be made `Use::order` times.
template <class Operation, class Use, class Indices>
struct rate_on_tape;

/// Text of an operation of some operands.
template <class Operation, std::size_t... I>
[[nodiscard]] printed print_on_tape(notation style, const printed* x) {
  return printed_operation<Operation>(style, x[I]...);
}

template <class Operation, class Use, class Indices>
inline constexpr tape_operation operation_on_tape = {};
template <class Operation, class Use, std::size_t... I>
inline constexpr tape_operation operation_on_tape<Operation, Use, std::index_sequence<I...>> = [] {
  static_assert(sizeof(duet::detail::registered_type<Operation>) > 0);
  tape_operation result = {.id = &duet::detail::type_id<Operation>,
                           .hash = name_hash<Operation>,
                           .drops_dual = drops_dual<Operation>,
                           .order = Use::order};
  if constexpr (Use::order > 0) {
    result.rate = &rate_on_tape<Operation, Use, std::index_sequence<I...>>::make;
  }
  if constexpr (Use::is_printed) {
    result.print = &print_on_tape<Operation, I...>;
  }
  return result;
}();

/// Applies an operation and simplifies the result.
template <class Operation, class Use, std::size_t... I>
[[nodiscard]] constexpr int apply_on_tape(tape_builder& tape, const int* x,
                                          std::index_sequence<I...>) {
  if constexpr (code_of<Operation> != tape_code::other) {
    return tape.apply(code_of<Operation>, Operation::kind_of(tape.kind_of(x[I])...),
                      parameter_of<Operation>, x);
  } else {
    const kind k = Operation::kind_of(tape.kind_of(x[I])...);
    if constexpr (std::derived_from<Operation, linear_operation>) {
      if ((tape.is_zero(x[I]) && ...)) {
        return tape.zero(k);
      }
    } else if constexpr (std::derived_from<Operation, bilinear_operation>) {
      if (tape.is_zero(x[0]) || tape.is_zero(x[1])) {
        return tape.zero(k);
      }
    }
    using term = tape_term<Use>;
    if constexpr (requires { Operation::simplified(term{&tape, x[I]}...); }) {
      const term simple = Operation::simplified(term{&tape, x[I]}...);
      if (simple.index >= 0) {
        return simple.index;
      }
    }
    return tape.other(k, operation_on_tape<Operation, Use, std::index_sequence<I...>>, x,
                      int(sizeof...(I)));
  }
}

// Rules are formulas of terms and of nodes, such as numbers.

/// Converts a node to an entry of a tape.
template <class Node>
struct recipe;

template <class Use>
[[nodiscard]] constexpr int index_on_tape(tape_builder&, tape_term<Use> x) {
  return x.index;
}
template <class Use, Node N>
[[nodiscard]] constexpr int index_on_tape(tape_builder& tape, N) {
  return recipe<N>::template add<Use, held<>>(tape);
}

template <class A, class B>
concept TapeTerms = (is_tape_term<A> && (is_tape_term<B> || Node<B>)) ||
                    (Node<A> && is_tape_term<B>);

/// The first term of some terms and nodes.
template <class Use, class... Rest>
[[nodiscard]] constexpr tape_term<Use> first_term(tape_term<Use> x, Rest...) {
  return x;
}
template <Node N, class... Rest>
  requires(is_tape_term<Rest> || ...)
[[nodiscard]] constexpr auto first_term(N, Rest... rest) { return first_term(rest...); }
template <class Operation, class Use>
[[nodiscard]] constexpr tape_term<Use> applied_by(tape_term<Use> any, auto... x) {
  const int indices[] = {index_on_tape<Use>(*any.tape, x)...};
  return any.at(
      apply_on_tape<Operation, Use>(*any.tape, indices, std::make_index_sequence<sizeof...(x)>{}));
}

template <class Use>
[[nodiscard]] constexpr auto operator-(tape_term<Use> a) {
  return a.at(a.tape->negative(a.index));
}
template <class A, TapeTerms<A> B>
[[nodiscard]] constexpr auto operator+(A a, B b) {
  return applied_by<op::sum>(first_term(a, b), a, b);
}
template <class A, TapeTerms<A> B>
[[nodiscard]] constexpr auto operator-(A a, B b) {
  return applied_by<op::difference>(first_term(a, b), a, b);
}
template <class A, TapeTerms<A> B>
[[nodiscard]] constexpr auto operator*(A a, B b) {
  return applied_by<op::product>(first_term(a, b), a, b);
}
template <class A, TapeTerms<A> B>
[[nodiscard]] constexpr auto operator/(A a, B b) {
  return applied_by<op::quotient>(first_term(a, b), a, b);
}
/// Applies an operation to terms and nodes; rules find it by the type of the terms.
template <class Operation, class... X>
  requires(is_tape_term<X> || ...)
[[nodiscard]] constexpr auto apply(X... x) -> decltype(first_term(x...)) {
  return applied_by<Operation>(first_term(x...), x...);
}

} // namespace duet::expression::detail
