// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/promotion.hpp>

#include <concepts>

/// \file
/// Interface of infinitesimal numbers. `dual`, `taylor` and `second_order_dual` implement it, in
/// one header each; functions, rotations, matrices, lanes and drivers use nothing else. Another one
/// is a class that fulfils `Level`, has the kernels that `detail::infinitesimal_operators` turns
/// into operators, and specialises `scalar_traits`. For those who extend duet.

namespace duet {
namespace detail {

/// Common part of `scalar_traits` of a level over T.
template <class T, class Tag, int Order>
struct level_traits {
  using value_type = T;
  using real_type = typename scalar_traits<T>::real_type;
  using tag = Tag;
  static constexpr bool is_infinitesimal = true;
  static constexpr int order = scalar_traits<T>::order + Order;
};

/// Sine and cosine of one argument, see rules/lift.hpp.
template <class T>
struct sine_cosine;

struct some_function {
  template <class P, class... Rest>
  P operator()(const P& part, const Rest&...) const;
};
struct some_predicate {
  template <class P>
  bool operator()(const P& part) const;
};
struct some_rule {
  template <class T>
  T value(const T& x) const;
  template <class T>
  T slope(const T& x, const T& value) const;
};

} // namespace detail

/// An infinitesimal number D over T = `scalar_traits<D>::value_type`: its value and further parts,
/// all of them a T.
template <class D>
concept Level = Infinitesimal<D> &&
    requires(const D& x, const typename scalar_traits<D>::value_type& v,
             const detail::sine_cosine<typename scalar_traits<D>::value_type>& pair) {
  requires std::same_as<over<D, typename scalar_traits<D>::value_type>, D>;
  /// number of further parts; negative: its maximum
  { D::part_count } -> std::convertible_to<int>;
  /// the part without ε, on whose value branches depend
  { x.value() } -> std::convertible_to<typename scalar_traits<D>::value_type>;
  /// parts as read by drivers: 0 the value, then derivatives
  { x.part(0) } -> std::same_as<typename scalar_traits<D>::value_type>;
  /// x with another value
  { x.with_value(v) } -> std::same_as<D>;
  /// f(value…), then f of every other part of x and of numbers like it: D over the result type of f
  { x.zip(detail::some_function{}, x) } -> std::same_as<D>;
  /// true if the predicate holds for the value and for all other parts
  x.all_of(detail::some_predicate{});
  /// slope · x, where zero parts stay zero even if slopes are infinite
  { D::zero_preserving_product(x, x) } -> std::same_as<D>;
  /// the function of a rule, of one argument or more (with `slopes`)
  { D::lift(detail::some_rule{}, x) } -> std::same_as<D>;
  /// sine and cosine of x from those of its value; with 1 the hyperbolic ones
  { D::template lift_pair<-1>(pair, x) } -> std::same_as<detail::sine_cosine<D>>;
};

} // namespace duet
