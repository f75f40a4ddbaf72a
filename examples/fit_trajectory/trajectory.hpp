// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/random_source.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/recording.hpp>

#include <cmath>
#include <cstddef>

/// \file
/// A recording for those who have none at hand.

namespace fit_trajectory {

using recording = duet::recording<duet::screw_dual<double>>;
using duet::vector3;

/// A hand-held figure of eight over 12 s, seen 100 times a second with 1 mm and 2 mrad of noise,
/// two rows in a hundred far off.
inline recording made_up_recording() {
  duet::random_source random(2026);
  recording result;
  const auto shaken = [&](double size) -> vector3<double> {
    return size * vector3<double>{random.normal(), random.normal(), random.normal()};
  };
  for (std::size_t i = 0; i <= 1200; ++i) {
    const double t = double(i) / 100;
    const vector3<double> place(0.5 * std::sin(t), 0.3 * std::sin(2 * t),
                                1 + 0.1 * std::cos(3 * t));
    const vector3<double> turn(0.4 * std::sin(1.3 * t), 0.5 * std::cos(0.9 * t), 0.8 * std::sin(t));
    const bool is_far_off = random.unit() < 0.02;
    const auto noise = duet::pose(duet::from_rotation_vector(shaken(is_far_off ? 0.2 : 0.002)),
                                  shaken(is_far_off ? 0.1 : 0.001));
    result.table.parameters.push_back(t);
    result.table.elements.push_back(duet::pose(duet::from_rotation_vector(turn), place) * noise);
    result.lines.push_back(i + 1);
  }
  return result;
}

} // namespace fit_trajectory
