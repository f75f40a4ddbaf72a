// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/refused.hpp>
#include <duet/core/config.hpp>
#include <duet/core/zero_initialized.hpp>

#include <Eigen/Core>

/// \file
/// End conditions of interpolating curves: natural, clamped, not-a-knot, periodic and others.
///
/// Velocities and accelerations are per unit of the parameter, in spatial axes: angular velocities
/// and accelerations as 3-vectors for rotations, twists [v; ω] and their derivatives as 6-vectors
/// for poses.

namespace duet {
/// Natural ends: no angular or twist acceleration at either end, for motions that start and end
/// uniformly. The assumption is wrong for most motions and costs accuracy near the ends.
struct natural {};

/// Clamped ends: given angular velocities or twists; default 0, at rest. (SciPy's `clamped` is
/// always zero slope.)
template <class V = Eigen::Matrix<double, 3, 1>>
struct clamped {
  /// ω or [v; ω] at the first data point, spatial axes, per unit of u.
  V start = detail::zero_initialized<V>();
  /// ω or [v; ω] at the last data point, spatial axes, per unit of u.
  V end = detail::zero_initialized<V>();
};

/// Given angular accelerations or derivatives of twists at the ends; default 0.
template <class V = Eigen::Matrix<double, 3, 1>>
struct end_acceleration {
  /// ω̇ or [v̇; ω̇] at the first data point, spatial axes, per unit of u².
  V start = detail::zero_initialized<V>();
  /// ω̇ or [v̇; ω̇] at the last data point, spatial axes, per unit of u².
  V end = detail::zero_initialized<V>();
};

/// Given angular velocities and accelerations, or twists and their derivatives, at both ends: all
/// end conditions that a quintic can meet. (If only velocities or only accelerations are given,
/// continuity of the fifth derivative at the second knot replaces the other condition.)
template <class V = Eigen::Matrix<double, 3, 1>>
struct fully_clamped {
  clamped<V> velocity;              ///< velocities at both ends
  end_acceleration<V> acceleration; ///< accelerations at both ends
};

/// Not-a-knot ends: the first two segments are one polynomial, and so are the last two; for motions
/// with unknown rates at the ends.
struct not_a_knot {};

/// Periodic curve: the motion and its rates close on themselves; the last data point repeats the
/// first.
struct periodic {};

namespace detail {

/// Type of numbers given as angular velocities or twists, which is rejected.
struct rate_of_number {
  constexpr rate_of_number() = default;
  DUET_REFUSED("rates at the ends are vectors, angular velocities (3) or twists (6): "
               "clamped{Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, 2)}; clamped{} is at rest")
  rate_of_number(double);
};

} // namespace detail

clamped(double, double)->clamped<detail::rate_of_number>;
end_acceleration(double, double)->end_acceleration<detail::rate_of_number>;
template <class V>
clamped(V, V) -> clamped<typename V::PlainObject>;
template <class A, class B>
clamped(A, B) -> clamped<typename A::PlainObject>;
template <class V>
end_acceleration(V, V) -> end_acceleration<typename V::PlainObject>;
template <class A, class B>
end_acceleration(A, B) -> end_acceleration<typename A::PlainObject>;
template <class V, class W>
fully_clamped(clamped<V>, end_acceleration<W>) -> fully_clamped<V>;

} // namespace duet
