// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: [a-z_]* takes the coordinates of one configuration
// within: 2
// forms: 5

#include <duet/kinematics/manipulability.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/robotics/inverse_kinematics.hpp>
#include <duet/robotics/plan_screw_motion.hpp>

#include <Eigen/Core>

#include <iostream>

using namespace duet;

int main() {
  const auto arm = robots::panda();
  const Eigen::MatrixXd thetas = Eigen::MatrixXd::Zero(7, 5);
  const dual_quaternion<double> goal(screw_dual<double>(1));
#if DUET_MUST_FAIL == 1
  std::cout << arm.pose(thetas) << "\n";
#elif DUET_MUST_FAIL == 2
  std::cout << jacobian(arm, thetas, frame::hybrid) << "\n";
#elif DUET_MUST_FAIL == 3
  const double w = manipulability(arm, thetas);
#elif DUET_MUST_FAIL == 4
  std::cout << inverse_kinematics(arm, goal, thetas).joints << "\n";
#elif DUET_MUST_FAIL == 5
  const auto plan = plan_screw_motion(arm, thetas, goal);
#else
  std::cout << arm.pose(thetas.col(1)) << jacobian(arm, thetas.col(1), frame::hybrid)
            << manipulability(arm, thetas.col(1))
            << inverse_kinematics(arm, goal, thetas.col(1)).joints << "\n";
#endif
}
