// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <concepts>
#include <type_traits>

/// \file
/// Frames in which velocities are expressed, as constants of distinct types: `frame::spatial` …;
/// sides of perturbations.

namespace duet {

/// Type of `frame::spatial`.
struct spatial_frame {};
/// Type of `frame::body`.
struct body_frame {};
/// Type of `frame::hybrid`.
struct hybrid_frame {};

namespace frame {

/// Fixed axes; linear velocities are of the body point at the fixed origin.
inline constexpr spatial_frame spatial{};
/// Axes and origin of the moving body.
inline constexpr body_frame body{};
/// Fixed axes; linear velocities are of the moving body's origin.
inline constexpr hybrid_frame hybrid{};

} // namespace frame

/// The type of a constant in namespace `frame`.
template <class Frame>
concept FrameConstant = std::same_as<Frame, spatial_frame> || std::same_as<Frame, body_frame> ||
    std::same_as<Frame, hybrid_frame>;

/// Side on which a small rotation vector or twist δ perturbs a rotation or pose q. Jacobians with
/// respect to q and of q are those of δ.
enum class perturbation {
  right, ///< q exp(δ/2): δ in body axes
  left   ///< exp(δ/2) q: δ in spatial axes
};

namespace detail {

/// Frame of ω alone: rotations have no origin, and the axes of `frame::hybrid` are fixed.
template <class Frame>
[[nodiscard]] constexpr auto rotation_frame_of(Frame frame) {
  if constexpr (std::is_same_v<Frame, hybrid_frame>) {
    return frame::spatial;
  } else {
    return frame;
  }
}

/// True for spatial, false for body axes, the only two frames of pure rotation.
template <class Frame>
[[nodiscard]] constexpr bool is_spatial(Frame) {
  static_assert(std::is_same_v<Frame, spatial_frame> || std::is_same_v<Frame, body_frame>,
                "duet: an angular velocity is expressed in frame::spatial or frame::body");
  return std::is_same_v<Frame, spatial_frame>;
}

} // namespace detail
} // namespace duet
