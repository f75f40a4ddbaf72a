// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/random_source.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/io/recording.hpp>
#include <duet/quaternion/rotation.hpp>

#include <cmath>
#include <cstddef>

/// \file
/// A synthetic recording, used without a file.

namespace fit_trajectory {

using recording = duet::recording<duet::screw_dual<double>>;
using duet::vector3;

/// A hand-held figure of eight over 12 s, sampled at 100 Hz with noise of 1 mm and 2 mrad; 2 % of
/// the samples are outliers.
inline recording synthetic_recording() {
  duet::random_source random(2026);
  recording result;
  const auto random_vector = [&](double size) -> vector3<double> {
    return size * vector3<double>{random.normal(), random.normal(), random.normal()};
  };
  for (std::size_t i = 0; i <= 1200; ++i) {
    const double t = double(i) / 100;
    const vector3<double> position(0.5 * std::sin(t), 0.3 * std::sin(2 * t),
                                   1 + 0.1 * std::cos(3 * t));
    const vector3<double> rotation_vector(0.4 * std::sin(1.3 * t), 0.5 * std::cos(0.9 * t),
                                          0.8 * std::sin(t));
    const bool is_far_off = random.unit() < 0.02;
    const auto noise =
        duet::pose(duet::from_rotation_vector(random_vector(is_far_off ? 0.2 : 0.002)),
                   random_vector(is_far_off ? 0.1 : 0.001));
    result.table.parameters.push_back(t);
    result.table.elements.push_back(
        duet::pose(duet::from_rotation_vector(rotation_vector), position) * noise);
    result.lines.push_back(i + 1);
  }
  return result;
}

} // namespace fit_trajectory
