// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// A robot of two arms on a torso, a head and two grippers as a tree of duet and of Orocos KDL; and
/// one of its arms as a serial chain of the same joints.

#include "support/contest.hpp"
#include "workloads.hpp"

#include <duet/mechanism/centre_of_mass.hpp>
#include <duet/mechanism/jacobian.hpp>
#include <duet/mechanism/kinematic_tree.hpp>
#include <duet/mechanism/tree_jacobian.hpp>

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

/// Names of links are those of the joints above them.
[[nodiscard]] duet::robot_description two_arms() {
  const quaternion<double> still(1);
  duet::robot_description robot{.links = {{"base"}}};
  const auto add = [&](const std::string& name, const std::string& parent, joint_kind kind,
                       const placement<double>& origin, const std::array<double, 3>& axis) {
    robot.links.push_back({name, duet::link_inertia{.mass = 1, .frame = {still, {0, .01, .05}}}});
    robot.joints.push_back({name, parent, name, {kind, origin, axis}});
  };
  add("waist", "base", joint_kind::revolute, {still, {0, 0, .6}}, {0, 0, 1});
  add("pan", "waist", joint_kind::revolute, {still, {0, 0, .6}}, {0, 0, 1});
  add("tilt", "pan", joint_kind::revolute, {still, {.05, 0, .1}}, {0, 1, 0});
  for (const auto& [side, sign] : {std::pair("left", 1.), std::pair("right", -1.)}) {
    std::string parent = "waist";
    placement<double> origin{quaternion<double>(std::cos(.4), -sign * std::sin(.4), 0, 0),
                             {0, sign * .2, .4}};
    for (std::size_t i = 0; i < arm.size(); ++i) {
      const arm_row& row = arm[i];
      const std::string name = side + std::to_string(i);
      // turn about x, then along it, then the joint's axis, then along that
      origin = origin *
               placement<double>{quaternion<double>(row.half_cos, row.half_sin, 0, 0), {}} *
               placement<double>{still, {row.a, 0, row.d}};
      add(name, parent, joint_kind::revolute, origin, {0, 0, 1});
      origin = {};
      parent = name;
    }
    add(side + std::string("_hand"), parent, joint_kind::fixed, {still, {0, 0, .1}}, {0, 0, 1});
    for (const double way : {1., -1.}) {
      const std::string name = side + std::string(way > 0 ? "_finger" : "_thumb");
      add(name, side + std::string("_hand"), joint_kind::prismatic, {still, {0, 0, .05}},
          {0, way, 0});
    }
  }
  return robot;
}

using coordinates = Eigen::VectorXd;

/// One by one: those of KDL are not aligned for this machine.
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
    for (const auto& link : links) { // parents stand before their children
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

  /// In one pass, without the search by names of its solver.
  void follow() {
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

void register_kdl(const std::shared_ptr<const duet::kinematic_tree>& robot, const coordinates& q) {
  const auto kdl = std::make_shared<kdl_tree>(*robot);
  const auto jacobian_of = [kdl](const coordinates& x) {
    kdl->set(x);
    (void)kdl->solver->JntToJac(kdl->q, kdl->columns, "left_hand");
    return &kdl->columns;
  };
  const auto poses_of = [kdl](const coordinates& x) {
    kdl->set(x);
    kdl->follow();
    return kdl->frames.data();
  };
  expect_agreement("tree_jacobian", "kdl",
                   numbers(jacobian(*robot, q, duet::frame::hybrid, robot->link("left_hand"))),
                   numbers(jacobian_of(q)->data));
  std::vector<double> ours, theirs;
  const auto poses = robot->poses(q);
  const KDL::Frame* frames = poses_of(q);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Matrix4d m = duet::transform_matrix(poses[i]);
    for (int k = 0; k < 12; ++k) {
      ours.push_back(m(k / 4, k % 4));
      theirs.push_back(frames[i](k / 4, k % 4));
    }
  }
  expect_agreement("tree_poses", "kdl", ours, theirs);
  contest("tree_poses", "kdl", q, poses_of);
  contest("tree_jacobian", "kdl", q, jacobian_of);
}
#endif

const bool registered = [] {
  const auto robot = std::make_shared<const duet::kinematic_tree>(two_arms());
  coordinates q(robot->size());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    q[i] = std::sin(1. + double(i));
  }
  const auto hand = robot->link("left_hand");
  contest("tree_poses", "duet", q, [robot](const coordinates& x) { return robot->poses(x); });
  const auto by_tree = [robot, hand](const coordinates& x) {
    return duet::jacobian(*robot, x, duet::frame::hybrid, hand);
  };
  contest("tree_jacobian", "duet", q, by_tree);

  // The same joints as a chain: all that it has beside the waist's are the arm's.
  const duet::serial_chain<-16> chain = robot->chain("base", "left_hand");
  coordinates theta(chain.size());
  theta << q[0], q.segment(3, 7);
  const auto by_chain = [chain](const coordinates& x) {
    return duet::jacobian(chain, x, duet::frame::hybrid);
  };
  Eigen::MatrixXd columns(6, chain.size());
  const auto all = by_tree(q);
  columns << all.col(0), all.middleCols(3, 7);
  expect_agreement("tree_jacobian_over_chain", "chain", numbers(columns), numbers(by_chain(theta)));
  contest("tree_jacobian_over_chain", "duet", q, by_tree);
  contest("tree_jacobian_over_chain", "chain", theta, by_chain);
  contest("tree_centre_of_mass_jacobian", "duet", q,
          [robot](const coordinates& x) { return duet::centre_of_mass_jacobian(*robot, x); });
#if DUET_BENCH_KDL
  register_kdl(robot, q);
#endif
  return true;
}();

} // namespace
} // namespace duet_bench
