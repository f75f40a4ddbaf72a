// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/end_conditions.hpp>
#include <duet/spline/half_rate.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>

/// \file
/// End conditions as data, so that the equations are compiled once for all kinds.

namespace duet {
namespace detail {

enum class end_condition_kind {
  natural,
  velocity,
  acceleration,
  velocity_and_acceleration,
  not_a_knot,
  periodic
};

/// \throws invalid_input for a velocity or acceleration that is not finite
template <class V>
void check_end_rates(const char* condition, const V& start, const V& end) {
  static_assert(V::SizeAtCompileTime == 3 || V::SizeAtCompileTime == 6,
                "duet: end rates are angular, 3-vectors, or twists [v; ω], 6-vectors");
  const auto check = [&](const char* which, const V& rate) {
    for (int i = 0; i < V::SizeAtCompileTime; ++i) {
      if (!(innermost(rate[i]) - innermost(rate[i]) == 0)) {
        raise(invalid_input(
            message("duet: ", condition, ": the rate at the ", which, ", (",
                    rate.transpose().format({Eigen::StreamPrecision, Eigen::DontAlignCols, ", "}),
                    "), is not finite")));
      }
    }
  };
  check("start", start);
  check("end", end);
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
    detail::check_end_rates("clamped", ends.start, ends.end);
    velocity = {detail::half_rate<T>(ends.start), detail::half_rate<T>(ends.end)};
  }
  template <class V>
  curve_ends(const end_acceleration<V>& ends)
      : curve_ends(detail::end_condition_kind::acceleration) {
    detail::check_end_rates("end_acceleration", ends.start, ends.end);
    acceleration = {detail::half_rate<T>(ends.start), detail::half_rate<T>(ends.end)};
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
