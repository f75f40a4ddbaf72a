// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/end_conditions.hpp>
#include <duet/spline/orientations.hpp>
#include <duet/spline/rotation_vector_spline.hpp>

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// Hermite interpolation: curves through data points with given velocities.

namespace duet {

/// Hermite curve, C¹, through rotations or poses with a given velocity at each: Q(u) = Q_i
/// exp(x_i(u − u_i)) with cubic x_i. No equations are solved. For smooth motion it is fourth-order
/// accurate in value, third in velocity.
///
/// \param samples     data points Q_i, unit quaternions or poses; signs are aligned first
/// \param velocities  angular velocities, for poses twists [v; ω], per unit of the parameter
/// \param frame       axes of the velocities: `frame::spatial` or `frame::body`
/// \return `rotation_vector_spline<T, 4>`
/// \throws invalid_sample for a data point that no curve can pass through, and for a velocity that
/// is not finite
/// \throws invalid_input for fewer than two data points or counts that differ
template <class Q, class V, FrameConstant Frame>
[[nodiscard]] auto hermite_spline(const std::vector<real_type_t<Q>>& parameters,
                                  const std::vector<quaternion<Q>>& samples,
                                  const std::vector<V>& velocities, Frame frame) {
  using T = promote_t<Q, typename V::Scalar>;
  detail::check_samples("hermite_spline", parameters, samples.size(), 2);
  detail::require(velocities.size() == samples.size(), "duet: hermite_spline: ", samples.size(),
                  " samples, but ", velocities.size(), " velocities");
  auto elements =
      align_quaternion_signs(std::vector<quaternion<T>>(samples.begin(), samples.end()));
  std::vector<std::array<vector3<T>, 1>> rates;
  rates.reserve(velocities.size());
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    if (!velocities[i].allFinite()) {
      detail::raise(invalid_sample(i, "the velocity is not finite"));
    }
    const vector3<T> half = detail::half_rate<T>(velocities[i]);
    if constexpr (detail::is_spatial(frame)) {
      rates.push_back({rotate(conj(elements[i]), half)});
    } else {
      rates.push_back({half});
    }
  }
  return rotation_vector_spline<T, 4>(parameters, std::move(elements), rates);
}

/// Rejected: velocities without their frame, which would be ambiguous.
template <class T, class V>
DUET_REFUSED(
    "the frame is missing: hermite_spline(parameters, elements, velocities, frame::spatial) or "
    "frame::body")
rotation_vector_spline<T, 4> hermite_spline(const std::vector<real_type_t<T>>&,
                                            const std::vector<quaternion<T>>&,
                                            const std::vector<V>&);

} // namespace duet
