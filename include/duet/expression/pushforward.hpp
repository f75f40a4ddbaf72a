// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/derivative/structure.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/expression/formula.hpp>
#include <duet/expression/node.hpp>
#include <duet/expression/printed.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/tangent.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <tuple>
#include <utility>

/// \file
/// The derivative of an operation that has no closed one worth a formula: by dual numbers, to any
/// order.

namespace duet::expression {

namespace detail {

/// x + ε ẋ, with the ε of a derivative inside that of rigid motion.
template <class Tag, class A, class B>
[[nodiscard]] auto with_rate(const A& x, const B& rate) {
  return dual<promote_t<A, B>, 1, Tag>(x, rate);
}
template <class Tag, class A, class B>
[[nodiscard]] auto with_rate(const screw_dual<A>& x, const screw_dual<B>& rate) {
  const auto value = with_rate<Tag>(x.value(), rate.value());
  return screw_dual<std::remove_const_t<decltype(value)>>(
      value, with_rate<Tag>(x.epsilon(), rate.epsilon()));
}
template <class Tag, class A, class B, int Rows, int Columns, int Options>
[[nodiscard]] auto with_rate(const Eigen::Matrix<A, Rows, Columns, Options>& x,
                             const Eigen::Matrix<B, Rows, Columns, Options>& rate) {
  using D = decltype(with_rate<Tag>(x.data()[0], rate.data()[0]));
  Eigen::Matrix<D, Rows, Columns, Options> result;
  for (int i = 0; i < Rows * Columns; ++i) {
    result.data()[i] = with_rate<Tag>(x.data()[i], rate.data()[i]);
  }
  return result;
}
template <class Tag, class A, class B>
[[nodiscard]] auto with_rate(const quaternion<A>& q, const quaternion<B>& rate) {
  using D = decltype(with_rate<Tag>(q.w(), rate.w()));
  return quaternion<D>(with_rate<Tag>(q.w(), rate.w()), with_rate<Tag>(q.x(), rate.x()),
                       with_rate<Tag>(q.y(), rate.y()), with_rate<Tag>(q.z(), rate.z()));
}

} // namespace detail

namespace op {

/// D f(x…)[ẋ…]: operands are those of f, then their rates.
template <class Function, class Indices>
struct pushforward;

template <class Function, std::size_t... I>
struct pushforward<Function, std::index_sequence<I...>> {
  static constexpr std::size_t count = sizeof...(I);

  template <class... Kinds>
  static constexpr kind kind_of(Kinds... kinds) {
    const kind all[] = {kinds...};
    return Function::kind_of(all[I]...);
  }
  template <class... X>
  static auto value(const X&... x) {
    using tag = derivative_tag<pushforward>;
    const auto all = std::tie(x...);
    return duet::detail::parts<tag>(
        Function::value(detail::with_rate<tag>(std::get<I>(all), std::get<I + count>(all))...), 1);
  }
  template <class... X>
  static constexpr auto differential(X... x) {
    static_assert(sizeof...(X) == 4 * count);
    return apply<pushforward<pushforward, std::make_index_sequence<2 * count>>>(x...);
  }
  template <class... P>
  static printed print(notation style, const P&... p) {
    const printed all[] = {p...};
    const printed f = Function::print(style, all[I]...);
    std::string rates;
    ((rates += (I > 0 ? ", " : "") + all[I + count].text), ...);
    return {(style == notation::latex ? "\\mathrm{D}" : "D ") + f.inside(precedence::atom) + "[" +
            rates + "]"};
  }
};

} // namespace op
} // namespace duet::expression
