// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// All joints for a pose.

#include <duet/kinematics/robots.hpp>
#include <duet/robotics/all_inverse_kinematics.hpp>

#include <cstddef>

std::size_t count(const duet::dual_quaternion<double>& goal) {
  return duet::all_inverse_kinematics(duet::robots::ur5e(), goal).solutions.size();
}
