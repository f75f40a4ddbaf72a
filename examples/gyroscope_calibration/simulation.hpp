// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "calibration.hpp"

#include <duet/core/random_source.hpp>
#include <duet/io/recording.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/interpolate.hpp>

#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

/// \file
/// Curves through recordings, and readings of a gyroscope that moves along them.

namespace gyroscope_calibration {

/// The curve through the rotations of a file, or of a synthetic recording: a sensor turned by hand
/// for a minute, 100 rotations a second.
inline curve recorded_motion(const std::optional<std::string>& file) {
  std::vector<double> times;
  std::vector<rotation> rotations;
  if (file) {
    const auto recording = duet::load_recording<double>(*file);
    times = recording.table.parameters;
    rotations = recording.table.elements;
  } else {
    for (int i = 0; i <= 6000; ++i) {
      const double t = .01 * i;
      times.push_back(t);
      rotations.push_back(duet::from_rotation_vector(
          vector3(.6 * std::sin(2.6 * t), .7 * std::cos(1.8 * t), .8 * std::sin(2 * t) + .3 * t)));
    }
  }
  if (times.size() < 4) {
    throw std::runtime_error(file.value_or("") + ": " + std::to_string(times.size()) +
                             " rotations (expected at least 4)");
  }
  return duet::interpolate<curve>(times, rotations);
}

/// Readings at a rate from `begin` to `end` with errors of normal distribution.
inline std::vector<reading> simulated(const curve& motion, const calibration& truth, double begin,
                                      double end, double rate, double noise, std::uint64_t seed) {
  duet::random_source random(seed);
  std::vector<reading> result;
  for (int i = 0; begin + i / rate <= end; ++i) {
    const double time = begin + i / rate;
    const vector3 omega = motion.motion(time + truth.offset, duet::frame::body).velocity;
    const vector3 error{random.normal(), random.normal(), random.normal()};
    result.push_back({time, rotate(conj(truth.sensor), omega) + truth.bias + noise * error});
  }
  return result;
}

} // namespace gyroscope_calibration
