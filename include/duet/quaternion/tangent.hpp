// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/derivative/frame.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/dual/number/promotion.hpp>
#include <duet/dual/number/tag.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rate.hpp>

#include <type_traits>

/// \file
/// The tangent space of rotations, as `derivative/` must know it.

namespace duet {

/// A unit quaternion is moved by a small rotation vector δ: exp(δ/2) q in spatial axes, q exp(δ/2)
/// in those of the body. Its rate is told as the angular velocity (N7).
template <class T>
  requires(!detail::contains_tag<T, screw_tag>())
struct manifold<quaternion<T>> {
  static constexpr int dimension = 3;
  using scalar = T;
  template <class Delta, class Frame = spatial_frame>
  [[nodiscard]] static auto plus(const quaternion<T>& q, const Delta& delta, Frame frame = {}) {
    using S = std::decay_t<decltype(delta[0])>;
    const auto turn = duet::exp(vector3<S>(delta[0] / 2, delta[1] / 2, delta[2] / 2));
    if constexpr (detail::is_spatial(frame)) {
      return turn * q;
    } else {
      return q * turn;
    }
  }
  static constexpr bool takes_rates_of_any_scalar = true;
  template <class R, class Frame>
  [[nodiscard]] static vector3<promote_t<T, R>> velocity(const quaternion<T>& q,
                                                         const quaternion<R>& rate, Frame frame) {
    return angular_velocity(q, rate, frame);
  }
};

} // namespace duet
