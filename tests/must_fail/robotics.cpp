// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Mistakes that must not compile, see check.cmake.

#include <duet/kinematics/robots.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

#include <Eigen/Geometry>

#include <iostream>
#include <vector>

using namespace duet;
const auto arm = robots::panda();
const Eigen::Matrix<double, 7, 1> start = Eigen::Matrix<double, 7, 1>::Zero();

//// expression_returned
// expect: duet: a function returns an expression of Eigen

#include <duet/robotics/follow_path.hpp>
#include <duet/robotics/plan_screw_motion.hpp>

namespace {

struct posture {
  Eigen::Matrix<double, 7, 1> wanted;
  auto operator()(const auto& theta) const { return (theta - wanted).squaredNorm(); }
#ifdef DUET_MUST_FAIL
  auto gradient(const auto& theta) const { return 2 * (theta - wanted); }
#else
  auto gradient(const auto& theta) const { return (2 * (theta - wanted)).eval(); }
#endif
};

} // namespace

int main() {
  const auto goal = arm.pose(start);
  const posture preference{start};
#ifdef DUET_MUST_FAIL
  const auto square = [](const auto& theta) { return theta.transpose() * theta; };
  const auto path = [&](double) { return goal; };
  static_cast<void>(plan_screw_motion(arm, start, goal, {}, preference)); // mistake
  static_cast<void>(follow_path(arm, start, path, 0, 1, {}, square));     // mistake
#else
  static_cast<void>(plan_screw_motion(arm, start, goal, {}, preference));
#endif
}

//// goal_and_start
// expect: duet: (the start is missing|the goal precedes the start|the goal is a rotation)
// within: 2

const duet::quaternion<double> q(1);
const duet::dual_quaternion<double> goal = pose(q, duet::vector3<double>(0.5, 0, 0.5));
std::cout << inverse_kinematics(arm, goal).joints << "\n";        // wrong
const auto result = inverse_kinematics(arm, start, goal);         // wrong
std::cout << inverse_kinematics(arm, q, start).joints << "\n";    // wrong
std::cout << inverse_kinematics(arm, goal, start).joints << "\n"; // right

//// goal_of_eigen
// expect: duet: a rotation or pose of Eigen: from_eigen
// within: 5

#include <duet/interop/eigen.hpp>

const Eigen::Isometry3d goal = Eigen::Isometry3d::Identity();
const auto result = duet::inverse_kinematics(arm, goal, start);                           // wrong
std::cout << duet::inverse_kinematics(arm, goal, start).joints << "\n";                   // wrong
std::cout << duet::inverse_kinematics(arm, duet::from_eigen(goal), start).joints << "\n"; // right

//// goals_in_part
// expect: duet: (for a position as|the goal is a rotation|the start is missing)
// within: 3

#include <duet/robotics/goals.hpp>

const duet::vector3<double> position(0.5, 0, 0.5);
std::cout << inverse_kinematics(arm, position, start).joints << "\n";                      // wrong
const auto result = inverse_kinematics(arm, duet::quaternion<double>(1), start);           // wrong
std::cout << inverse_kinematics(arm, duet::position_goal(position)).joints << "\n";        // wrong
std::cout << inverse_kinematics(arm, duet::position_goal(position), start).joints << "\n"; // right

//// objective_without_value
// expect: the objective is not a function of the joint coordinates that returns a number

struct gradient_alone {
  template <class X>
  X gradient(const X& theta) const {
    return theta;
  }
};

struct with_value : gradient_alone {
  template <class X>
  auto operator()(const X& theta) const {
    return theta[0] * theta[0];
  }
};

inverse_kinematics_result solve(const dual_quaternion<double>& goal) {
  const gradient_alone objective; // wrong
  const with_value objective;     // right
  return inverse_kinematics(robots::panda(), goal, start, {}, objective);
}

//// path_of_matrices
// expect: duet: follow_path: the path must return a dual_quaternion<double>

#include <duet/interop/eigen.hpp>
#include <duet/robotics/follow_path.hpp>

const auto moved = [](double u) { return Eigen::Isometry3d(Eigen::Translation3d(0, 0, u)); };
static_cast<void>(follow_path(arm, start, moved, 0, 1));          // wrong
const auto path = [&](double u) { return from_eigen(moved(u)); }; // right
static_cast<void>(follow_path(arm, start, path, 0, 1));           // right

//// scene_and_objective
// expect: duet: (a scene is passed as the objective|the argument after the objective)

#include <duet/robotics/choose_start.hpp>
#include <duet/robotics/follow_path.hpp>
#include <duet/robotics/goals.hpp>

const auto goal = arm.pose(start);
const auto path = [&](double) { return goal; };
const scene around;
const std::vector<sphere<>> spheres(1);
static_cast<void>(inverse_kinematics(arm, goal, start, {}, around));                       // wrong
static_cast<void>(inverse_kinematics(arm, position_goal({.5, 0, .5}), start, {}, around)); // wrong
static_cast<void>(follow_path(arm, start, path, 0, 1, {}, around));                        // wrong
static_cast<void>(find_start_configuration(arm, path, 0, 1, {}, around));                  // wrong
static_cast<void>(inverse_kinematics(arm, goal, start, {}, no_objective{}, spheres));      // wrong
static_cast<void>(follow_path(arm, start, path, 0, 1, {}, no_objective{}, spheres));       // wrong
static_cast<void>(find_start_configuration(arm, path, 0, 1, {}, no_objective{}, spheres)); // wrong
static_cast<void>(inverse_kinematics(arm, goal, start, {}, no_objective{}, around));       // right

//// start_of_path
// expect: duet: find_start_configuration takes no start
// within: 3

#include <duet/robotics/choose_start.hpp>

const auto path = [](double u) {
  return duet::pose(duet::quaternion<double>(1), duet::vector3<double>(u, 0, 0.5));
};
std::cout << find_start_configuration(arm, start, path, 0.5, 1).starts << "\n"; // wrong
std::cout << find_start_configuration(arm, path, 0.5, 1).starts << "\n";        // right
