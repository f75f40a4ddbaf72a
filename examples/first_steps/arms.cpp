// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A robot arm: forward kinematics, Jacobian, inverse kinematics, and a plan along a screw motion.

#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/robotics/inverse_kinematics.hpp>
#include <duet/robotics/plan_screw_motion.hpp>

#include <iostream>

int main() {
  std::cout << std::fixed;
  std::cout.precision(4);
  const auto arm = duet::robots::panda(); // or duet::read_urdf(file, base, tip)
  Eigen::Matrix<double, 7, 1> theta;
  theta << 0, -0.7, 0, -2.3, 0, 1.6, 0.8;
  const auto start = arm.pose(theta);
  std::cout << "the tip is at " << translation(start).transpose() << "\n";
  std::cout << "twists [v; omega] with each joint, in the base's axes, v that of the tip\n"
            << jacobian(arm, theta, duet::frame::hybrid) << "\n";

  // A goal 0.22 m away, with another orientation.
  const auto goal =
      duet::pose(duet::from_axis_angle(duet::vector3<double>(0, 1, 0), 0.3) * rotation(start),
                 duet::vector3<double>(translation(start) + duet::vector3<double>(0.1, 0.2, 0)));
  const auto solution = duet::inverse_kinematics(arm, goal, theta);
  std::cout << "joints there  " << solution.joints.transpose() << "\n";

  const auto plan = duet::plan_screw_motion(arm, theta, goal);
  std::cout << "along a screw " << to_text(plan.reason) << " in " << plan.joints.size()
            << " waypoints, the last at " << plan.joints.back().transpose() << "\n";
}
