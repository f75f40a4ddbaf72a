// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/promotion.hpp>

#include <concepts>

/// \file
/// What an infinitesimal number says of itself. `dual`, `taylor` and `second_dual` do, in one
/// header each; functions, rotations, matrices, lanes and drivers ask for nothing else. Another one
/// is a class that fulfils `Level`, has the kernels that `detail::infinitesimal_operators` turns
/// into operators, and specialises `scalar_traits`. For those who extend duet.

namespace duet {
namespace detail {

/// What `scalar_traits` of a level over T have in common.
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
  /// how many; negative: at most so many
  { D::part_count } -> std::convertible_to<int>;
  /// the part without ε, which branches look at
  { x.value() } -> std::convertible_to<typename scalar_traits<D>::value_type>;
  /// what a driver reads: 0 the value, then derivatives
  { x.part(0) } -> std::same_as<typename scalar_traits<D>::value_type>;
  /// x with another value
  { x.with_value(v) } -> std::same_as<D>;
  /// f(value…), then f of every other part of x and of numbers like it: D over what f returns
  { x.zip(detail::some_function{}, x) } -> std::same_as<D>;
  /// does it hold for the value and for all other parts?
  x.all_of(detail::some_predicate{});
  /// slope · x, where parts that are zero stay so beside infinite slopes
  { D::surviving_product(x, x) } -> std::same_as<D>;
  /// the function of a rule, of one argument or more (with `slopes`)
  { D::lift(detail::some_rule{}, x) } -> std::same_as<D>;
  /// sine and cosine of x from those of its value; with 1 the hyperbolic ones
  { D::template lift_pair<-1>(pair, x) } -> std::same_as<detail::sine_cosine<D>>;
};

} // namespace duet
