// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "formulas/formula.hpp"
#include "formulas/parts.hpp"

#include <duet/expression/derivative.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/expression/text.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>

/// \file
/// Rows of the table as expressions.

namespace duet_formulas {

/// Index of a dual number in the arguments.
struct dual_at {
  std::size_t first;
};

/// Stands for a parameter that is 0.
struct zero {};

/// Variable input: a symbol, the symbol of its rate, and the index of its components.
template <class Symbol, class Rate, class Position>
struct moving {
  Symbol symbol;
  Rate rate;
  Position position;
};
template <class Symbol, class Rate>
moving(Symbol, Rate, int) -> moving<Symbol, Rate, std::size_t>;
template <class Symbol, class Rate>
moving(Symbol, Rate, dual_at) -> moving<Symbol, Rate, dual_at>;
/// Constant input: a symbol, and the index of its components or `zero`.
template <class Symbol, class Position>
struct still {
  Symbol symbol;
  Position position;
};
template <class Symbol>
still(Symbol, int) -> still<Symbol, std::size_t>;
template <class Symbol>
still(Symbol, zero) -> still<Symbol, zero>;

template <class Symbol>
auto read(const numbers<double>& x, std::size_t i) {
  using duet::expression::kind;
  constexpr kind k = Symbol::node_type::kind_of;
  if constexpr (k == kind::scalar) {
    return x[i];
  } else if constexpr (k == kind::vector) {
    return v_of(x, i);
  } else if constexpr (k == kind::quaternion) {
    return q_of(x, i);
  } else if constexpr (k == kind::dual_vector) {
    return duet::make_dual_vector(v_of(x, i), v_of(x, i + 3));
  } else {
    return duet::make_dual_quaternion(q_of(x, i), q_of(x, i + 4));
  }
}
template <class Symbol>
auto read(const numbers<double>& x, dual_at position) {
  return duet::screw_dual<double>(x[position.first], x[position.first + 1]);
}

template <class Symbol>
double read(const numbers<double>&, zero) {
  return 0;
}

/// Values of the symbols, for a call by name.
template <class... Inputs>
auto read_all(const numbers<double>& x, const Inputs&... in) {
  return std::tuple((in.symbol = read<decltype(in.symbol)>(x, in.position))...);
}
template <class... Inputs>
auto read_rates(const numbers<double>& d, const Inputs&... in) {
  return std::tuple((in.rate = read<decltype(in.rate)>(d, in.position))...);
}

template <class F, class Moves, class Stands>
expression_route expression_route::part(const F& f, const Moves& moves, const Stands& stands) && {
  const auto rate = std::apply(
      [&](const auto&... m) { return directional_derivative(f, along(m.symbol, m.rate)...); },
      moves);
  text += (text.empty() ? "`" : ", `") + to_text(f) + "`";
  derivative = "`directional_derivative`";
  const auto symbols_at = [=](const numbers<double>& x) {
    return std::apply([&](const auto&... in) { return read_all(x, in...); },
                      std::tuple_cat(moves, stands));
  };
  values_.push_back([=](numbers<double>& y, const numbers<double>& x) {
    append(y, std::apply(f, symbols_at(x)));
  });
  slopes_.push_back([=](numbers<double>& y, const numbers<double>& x, const numbers<double>& d) {
    const auto rates = std::apply([&](const auto&... in) { return read_rates(d, in...); }, moves);
    append(y, std::apply(rate, std::tuple_cat(symbols_at(x), rates)));
  });
  return std::move(*this);
}

} // namespace duet_formulas
