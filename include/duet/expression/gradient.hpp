// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/evaluate/call.hpp>
#include <duet/expression/evaluate/variables.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>

#include <Eigen/Core>
#include <boost/mp11/list.hpp>

/// \file
/// Gradients and Hessians of scalar formulas. Which derivatives are zero is known to the compiler.

namespace duet::expression {

namespace detail {

/// The gradient of a formula, to be called with values for its symbols.
template <class F, class Motions>
class gradient_of;
template <class F, class... Motions>
class gradient_of<F, motion_list<Motions...>>
    : public called_by_name<gradient_of<F, motion_list<Motions...>>, F> {
  using base = called_by_name<gradient_of, F>;
  using typename base::node;

public:
  using base::base;

  template <class... Arguments>
  [[nodiscard]] DUET_ALWAYS_INLINE auto evaluate(const Arguments&... arguments) const {
    constexpr int n = int(sizeof...(Motions));
    using S = typename base::template scalar<Arguments...>;
    const auto values = called<node, rate_t<node, Motions>...>(this->f_.held(), arguments...);
    value_and_gradient<S, Eigen::Matrix<S, n, 1>> result;
    result.value = values.template get<0>();
    int i = 0;
    values.template each<1, n>([&](const auto& x)
                                   DUET_INLINE_LAMBDA { result.gradient[i++] = S(x); });
    return result;
  }
};

/// The second derivatives of a node by motions i ≤ j, row by row.
template <class Node, class... Motions>
struct upper_triangle {
  using type = boost::mp11::mp_list<>;
};
template <class Node, class Motion, class... Rest>
struct upper_triangle<Node, Motion, Rest...> {
  using by_motion = rate_t<Node, Motion>;
  using type = boost::mp11::mp_append<
      boost::mp11::mp_list<rate_t<by_motion, Motion>, rate_t<by_motion, Rest>...>,
      typename upper_triangle<Node, Rest...>::type>;
};

/// The Hessian, its upper triangle evaluated.
template <class F, class Motions>
class hessian_of;
template <class F, class... Motions>
class hessian_of<F, motion_list<Motions...>>
    : public called_by_name<hessian_of<F, motion_list<Motions...>>, F> {
  using base = called_by_name<hessian_of, F>;
  using typename base::node;

public:
  using base::base;

  template <class... Arguments>
  [[nodiscard]] DUET_ALWAYS_INLINE auto evaluate(const Arguments&... arguments) const {
    return with_second(typename upper_triangle<node, Motions...>::type{}, arguments...);
  }

private:
  template <class... Second, class... Arguments>
  [[nodiscard]] DUET_ALWAYS_INLINE auto with_second(boost::mp11::mp_list<Second...>,
                                                    const Arguments&... arguments) const {
    constexpr int n = int(sizeof...(Motions));
    using S = typename base::template scalar<Arguments...>;
    const auto values =
        called<node, rate_t<node, Motions>..., Second...>(this->f_.held(), arguments...);
    value_gradient_and_hessian<S, Eigen::Matrix<S, n, 1>, Eigen::Matrix<S, n, n>> result;
    result.value = values.template get<0>();
    int i = 0;
    values.template each<1, n>([&](const auto& x)
                                   DUET_INLINE_LAMBDA { result.gradient[i++] = S(x); });
    int i_second = 0, j_second = 0;
    values.template each<1 + n, int(sizeof...(Second))>([&](const auto& x) DUET_INLINE_LAMBDA {
      result.hessian(i_second, j_second) = S(x);
      result.hessian(j_second, i_second) = S(x);
      if (++j_second == n) {
        j_second = ++i_second;
      }
    });
    return result;
  }
};

} // namespace detail

/// f and its gradient by the variables in their order, a function to be called by name:
/// `auto [y, g] = gradient(f, wrt(u, w))(u = 0.3, w = w0)`.
template <Formula F, class... Symbols>
[[nodiscard]] constexpr auto gradient(const F& f, variables<Symbols...>) {
  static_assert(F::node_type::kind_of == kind::scalar,
                "duet: a gradient is that of a scalar formula; others have a jacobian");
  return detail::gradient_of<F, typename variables<Symbols...>::motions>(f);
}

/// f, its gradient and its symmetric Hessian, to be called likewise.
template <Formula F, class... Symbols>
[[nodiscard]] constexpr auto hessian(const F& f, variables<Symbols...>) {
  static_assert(F::node_type::kind_of == kind::scalar,
                "duet: a Hessian is that of a scalar formula");
  return detail::hessian_of<F, typename variables<Symbols...>::motions>(f);
}

} // namespace duet::expression
