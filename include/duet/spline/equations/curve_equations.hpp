// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/end_conditions.hpp>

#include <concepts>
#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// Requirements of `interpolate` on a type of curve. For those who extend duet.

namespace duet {

/// Type of curves through rotations or poses, with its scalar, its parameter's type and its order.
template <class S>
concept CurveType = requires {
  typename S::scalar_type;
  typename S::real_type;
  S::order;
};

namespace detail {

/// Equations over T of curves of type `Spline`, found by `interpolate`; a new type of curve
/// specialises this.
template <class Spline, class T = typename Spline::scalar_type>
struct equations_of {};
template <class Spline, class T = typename Spline::scalar_type>
using equations_of_t = typename equations_of<Spline, T>::type;

/// Equations F(x) = 0 for the parameters of an interpolating curve, in blocks of N numbers.
///
/// They are constructed from parameters, samples with aligned signs and end conditions, and have
/// - `min_samples(kind)`, the minimum number of samples for these end conditions;
/// - `start()`, the initial guess, near the solution for small rotations;
/// - `residuals(x, r)`, which sets r = F(x);
/// - `scale(λ)`, which changes the equations to those of a smaller motion;
/// - `relative_step(x, step)`, the size of a step relative to the values it changes;
/// - `curve(u, q, x)`, the curve of a solution;
/// - over real numbers, `linearise(x, r, matrix)`: F and its factorised Jacobian, false if that is
///   singular.
template <class E>
concept CurveEquations = requires(E e, const E f, const typename E::unknowns x,
                                  typename E::unknowns r, typename E::real_type lambda,
                                  const typename E::matrix& jacobian) {
  { E::min_samples(end_condition_kind()) } -> std::same_as<std::size_t>;
  f.residuals(x, r);
  e.scale(lambda);
  { f.max_rotation() } -> std::same_as<std::pair<typename E::real_type, std::size_t>>;
  { f.unevenness() } -> std::convertible_to<typename E::real_type>;
  jacobian.solve(r);
};

} // namespace detail
} // namespace duet
