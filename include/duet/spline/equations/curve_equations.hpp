// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/curve_ends.hpp>

#include <concepts>
#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// What `interpolate` needs to know of a kind of curve. For those who extend duet.

namespace duet {

/// A type of curves through rotations or poses: over which scalar, by which parameter, of which
/// order.
template <class S>
concept CurveType = requires {
  typename S::scalar_type;
  typename S::real_type;
  S::order;
};

namespace detail {

/// The equations over T of curves of type `Spline`: a new kind of curve specialises this, and
/// `interpolate` finds it.
template <class Spline, class T = typename Spline::scalar_type>
struct equations_of {};
template <class Spline, class T = typename Spline::scalar_type>
using equations_of_t = typename equations_of<Spline, T>::type;

/// Equations F(x) = 0 for what a curve through given rows is made of, in blocks of N numbers.
///
/// They are constructed from parameters, rows whose signs are aligned and ends, and have
/// `least_rows(kind)` that those ends need; `start()`, near the solution where turns are small;
/// `residuals(x, r)`, r = F(x); `scale(λ)`, become those of a motion that turns less;
/// `relative_step(x, step)`, how large a step is in relation to what it changes; `curve(u, q, x)`,
/// the curve that a solution makes. Over real numbers also `linearise(x, r, matrix)`, F and its
/// factorised Jacobian, false where that is singular.
template <class E>
concept CurveEquations = requires(E e, const E f, const typename E::unknowns x,
                                  typename E::unknowns r, typename E::real_type lambda,
                                  const typename E::matrix& jacobian) {
  { E::least_rows(end_kind()) } -> std::same_as<std::size_t>;
  f.residuals(x, r);
  e.scale(lambda);
  { f.largest_turn() } -> std::same_as<std::pair<typename E::real_type, std::size_t>>;
  { f.unevenness() } -> std::convertible_to<typename E::real_type>;
  jacobian.solve(r);
};

} // namespace detail
} // namespace duet
