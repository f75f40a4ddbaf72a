// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/expression/call.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/formula.hpp>
#include <duet/expression/node.hpp>
#include <duet/expression/variables.hpp>

#include <Eigen/Core>

/// \file
/// Gradients and Hessians of scalar formulas. Which derivatives are zero is known to the compiler.

namespace duet::expression {

namespace detail {

/// The gradient of a formula, to be called with values for its symbols.
template <class F, class Variables>
class gradient_of {
public:
  constexpr explicit gradient_of(const F& f) : f_(f) {}

  template <class... Arguments>
  [[nodiscard]] DUET_ALWAYS_INLINE auto operator()(const Arguments&... arguments) const {
    if constexpr (call_of<typename F::held_type>::template is_complete<Arguments...>()) {
      return with_motions(typename Variables::motions{}, arguments...);
    }
  }

private:
  using node = typename F::node_type;

  template <class... Motions, class... Arguments>
  [[nodiscard]] DUET_ALWAYS_INLINE auto with_motions(motion_list<Motions...>,
                                                     const Arguments&... arguments) const {
    using S = typename given<typename F::held_type, Arguments...>::scalar;
    const auto values = called<node, rate_t<node, Motions>...>(f_.held(), arguments...);
    value_and_gradient<S, Eigen::Matrix<S, int(sizeof...(Motions)), 1>> result;
    result.value = values[node{}];
    int i = 0;
    ((result.gradient[i++] = S(values[rate_t<node, Motions>{}])), ...);
    return result;
  }

  F f_;
};

/// The Hessian, its upper triangle evaluated.
template <class F, class Variables>
class hessian_of {
public:
  constexpr explicit hessian_of(const F& f) : f_(f) {}

  template <class... Arguments>
  [[nodiscard]] DUET_ALWAYS_INLINE auto operator()(const Arguments&... arguments) const {
    if constexpr (call_of<typename F::held_type>::template is_complete<Arguments...>()) {
      return with_motions(typename Variables::motions{}, arguments...);
    }
  }

private:
  using node = typename F::node_type;

  template <class Motion, class... Rest>
  struct row {
    using roots = boost::mp11::mp_list<rate_t<rate_t<node, Motion>, Motion>,
                                       rate_t<rate_t<node, Motion>, Rest>...>;
  };
  template <class... Motions>
  struct rows {
    using roots = boost::mp11::mp_list<>;
  };
  template <class Motion, class... Rest>
  struct rows<Motion, Rest...> {
    using roots =
        boost::mp11::mp_append<typename row<Motion, Rest...>::roots, typename rows<Rest...>::roots>;
  };

  template <class... Motions, class... Arguments>
  [[nodiscard]] DUET_ALWAYS_INLINE auto with_motions(motion_list<Motions...>,
                                                     const Arguments&... arguments) const {
    return with_second(motion_list<Motions...>{}, typename rows<Motions...>::roots{}, arguments...);
  }
  template <class... Motions, class... Second, class... Arguments>
  [[nodiscard]] DUET_ALWAYS_INLINE auto with_second(motion_list<Motions...>,
                                                    boost::mp11::mp_list<Second...>,
                                                    const Arguments&... arguments) const {
    constexpr int n = int(sizeof...(Motions));
    using S = typename given<typename F::held_type, Arguments...>::scalar;
    const auto values = called<node, rate_t<node, Motions>..., Second...>(f_.held(), arguments...);
    value_gradient_and_hessian<S, Eigen::Matrix<S, n, 1>, Eigen::Matrix<S, n, n>> result;
    result.value = values[node{}];
    int i = 0;
    ((result.gradient[i++] = S(values[rate_t<node, Motions>{}])), ...);
    int i_second = 0, j_second = 0;
    const auto write = [&](const S& x) DUET_INLINE_LAMBDA {
      result.hessian(i_second, j_second) = x;
      result.hessian(j_second, i_second) = x;
      if (++j_second == n) {
        j_second = ++i_second;
      }
    };
    (write(S(values[Second{}])), ...);
    return result;
  }

  F f_;
};

} // namespace detail

/// f and its gradient by the variables in their order, a function to be called by name:
/// `auto [y, g] = gradient(f, wrt(u, w))(u = 0.3, w = w0)`.
template <Formula F, class... Symbols>
[[nodiscard]] constexpr auto gradient(const F& f, variables<Symbols...>) {
  static_assert(F::node_type::kind_of == kind::scalar,
                "duet: a gradient is that of a scalar formula; others have a jacobian");
  return detail::gradient_of<F, variables<Symbols...>>(f);
}

/// f, its gradient and its symmetric Hessian, to be called likewise.
template <Formula F, class... Symbols>
[[nodiscard]] constexpr auto hessian(const F& f, variables<Symbols...>) {
  static_assert(F::node_type::kind_of == kind::scalar,
                "duet: a Hessian is that of a scalar formula");
  return detail::hessian_of<F, variables<Symbols...>>(f);
}

} // namespace duet::expression
