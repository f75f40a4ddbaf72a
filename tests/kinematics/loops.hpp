// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "kinematics/trees.hpp"
#include "support/test.hpp"

#include <duet/kinematics/kinematic_tree.hpp>
#include <duet/kinematics/tree_loop.hpp>
#include <duet/robotics/closed_tree.hpp>

/// \file
/// Closed-chain mechanisms for tests.

namespace duet_test {

inline Eigen::VectorXd vector_of(std::initializer_list<double> x) {
  return Eigen::Map<const Eigen::VectorXd>(x.begin(), Eigen::Index(x.size()));
}

/// Frame at a point, with the axes of the link.
inline duet::placement<double> at_point(double x, double y, double z = 0) {
  return placement_at(0, 0, 0, x, y, z);
}

/// A chain of revolute joints about the z axes of the frames, on a base; the links are named "0"
/// (the base), "1" …
inline duet::robot_description revolute_chain(const std::vector<duet::placement<double>>& origins) {
  duet::robot_description robot;
  robot.links = {{"0"}};
  for (std::size_t i = 0; i < origins.size(); ++i) {
    robot.links.push_back({std::to_string(i + 1)});
    robot.joints.push_back({"j" + std::to_string(i + 1),
                            std::to_string(i),
                            std::to_string(i + 1),
                            {duet::joint_kind::continuous, origins[i]}});
  }
  return robot;
}

inline duet::tree_joint revolute_joint(const std::string& name, const std::string& parent,
                                       const duet::placement<double>& origin) {
  return {name, parent, name, {duet::joint_kind::continuous, origin}};
}

/// The crank rotates about (0, 0), the rocker about (ground, 0); the cut joint is that between
/// coupler and rocker.
inline duet::closed_chain_mechanism
four_bar(double crank, double coupler, double rocker, double ground,
         duet::constraint_kind kind = duet::constraint_kind::revolute) {
  duet::robot_description robot;
  robot.links = {{"ground"}, {"crank"}, {"coupler"}, {"rocker"}};
  robot.joints = {revolute_joint("crank", "ground", {}),
                  revolute_joint("coupler", "crank", at_point(crank, 0)),
                  revolute_joint("rocker", "ground", at_point(ground, 0))};
  return duet::closed_chain_mechanism(
      duet::kinematic_tree(robot),
      {{{kind, {"coupler", at_point(coupler, 0)}, {"rocker", at_point(rocker, 0)}}}});
}

/// Two cranks about (∓foot, 0), two couplers that meet in a revolute joint.
inline duet::closed_chain_mechanism five_bar(double foot, double crank, double coupler) {
  duet::robot_description robot;
  robot.links = {{"ground"}, {"left"}, {"left_coupler"}, {"right"}, {"right_coupler"}};
  robot.joints = {revolute_joint("left", "ground", at_point(-foot, 0)),
                  revolute_joint("left_coupler", "left", at_point(crank, 0)),
                  revolute_joint("right", "ground", at_point(foot, 0)),
                  revolute_joint("right_coupler", "right", at_point(crank, 0))};
  return duet::closed_chain_mechanism(duet::kinematic_tree(robot),
                                      {{{duet::constraint_kind::revolute,
                                         {"left_coupler", at_point(coupler, 0)},
                                         {"right_coupler", at_point(coupler, 0)}}}});
}

/// One loop of revolute joints with the link lengths and twists of Denavit and Hartenberg and no
/// offsets, cut at the last joint.
inline duet::closed_chain_mechanism ring(const std::vector<std::array<double, 2>>& links) {
  std::vector<duet::placement<double>> origins = {{}};
  const auto link = [&](std::size_t i) {
    return placement_at(links[i][1], 0, 0, links[i][0], 0, 0);
  };
  for (std::size_t i = 0; i + 2 < links.size(); ++i) {
    origins.push_back(link(i));
  }
  const duet::placement<double> back(duet::conj(link(links.size() - 1).pose()));
  return duet::closed_chain_mechanism(duet::kinematic_tree(revolute_chain(origins)),
                                      {{{duet::constraint_kind::revolute,
                                         {std::to_string(links.size() - 1), link(links.size() - 2)},
                                         {"0", back}}}});
}

} // namespace duet_test
