// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/refused.hpp>
#include <duet/core/config.hpp>
#include <duet/core/zero_initialized.hpp>

#include <Eigen/Core>

/// \file
/// What an interpolating curve does at its ends.
///
/// Rates are per unit of the parameter, in spatial axes: angular velocities and accelerations as
/// 3-vectors for rotations, twists [v; ω] and their derivatives as 6-vectors for poses.

namespace duet {
/// No angular or twist acceleration at either end: what to assume when a motion starts and ends
/// evenly. The assumption is wrong for most motions and costs accuracy near the ends.
struct natural {};

/// Given angular velocities, or twists: zero, at rest, unless given.
template <class V = Eigen::Matrix<double, 3, 1>>
struct clamped {
  /// ω or [v; ω] at the first data point, spatial axes, per unit of u.
  V start = detail::zero_initialized<V>();
  /// Likewise, at the last data point.
  V end = detail::zero_initialized<V>();
};

/// Given angular accelerations, or derivatives of twists: zero unless given.
template <class V = Eigen::Matrix<double, 3, 1>>
struct end_acceleration {
  /// ω̇ or [v̇; ω̇] at the first data point, spatial axes, per unit of u².
  V start = detail::zero_initialized<V>();
  /// Likewise, at the last data point.
  V end = detail::zero_initialized<V>();
};

/// Given angular velocities and accelerations, or twists and their derivatives: all that the
/// ends of a quintic can be told. (Of only one of them, the fifth derivative's continuity at the
/// second knot takes the other's place.)
template <class V = Eigen::Matrix<double, 3, 1>>
struct fully_clamped {
  clamped<V> velocity;              ///< at both ends
  end_acceleration<V> acceleration; ///< at both ends
};

/// The first two pieces are one, and so are the last two: what to assume when nothing is known.
struct not_a_knot {};

/// The motion closes on itself, with its rates; the last row repeats the first.
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
