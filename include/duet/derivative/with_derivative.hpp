// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/batch/math.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/promotion.hpp>

#include <array>
#include <tuple>
#include <type_traits>
#include <utility>

/// \file
/// Functions with user-defined derivatives.

namespace duet {
namespace detail {

/// f(x…) as a number of the type of its arguments; of batches lane by lane if f takes none.
template <class F, class T, class... Rest>
[[nodiscard]] T call_as(const F& f, const T& x, const Rest&... rest) {
  if constexpr (std::is_invocable_v<const F&, const T&, const Rest&...>) {
    return static_cast<T>(f(x, rest...));
  } else if constexpr (lane_traits<T>::is_batch) {
    return each_lane(f, x, rest...);
  } else {
    static_assert(!Infinitesimal<T>,
                  "duet: with_derivative: derivatives of this order need a derivative that takes "
                  "any scalar, [](const auto& x) { ... }, or that is with_derivative(...) itself");
    static_assert(Infinitesimal<T> || sizeof(T) == 0,
                  "duet: with_derivative: the function does not take numbers of this type; "
                  "trace needs functions of any scalar: [](const auto& x) { ... }");
    return x;
  }
}

/// A function of one scalar or more and its partial derivatives, as a rule of the dual numbers.
template <class F, class... Slopes>
struct given_rule {
  F f;
  std::tuple<Slopes...> partials;

  template <class T, class... Rest>
  T value(const T& x, const Rest&... rest) const {
    if constexpr (Infinitesimal<T>) {
      return lift(*this, x, rest...);
    } else {
      const T y = call_as(f, x, rest...);
      if constexpr (is_recording<T>) {
        if (!y.is_constant()) {
          y.home()->mark_given(y.node_in(*y.home()));
        }
      }
      return y;
    }
  }
  template <class T>
  T slope(const T& x, const T&) const {
    return call_as(std::get<0>(partials), x);
  }
  template <class T, class... X>
  std::array<T, sizeof...(X)> slopes(const T&, const X&... x) const {
    return std::apply(
        [&](const auto&... slope) { return std::array<T, sizeof...(X)>{call_as(slope, x...)...}; },
        partials);
  }
};

template <class X, class... Rest>
struct promoted {
  using type = differentiable_t<X>;
};
template <class X, class Y, class... Rest>
struct promoted<X, Y, Rest...> : promoted<promote_t<differentiable_t<X>, Y>, Rest...> {};

/// True if all objects of the type are alike, so that a formula, which is a type, can hold one.
template <class F>
inline constexpr bool is_stateless = std::is_empty_v<F>&& std::is_default_constructible_v<F>;

} // namespace detail

/// A function of one to three scalars with user-defined derivatives, as `with_derivative` returns.
template <class F, class... Slopes>
class function_with_derivative {
public:
  constexpr function_with_derivative() = default;
  constexpr explicit function_with_derivative(F f, Slopes... slopes)
      : rule_{std::move(f), {std::move(slopes)...}} {}

  /// f of real numbers, dual and Taylor numbers, batches and recorded numbers; constants beside
  /// others are promoted.
  template <class... X>
    requires(sizeof...(X) == sizeof...(Slopes) && ((Scalar<X> || Arithmetic<X>)&&...))
  [[nodiscard]] auto operator()(const X&... x) const {
    using T = typename detail::promoted<X...>::type;
    return rule_.value(static_cast<T>(x)...);
  }
  /// f of formulas of scalars, a formula whose derivatives are the user-defined ones.
  template <class... X>
    requires(sizeof...(X) == sizeof...(Slopes) && (detail::is_symbolic<X> || ...))
  [[nodiscard]] constexpr auto operator()(const X&... x) const {
    static_assert((detail::is_symbolic<X> && ...),
                  "duet: with_derivative: beside formulas, numbers are written as c<2> or are "
                  "symbols");
    static_assert(
        detail::is_stateless<function_with_derivative>,
        "duet: with_derivative: in a formula the function and its derivatives must be lambdas "
        "without captures, [](double x) { return table(x); }, as a formula is a type");
    return formula_of_rule(rule_, x...);
  }

private:
  detail::given_rule<F, Slopes...> rule_;
};

namespace detail {

template <class F, class... Slopes>
inline constexpr bool
    is_stateless<function_with_derivative<F, Slopes...>> = is_stateless<F> &&
                                                           (is_stateless<Slopes> && ...);

} // namespace detail

/// The function f with the derivative df/dx instead of the one that duet would compute.
///
/// For values by tables, iterations, other libraries or handwritten code. Derivatives of any
/// scalar, duals in duals, `taylor`, `second_order_dual` and batches are taken from `slopes`. A
/// derivative that is generic is differentiated by duet for the higher orders; one of `double`
/// alone gives the first order only, unless it is a `with_derivative` as well. In typed formulas f
/// and `slopes` are lambdas without captures or function objects; f prints by its member `name`, or
/// as f. A trace records what f computes, and refuses to be differentiated itself; to have the
/// formula of a derivative, trace the derivative.
///
/// \param f       a function of one, two or three scalars; `double f(double)` suffices
/// \param slopes  ∂f/∂x, of several arguments one partial derivative each, of all arguments
/// \return `function_with_derivative`
///
/// Example: `const auto g = with_derivative(table, [](const auto& x) { return exp(-x * x); });`
template <class F, class... Slopes>
  requires(sizeof...(Slopes) >= 1 && sizeof...(Slopes) <= 3)
[[nodiscard]] constexpr auto with_derivative(F f, Slopes... slopes) {
  return function_with_derivative<F, Slopes...>(std::move(f), std::move(slopes)...);
}

} // namespace duet
