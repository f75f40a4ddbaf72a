// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "quaternion/truth.hpp"
#include "support/random.hpp"

#include <duet/quaternion/quaternion.hpp>

#include <cmath>
#include <vector>

/// \file
/// Quaternions on which implementations of log and powers fail.

namespace duet_test {

/// The identity, half turns and full turns, exactly and at every distance; both sides of
/// the switches of the algorithms; every norm from 1e-140 to 1e140.
[[nodiscard]] inline std::vector<duet::quaternion<double>> hard_quaternions() {
  using duet::quaternion;
  random_source random(7);
  std::vector<quaternion<double>> result;
  const auto add = [&](double w, double length, double norm) {
    const auto d = random.direction<3>();
    result.push_back({norm * w, norm * length * d[0], norm * length * d[1], norm * length * d[2]});
    result.push_back({norm * w, 0, -norm * length, 0});
  };
  // Below a vector part of 2^-50 |q| (2^-10 in single precision) the algorithm treats q as near a
  // full turn.
  const double sizes[] = {0,       1e-300, 1e-160, 1e-30,   0x0.ffffp-50, 0x1.0001p-50,
                          0x1p-50, 1e-8,   1e-4,   0x1p-10, 0.1};
  for (const double length : sizes) {
    for (const double norm : {1.0, 1e-30, 1e100}) {
      add(1, length, norm); // near the identity
      add(length, 1, norm); // near a half turn
      add(-length, 1, norm);
      if (length * norm > 1e-307) {
        add(-1, length, norm); // near a full turn
      }
    }
  }
  // |q|² is computed directly between 2^-100 and 2^100.
  const double norms[] = {1e-140,       1e-100,      1e-60,       1e-31, 1e-20, 0x0.ffffp-50,
                          0x1.0001p-50, 0x0.ffffp50, 0x1.0001p50, 1e-8,  1e8,   1e20,
                          1e31,         1e60,        1e100,       1e140};
  for (const double norm : norms) {
    const double angle = random.uniform(0, 3.1);
    add(std::cos(angle), std::sin(angle), norm);
    add(-0.9, 0.4, norm);
  }
  for (int i = 0; i < 50; ++i) {
    const auto d = random.direction<4>();
    const double norm = i % 2 == 0 ? 1 : random.log_uniform(1e-140, 1e140);
    result.push_back({norm * d[0], norm * d[1], norm * d[2], norm * d[3]});
  }
  return result;
}

/// Radius about q in which log is smooth: the distance to zero or to the full turns.
[[nodiscard]] inline reference::real smooth_length(const reference::four& q) {
  const reference::real vector_part = reference::length({0, q[1], q[2], q[3]});
  return q[0] < 0 ? vector_part : reference::length(q);
}

} // namespace duet_test
