// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/expression/arithmetic.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/expression/tape/derivation.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/tree/printed.hpp>

#include <cstddef>
#include <string>
#include <tuple>
#include <utility>

/// \file
/// Derivatives of formulas as formulas.

namespace duet::expression {

namespace detail {

// Derivatives of any order of operations without a rule of their own, by dual numbers.

/// x + ε ẋ. Dual vectors and poses have this ε in their real and dual parts.
template <class Tag, class X>
[[nodiscard]] auto with_rate(const X& x, const auto& rate) {
  return map_scalars(
      []<class A, class B>(const A& value, const B& slope) {
        if constexpr (duet::detail::contains_tag<A, screw_tag>()) {
          return value.zip([](const auto& p, const auto& q) { return with_rate<Tag>(p, q); },
                           slope);
        } else {
          return dual<promote_t<A, B>, 1, Tag>(value, slope);
        }
      },
      x, rate);
}

} // namespace detail

namespace op {

/// Directional derivative D f(x…)[ẋ…]: its operands are those of f, then their rates.
template <class Function, class Indices>
struct pushforward;

template <class Function, std::size_t... I>
struct pushforward<Function, std::index_sequence<I...>> {
  static constexpr std::size_t count = sizeof...(I);

  static constexpr kind kind_of(auto... kinds) {
    const kind all[] = {kinds...};
    return Function::kind_of(all[I]...);
  }
  static auto value(const auto&... x) {
    using tag = derivative_tag<pushforward>;
    const auto all = std::tie(x...);
    return duet::detail::parts<tag>(
        Function::value(detail::with_rate<tag>(std::get<I>(all), std::get<I + count>(all))...), 1);
  }
  static printed print(notation style, const auto&... p) {
    const printed all[] = {p...};
    const printed f = detail::printed_operation<Function>(style, all[I]...);
    std::string rates;
    ((rates += (I > 0 ? ", " : "") + all[I + count].text), ...);
    return {(style != notation::text ? "\\mathrm{D}" : "D ") + f.inside(precedence::atom) + "[" +
            rates + "]"};
  }
};

} // namespace op

namespace detail {

template <class Symbol>
using moving_scalar = moving<Symbol, number_node<bits_of(1)>>;

template <class T>
inline constexpr bool is_symbol_formula = false;
template <class NodeType, class Held>
inline constexpr bool is_symbol_formula<formula<NodeType, Held>> = is_symbol<NodeType>;

template <class T>
concept ScalarSymbol = is_symbol_formula<T> && ScalarTerm<T>;

} // namespace detail

/// A formula that is one symbol.
template <class T>
concept Symbol = detail::is_symbol_formula<T>;

/// ∂f/∂u of any formula with respect to a scalar symbol: of a vector or matrix by component, of a
/// quaternion or pose in its algebra (N6).
template <Formula F, detail::ScalarSymbol U>
[[nodiscard]] constexpr auto derivative(const F& f, const U&) {
  using node = typename F::node_type;
  return make_formula(rate_node<node, detail::moving_scalar<typename U::node_type>>{}, f.held());
}
template <Formula F, Symbol U>
  requires(!detail::ScalarSymbol<U>)
DUET_REFUSED("derivative(f, u) is by a scalar symbol; by vectors, matrices, rotations and poses "
             "there are gradient(f, wrt(w)) and jacobian(f, wrt(w))")
F derivative(const F&, const U&);
template <Formula F, class... X>
  requires(sizeof...(X) != 1 || (!Symbol<X> || ...))
DUET_REFUSED("derivative(f, u) is by one symbol, as symbol<\"u\"> u; it is called with values "
             "afterwards, derivative(f, u)(u = 0.3)")
F derivative(const F&, const X&...);

/// A symbol and the direction in which it moves; made by `along`.
template <class SymbolType, Term Direction>
struct moved {
  Direction direction; ///< a formula of the symbol's kind
};

/// Pairs a symbol u with the direction in which it moves, a formula of its kind.
template <Symbol U, Formula Direction>
[[nodiscard]] constexpr auto along(const U&, const Direction& direction) {
  static_assert(U::node_type::kind_of == Direction::node_type::kind_of,
                "duet: along(u, v): the direction is of the symbol's kind");
  return moved<typename U::node_type, Direction>{direction};
}

/// Directional derivative Σ ∂f/∂uᵢ u̇ᵢ of f, whose symbols move along formulas:
/// `directional_derivative(f, along(u, v), along(w, s))`.
template <Formula F, class... SymbolType, class... Direction>
[[nodiscard]] constexpr auto directional_derivative(const F& f,
                                                    const moved<SymbolType, Direction>&... m) {
  using rate = rate_node<typename F::node_type,
                         detail::moving<SymbolType, typename Direction::node_type>...>;
  return make_formula(rate{}, merged(f.held(), m.direction.held()...));
}

} // namespace duet::expression
