// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// From which solution an arm can follow a path.

#include <duet/kinematics/robots.hpp>
#include <duet/robotics/choose_start.hpp>

#include <cstddef>

std::size_t poses_reached(duet::dual_quaternion<double> (*path)(double)) {
  return duet::find_start_configuration(duet::robots::panda(), path, 0, 1).plan.joints.size();
}
