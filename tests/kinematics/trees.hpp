// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "kinematics/arms.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>
#include <duet/kinematics/kinematic_tree.hpp>

#include <Eigen/Core>

/// \file
/// Kinematic trees and configurations for tests.

namespace duet_test {

inline duet::placement<double> placement_at(double a, double b, double c, double x, double y,
                                            double z) {
  return duet::placement<double>(
      duet::pose(duet::from_rotation_vector(Eigen::Vector3d(a, b, c)), Eigen::Vector3d(x, y, z)));
}

/// Every kind of joint, on two arms and a leg, children before parents in the list; axes in general
/// directions, mimic joints, links with and without mass.
inline duet::robot_description all_joints() {
  using duet::joint_kind;
  const auto axis = [](double x, double y, double z) {
    const Eigen::Vector3d n = Eigen::Vector3d(x, y, z).normalized();
    return std::array<double, 3>{n[0], n[1], n[2]};
  };
  const auto mass = [](double m, double x, double y, double z) {
    return duet::link_inertia{m, placement_at(.1, .2, .3, x, y, z), {1, 0, 0, 1, 0, 1}};
  };
  duet::robot_description robot;
  robot.links = {{"finger", mass(.2, .01, .02, .05)},
                 {"world", mass(3, 1, 2, 3)},
                 {"body", mass(5, .1, -.1, .2)},
                 {"shoulder"},
                 {"elbow", mass(1.5, 0, .1, .2)},
                 {"hand", mass(.7, .05, 0, .1)},
                 {"tool", mass(.4, 0, 0, .3)},
                 {"thumb", mass(.1, 0, .03, 0)},
                 {"cart", mass(2, .3, 0, 0)},
                 {"screw", mass(.6, .1, .1, .1)},
                 {"flange"}};
  robot.joints = {
      {"grip",
       "hand",
       "finger",
       {joint_kind::prismatic, placement_at(.3, -1, .2, .1, .2, -.1), axis(1, 2, -.3)}},
      {"free", "world", "body", {joint_kind::floating, placement_at(1, 0, 2, .3, 0, .2)}},
      {"ball", "body", "shoulder", {joint_kind::spherical, placement_at(-.5, .6, 0, 0, .5, 0)}},
      {"bend",
       "shoulder",
       "elbow",
       {joint_kind::revolute, placement_at(0, 0, 1, 0, 0, .4), axis(.2, -.4, 1)}},
      {"turn",
       "elbow",
       "hand",
       {joint_kind::continuous, placement_at(.1, .2, .3, .2, .1, 0), axis(0, 1, 0)}},
      {"weld", "hand", "tool", {joint_kind::fixed, placement_at(2, 1, 0, .05, 0, .1)}},
      {"oppose",
       "hand",
       "thumb",
       {joint_kind::revolute, placement_at(0, .4, 0, 0, .1, .1), axis(1, 1, 1)},
       duet::joint_mimic{"grip", -2.5, .1}},
      {"slide",
       "world",
       "cart",
       {joint_kind::planar, placement_at(.2, .3, -.4, 1, 0, 0), axis(.3, -.5, .7)}},
      {"lead",
       "cart",
       "screw",
       {joint_kind::helical, placement_at(.5, 0, .1, 0, 0, .3), axis(1, 1, -1), {}, .07},
       duet::joint_mimic{"oppose", .5, -.2}},
      {"mount", "world", "flange", {joint_kind::fixed, placement_at(0, 0, 1, -1, 0, 0)}}};
  return robot;
}

/// Configurations: zero, tiny, half turns, near a full turn of rotation vectors, then random.
inline std::vector<Eigen::VectorXd> coordinates_of(const duet::kinematic_tree& tree, int count) {
  const Eigen::Index n = tree.size();
  std::vector<Eigen::VectorXd> result = {
      Eigen::VectorXd::Zero(n), Eigen::VectorXd::Constant(n, 1e-8),
      Eigen::VectorXd::Constant(n, 1e-160), Eigen::VectorXd::Constant(n, 3.141592653589793),
      Eigen::VectorXd::Constant(n, 3.6275987)};
  random_source random(17);
  for (int k = 0; k < count; ++k) {
    Eigen::VectorXd q(n);
    for (double& x : q) {
      x = random.uniform(-2.5, 2.5);
    }
    result.push_back(q);
  }
  return result;
}

} // namespace duet_test
