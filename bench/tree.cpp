// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// A robot with two arms on a torso, a head and two grippers, and a single arm, as trees of duet
/// and of Orocos KDL, and the arm as a serial chain.

#include "support/contest.hpp"
#include "workloads.hpp"

#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/kinematic_tree.hpp>
#include <duet/kinematics/tree_jacobian.hpp>

#if DUET_BENCH_KDL
#include <kdl/tree.hpp>
#include <kdl/treejnttojacsolver.hpp>
#endif

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace duet_bench {
namespace {

using duet::joint_kind, duet::placement, duet::quaternion;

const quaternion<double> identity(1);

/// The link has the name of the joint.
void add(duet::robot_description& robot, const std::string& name, const std::string& parent,
         joint_kind kind, const placement<double>& origin, const std::array<double, 3>& axis) {
  robot.links.push_back({name, duet::link_inertia{.mass = 1, .frame = {identity, {0, .01, .05}}}});
  robot.joints.push_back({name, parent, name, {kind, origin, axis}});
}

/// Adds an arm of seven joints and a hand.
/// \param side  prefix of their names
void add_arm(duet::robot_description& robot, const std::string& side, std::string parent,
             placement<double> origin) {
  for (std::size_t i = 0; i < arm.size(); ++i) {
    const arm_row& row = arm[i]; // rotate about x, translate along x, then rotate about z
    const std::string name = side + std::to_string(i);
    origin = origin * placement<double>{quaternion<double>(row.half_cos, row.half_sin, 0, 0), {}} *
             placement<double>{identity, {row.a, 0, row.d}};
    add(robot, name, parent, joint_kind::revolute, origin, {0, 0, 1});
    origin = {};
    parent = name;
  }
  add(robot, side + "_hand", parent, joint_kind::fixed, {identity, {0, 0, .1}}, {0, 0, 1});
}

[[nodiscard]] duet::robot_description two_arms() {
  duet::robot_description robot{.links = {{"base"}}};
  add(robot, "waist", "base", joint_kind::revolute, {identity, {0, 0, .6}}, {0, 0, 1});
  add(robot, "pan", "waist", joint_kind::revolute, {identity, {0, 0, .6}}, {0, 0, 1});
  add(robot, "tilt", "pan", joint_kind::revolute, {identity, {.05, 0, .1}}, {0, 1, 0});
  for (const auto& [side, sign] : {std::pair<std::string, double>("left", 1), {"right", -1}}) {
    add_arm(robot, side, "waist",
            {quaternion<double>(std::cos(.4), -sign * std::sin(.4), 0, 0), {0, sign * .2, .4}});
    add(robot, side + "_finger", side + "_hand", joint_kind::prismatic, {identity, {0, 0, .05}},
        {0, 1, 0});
    add(robot, side + "_thumb", side + "_hand", joint_kind::prismatic, {identity, {0, 0, .05}},
        {0, -1, 0});
  }
  return robot;
}

[[nodiscard]] duet::robot_description one_arm() {
  duet::robot_description robot{.links = {{"base"}}};
  add_arm(robot, "left", "base", {});
  return robot;
}

using coordinates = Eigen::VectorXd;

/// Copies elements one by one: those of KDL are not aligned for this machine.
template <class M>
[[nodiscard]] std::vector<double> numbers(const M& m) {
  std::vector<double> result;
  for (Eigen::Index i = 0; i < m.size(); ++i) {
    result.push_back(m(i % m.rows(), i / m.rows()));
  }
  return result;
}

#if DUET_BENCH_KDL
[[nodiscard]] KDL::Frame frame_of(const placement<double>& a) {
  const auto& q = a.rotation;
  const auto& t = a.translation;
  return {KDL::Rotation::Quaternion(q.x(), q.y(), q.z(), q.w()), KDL::Vector(t[0], t[1], t[2])};
}

struct kdl_tree {
  explicit kdl_tree(const duet::kinematic_tree& robot) : columns(unsigned(robot.size())) {
    tree = KDL::Tree("base");
    for (const duet::tree_joint& joint : robot.joints()) {
      const KDL::Frame origin = frame_of(joint.motion.origin);
      const auto& [x, y, z] = joint.motion.axis;
      const auto kind =
          joint.motion.kind == joint_kind::prismatic ? KDL::Joint::TransAxis : KDL::Joint::RotAxis;
      const KDL::Joint moves =
          joint.motion.kind == joint_kind::fixed
              ? KDL::Joint(joint.name, KDL::Joint::Fixed)
              : KDL::Joint(joint.name, origin.p, origin.M * KDL::Vector(x, y, z), kind);
      tree.addSegment(KDL::Segment(joint.child, moves, origin), joint.parent);
    }
    solver = std::make_unique<KDL::TreeJntToJacSolver>(tree);
    q = KDL::JntArray(tree.getNrOfJoints());
    for (const duet::tree_link& link : robot.links()) {
      links.push_back(tree.getSegment(link.name));
    }
    for (const auto& link : links) { // parents precede their children
      parents.push_back(0);
      if (link != links.front()) {
        const auto& above = GetTreeElementParent(link->second)->first;
        while (links[parents.back()]->first != above) {
          ++parents.back();
        }
      }
    }
    frames.resize(links.size());
  }

  /// Coordinates are in the same order. (KDL's memory is its library's, which was not compiled for
  /// this machine.)
  void set(const coordinates& x) {
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      q(unsigned(i)) = x[i];
    }
  }

  /// Poses of all links in one pass, without the search by name of the solver of KDL.
  void update_frames() {
    for (std::size_t i = 1; i < links.size(); ++i) {
      const auto& element = links[i]->second;
      frames[i] =
          frames[parents[i]] * GetTreeElementSegment(element).pose(q(GetTreeElementQNr(element)));
    }
  }

  KDL::Tree tree;
  std::unique_ptr<KDL::TreeJntToJacSolver> solver;
  std::vector<KDL::SegmentMap::const_iterator> links;
  std::vector<std::size_t> parents;
  std::vector<KDL::Frame> frames;
  KDL::JntArray q;
  KDL::Jacobian columns;
};

void register_kdl_jacobian(const std::string& workload, const duet::kinematic_tree& robot,
                           const coordinates& q) {
  const auto kdl = std::make_shared<kdl_tree>(robot);
  const auto jacobian_of = [kdl](const coordinates& x) {
    kdl->set(x);
    (void)kdl->solver->JntToJac(kdl->q, kdl->columns, "left_hand");
    return &kdl->columns;
  };
  expect_agreement(workload, "kdl",
                   numbers(jacobian(robot, q, duet::frame::hybrid, robot.link("left_hand"))),
                   numbers(jacobian_of(q)->data));
  register_benchmark(workload, "kdl", q, jacobian_of);
}

void register_kdl_poses(const duet::kinematic_tree& robot, const coordinates& q) {
  const auto kdl = std::make_shared<kdl_tree>(robot);
  const auto poses_of = [kdl](const coordinates& x) {
    kdl->set(x);
    kdl->update_frames();
    return kdl->frames.data();
  };
  std::vector<double> ours, theirs;
  const auto poses = robot.poses(q);
  const KDL::Frame* frames = poses_of(q);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Matrix4d m = duet::transform_matrix(poses[i]);
    for (int k = 0; k < 12; ++k) {
      ours.push_back(m(k / 4, k % 4));
      theirs.push_back(frames[i](k / 4, k % 4));
    }
  }
  expect_agreement("tree_poses", "kdl", ours, theirs);
  register_benchmark("tree_poses", "kdl", q, poses_of);
}
#endif

void register_jacobian(const std::string& workload, const duet::kinematic_tree& robot,
                       const coordinates& q) {
  const auto hand = robot.link("left_hand");
  const auto by_tree = [robot, hand](const coordinates& x) {
    return duet::jacobian(robot, x, duet::frame::hybrid, hand);
  };
  register_benchmark(workload, "duet", q, by_tree);
  const duet::bounded_chain<16> chain = robot.chain("base", "left_hand");
  const auto by_chain = [chain](const coordinates& x) {
    return duet::jacobian(chain, x, duet::frame::hybrid);
  };
  if (chain.size() == robot.size()) {
    expect_agreement(workload, "chain", numbers(by_tree(q)), numbers(by_chain(q)));
    register_benchmark(workload, "chain", q, by_chain);
  }
#if DUET_BENCH_KDL
  register_kdl_jacobian(workload, robot, q);
#endif
}

[[nodiscard]] coordinates test_configuration(const duet::kinematic_tree& robot) {
  coordinates q(robot.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    q[i] = std::sin(1. + double(i));
  }
  return q;
}

const bool registered = [] {
  const duet::kinematic_tree robot(two_arms()), alone(one_arm());
  const coordinates q = test_configuration(robot);
  register_benchmark("tree_poses", "duet", q,
                     [robot](const coordinates& x) { return robot.poses(x); });
#if DUET_BENCH_KDL
  register_kdl_poses(robot, q);
#endif
  register_jacobian("tree_jacobian", robot, q);
  register_jacobian("tree_of_arm_jacobian", alone, test_configuration(alone));
  return true;
}();

} // namespace
} // namespace duet_bench
