// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>

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

namespace detail {

/// Half of a rate, as a vector or a dual vector.
template <class T, class V>
[[nodiscard]] vector3<T> half_rate(const V& rate) {
  const real_type_t<T> half(0.5);
  if constexpr (V::SizeAtCompileTime == 6) {
    using S = typename scalar_traits<T>::value_type;
    return dual_vector_of(vector6<S>(rate.template cast<S>())) * half;
  } else {
    return rate.template cast<T>() * half;
  }
}

enum class end_condition_kind {
  natural,
  velocity,
  acceleration,
  velocity_and_acceleration,
  not_a_knot,
  periodic
};

/// Halved rates at the start and the end.
///
/// \throws invalid_input for a velocity or acceleration that is not finite
template <class T, class V>
[[nodiscard]] std::array<vector3<T>, 2> half_end_rates(const char* condition, const V& start,
                                                       const V& end) {
  static_assert(V::SizeAtCompileTime == 3 || V::SizeAtCompileTime == 6,
                "duet: end rates are angular, 3-vectors, or twists [v; ω], 6-vectors");
  for (const V* rate : {&start, &end}) {
    if (!rate->allFinite()) {
      raise(invalid_input(message(
          "duet: ", condition, ": the rate at the ", rate == &start ? "start" : "end", ", (",
          rate->transpose().format({Eigen::StreamPrecision, Eigen::DontAlignCols, ", "}),
          "), is not finite")));
    }
  }
  return {half_rate<T>(start), half_rate<T>(end)};
}

} // namespace detail

/// End conditions of a curve over T, of any kind: `natural{}`, `clamped{…}`, `end_acceleration{…}`,
/// `fully_clamped{…}`, `not_a_knot{}` or `periodic{}`.
///
/// \throws invalid_input for a velocity or acceleration that is not finite
template <class T>
struct curve_ends {
  using rates = std::array<vector3<T>, 2>; ///< values at the start and at the end

  detail::end_condition_kind kind; ///< kind of end conditions
  rates velocity, acceleration;    ///< halved, in spatial axes; zero if not given

  explicit curve_ends(detail::end_condition_kind k) : kind(k) {
    velocity.fill(vector3<T>::Constant(T(real_type_t<T>(0))));
    acceleration = velocity;
  }
  curve_ends(const natural&) : curve_ends(detail::end_condition_kind::natural) {}
  template <class V>
  curve_ends(const clamped<V>& ends) : curve_ends(detail::end_condition_kind::velocity) {
    velocity = detail::half_end_rates<T>("clamped", ends.start, ends.end);
  }
  template <class V>
  curve_ends(const end_acceleration<V>& ends)
      : curve_ends(detail::end_condition_kind::acceleration) {
    acceleration = detail::half_end_rates<T>("end_acceleration", ends.start, ends.end);
  }
  template <class V>
  curve_ends(const fully_clamped<V>& ends) : curve_ends(ends.velocity) {
    kind = detail::end_condition_kind::velocity_and_acceleration;
    acceleration = curve_ends(ends.acceleration).acceleration;
  }
  curve_ends(const not_a_knot&) : curve_ends(detail::end_condition_kind::not_a_knot) {}
  curve_ends(const periodic&) : curve_ends(detail::end_condition_kind::periodic) {}

  /// Rejects all other types.
  template <class Other>
  curve_ends(const Other&) {
    static_assert(refused<Other>,
                  "duet: interpolate: the end conditions are natural{}, clamped{velocity, "
                  "velocity}, "
                  "end_acceleration{…}, fully_clamped{…}, not_a_knot{} or periodic{}");
  }

  /// End conditions without infinitesimal parts.
  [[nodiscard]] curve_ends<real_type_t<T>> real_part() const {
    curve_ends<real_type_t<T>> result(kind);
    for (std::size_t end = 0; end < 2; ++end) {
      for (int a = 0; a < 3; ++a) {
        result.velocity[end][a] = innermost(velocity[end][a]);
        result.acceleration[end][a] = innermost(acceleration[end][a]);
      }
    }
    return result;
  }

private:
  template <class Other>
  static constexpr bool refused = false;
};

} // namespace duet
