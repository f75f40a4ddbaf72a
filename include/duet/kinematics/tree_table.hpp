// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/displacement.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/joint_checks.hpp>
#include <duet/kinematics/joint_step.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <cmath>
#include <string>
#include <unordered_map>
#include <vector>

/// \file
/// The table for the evaluation of a kinematic tree. For those who extend duet.

namespace duet::detail {

/// An elementary joint: one that rotates about an axis, translates along it or both, with one
/// coordinate; or spherical, with a rotation vector. A planar joint is two prismatic nodes and a
/// revolute one, a floating joint three prismatic nodes and a spherical one.
struct tree_node {
  int parent = -1;    ///< number of the parent node; −1: the root of the tree
  int coordinate = 0; ///< number of its first coordinate among those of all joints
  bool is_ball = false;
  joint_step<double> step{}; ///< for a spherical joint only its pose before the motion

  [[nodiscard]] int coordinates() const { return is_ball ? 3 : 1; }
};

/// True if the displacement is the identity.
[[nodiscard]] inline bool is_identity(const placement<double>& a) {
  const auto& [x, y, z] = a.translation;
  return a.rotation == quaternion<double>(1) && x == 0 && y == 0 && z == 0;
}

/// A frame fixed to a node.
struct frame_on_node {
  int node = -1; ///< number of the node; −1: the root of the tree
  placement<double> offset{};
};

/// A joint coordinate as multiplier × a coordinate of the tree + offset.
struct coordinate_source {
  int own = -1;
  double multiplier = 1;
  double offset = 0;
};

/// Mass and first moment of all that is fixed to a node, in its frame.
struct mass_on_node {
  double mass = 0;
  three_vector<double> moment{}; ///< Σ mass × centre
};

struct tree_table {
  std::vector<tree_node> nodes;             ///< nodes, parents first
  std::vector<mass_on_node> masses;         ///< masses of the root, then of each node
  std::vector<frame_on_node> links;         ///< node and offset of each link
  std::vector<coordinate_source> sources;   ///< sources of the coordinates of all joints
  std::vector<std::string> names;           ///< names of the coordinates of the tree
  std::vector<joint_limits<double>> limits; ///< limits of the coordinates of the tree
  std::unordered_map<std::string, int> link_numbers;
};

/// The shortest rotation that takes z to the unit vector n: (1 + n·z, z × n), normalised; for −z
/// the half turn about x.
[[nodiscard]] inline quaternion<double> rotation_from_z(const three_vector<double>& n) {
  const double w = n.z > 0 ? 1 + n.z : (n.x * n.x + n.y * n.y) / (1 - n.z); // both are 1 + n·z
  const double length = std::sqrt(2 * w);
  return w > 0 ? quaternion<double>(w / length, -n.y / length, n.x / length, 0)
               : quaternion<double>(0, 1, 0, 0);
}

/// Image of e under the shortest rotation that takes z to n.
[[nodiscard]] inline three_vector<double> in_plane(const three_vector<double>& n,
                                                   const three_vector<double>& e) {
  return cleaned_direction(rotated(rotation_from_z(n), e));
}

/// Appends the nodes of a joint whose frame is at an offset of a node.
inline void add_nodes_of_joint(std::vector<tree_node>& nodes, const joint<double>& motion,
                               int coordinate, const frame_on_node& frame) {
  tree_node node{frame.node, coordinate};
  placement<double> origin = frame.offset;
  const auto add = [&](joint<double> part) {
    node.is_ball = part.kind == joint_kind::spherical;
    node.step = step_of(part, origin);
    nodes.push_back(node);
    origin = {};
    node.parent = int(nodes.size()) - 1;
    ++node.coordinate;
  };
  const auto add_prismatic = [&](const three_vector<double>& along) {
    add({.kind = joint_kind::prismatic, .axis = {along.x, along.y, along.z}});
  };
  if (motion.kind == joint_kind::planar) {
    const auto axis = components(motion.axis);
    const auto n = cleaned_direction(inverse_root_near_one(dot(axis, axis)) * axis);
    add_prismatic(in_plane(n, {1, 0, 0}));
    add_prismatic(in_plane(n, {0, 1, 0}));
    add({.kind = joint_kind::continuous, .axis = motion.axis});
  } else if (motion.kind == joint_kind::floating) {
    add_prismatic({1, 0, 0});
    add_prismatic({0, 1, 0});
    add_prismatic({0, 0, 1});
    add({.kind = joint_kind::spherical});
  } else {
    add(motion);
  }
}

} // namespace duet::detail
