// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/structure.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/parts.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/printed.hpp>

#include <cstddef>
#include <string>
#include <tuple>
#include <utility>

/// \file
/// The derivative of an operation that says none of its own: by dual numbers, to any order.

namespace duet::expression {

namespace detail {

/// x + ε ẋ, with the ε of a derivative inside that of rigid motion.
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

/// D f(x…)[ẋ…]: operands are those of f, then their rates.
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
    return {(style == notation::latex ? "\\mathrm{D}" : "D ") + f.inside(precedence::atom) + "[" +
            rates + "]"};
  }
};

} // namespace op
} // namespace duet::expression
