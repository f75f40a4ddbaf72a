// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "support/gap.hpp"
#include "support/random.hpp"

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>

#include <numbers>
#include <vector>

/// \file
/// Poses at which formulas may fail, and random poses.

namespace duet_test {

using pose_type = duet::dual_quaternion<double>;
using vector = Eigen::Vector3d;

/// Identity, pure translations, pure rotations about axes through the origin and elsewhere, tiny,
/// half turns, nearly full turns, random.
inline std::vector<pose_type> poses() {
  std::vector<pose_type> result;
  const vector zero = vector::Zero();
  using std::numbers::pi;
  for (const vector& w : {zero, vector(1e-160, 0, 0), vector(0, 1e-8, 0), vector(1e-4, -2e-4, 0),
                          vector(0, 0, 1), vector(0.3, -1.2, 0.7), vector(pi, 0, 0),
                          vector(0, 0.6 * pi, 0.8 * pi), vector(0, 0, 2 * pi - 1e-6)}) {
    for (const vector& t : {zero, vector(1e-8, 0, 0), vector(0, 0, 2), vector(-3, 1, 0.5)}) {
      result.push_back(duet::pose(duet::from_rotation_vector(w), t));
    }
  }
  random_source random(4);
  for (int i = 0; i < 30; ++i) {
    const auto axis = random.direction<3>();
    const double angle = random.uniform(0, 3);
    result.push_back(
        duet::pose(duet::from_rotation_vector(vector(angle * vector(axis[0], axis[1], axis[2]))),
                   vector(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2))));
  }
  return result;
}

/// The largest difference of the eight components.
inline double max_abs_difference(const pose_type& a, const pose_type& b) {
  const pose_type d = a - b;
  double largest = 0;
  for (const auto& part : {duet::real_part(d), duet::dual_part(d)}) {
    for (const double x : {part.w(), part.x(), part.y(), part.z()}) {
      largest = std::max(largest, std::abs(x));
    }
  }
  return largest;
}

} // namespace duet_test
