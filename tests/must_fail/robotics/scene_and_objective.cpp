// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: (a scene is passed as the objective|the argument after the objective)
// forms: 7

#include <duet/kinematics/robots.hpp>
#include <duet/robotics/choose_start.hpp>
#include <duet/robotics/follow_path.hpp>
#include <duet/robotics/goals.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

#include <vector>

int main() {
  using namespace duet;
  const auto arm = robots::panda();
  const Eigen::Matrix<double, 7, 1> start = Eigen::Matrix<double, 7, 1>::Zero();
  const auto goal = arm.pose(start);
  const auto path = [&](double) { return goal; };
  const scene around;
  const std::vector<sphere<>> spheres(1);
#if DUET_MUST_FAIL == 1
  static_cast<void>(inverse_kinematics(arm, goal, start, {}, around));
#elif DUET_MUST_FAIL == 2
  static_cast<void>(inverse_kinematics(arm, position_goal({.5, 0, .5}), start, {}, around));
#elif DUET_MUST_FAIL == 3
  static_cast<void>(follow_path(arm, start, path, 0, 1, {}, around));
#elif DUET_MUST_FAIL == 4
  static_cast<void>(find_start_configuration(arm, path, 0, 1, {}, around));
#elif DUET_MUST_FAIL == 5
  static_cast<void>(inverse_kinematics(arm, goal, start, {}, no_objective{}, spheres));
#elif DUET_MUST_FAIL == 6
  static_cast<void>(follow_path(arm, start, path, 0, 1, {}, no_objective{}, spheres));
#elif DUET_MUST_FAIL == 7
  static_cast<void>(find_start_configuration(arm, path, 0, 1, {}, no_objective{}, spheres));
#else
  static_cast<void>(inverse_kinematics(arm, goal, start, {}, no_objective{}, around));
#endif
}
