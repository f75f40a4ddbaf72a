// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Joints along a screw motion.

#include <duet/kinematics/robots.hpp>
#include <duet/robotics/plan_screw_motion.hpp>

Eigen::Matrix<double, 7, 1> last(const Eigen::Matrix<double, 7, 1>& start,
                                 const duet::dual_quaternion<double>& goal) {
  return duet::plan_screw_motion(duet::robots::panda(), start, goal).joints.back();
}
