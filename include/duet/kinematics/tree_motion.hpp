// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/kinematics/chain_walk.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/tree_table.hpp>
#include <duet/kinematics/tree_walk.hpp>

#include <cstddef>
#include <vector>

/// \file
/// Nodes of a tree with their screws, for functions that need all of them at once. For those who
/// extend duet.

namespace duet::detail {

/// The screw of a joint coordinate: the twist of all that the joint carries, per unit of
/// the coordinate.
template <class S>
struct tree_screw {
  int at;         ///< index of its node in the list of nodes
  int coordinate; ///< number of the joint coordinate
  twist_column<S> twist;
};

/// Nodes of a tree, parents first, with their frames relative to the frame above the first node,
/// and the screws of their coordinates, with v at the origin of that frame.
template <class S>
struct tree_motion {
  std::vector<int> nodes;
  std::vector<int> before; ///< index of each node's parent in `nodes`; −1: the frame above
  std::vector<link_displacement<S>> frames; ///< frame of each node after its motion
  std::vector<tree_screw<S>> screws;

  /// Frame of the node at an index; for −1 the frame above.
  [[nodiscard]] link_displacement<S> frame(int i) const {
    return i < 0 ? identity_displacement<S>() : frames[std::size_t(i)];
  }

  template <class X>
  void follow(const tree_table& table, const X& x) {
    frames.reserve(nodes.size());
    screws.reserve(nodes.size());
    const auto put_screw = [&](int coordinate, const twist_column<S>& twist) {
      screws.push_back({int(frames.size()), coordinate, twist});
    };
    for_each_node<S>(
        table, x, int(nodes.size()), [&](int i) { return nodes[std::size_t(i)]; }, put_screw,
        [&](const tree_node&, const auto& move) {
          frames.push_back(move(frame(before[frames.size()])));
        });
  }
};

/// Motion of the nodes below a node `top` down to one node.
template <class S, class X>
[[nodiscard]] tree_motion<S> motion_to(const tree_table& table, const X& x, int node, int top) {
  const node_path path(table, node, top);
  tree_motion<S> result;
  for (const int k : path) {
    result.before.push_back(int(result.nodes.size()) - 1);
    result.nodes.push_back(k);
  }
  result.follow(table, x);
  return result;
}

/// Motion of all nodes of the tree.
template <class S, class X>
[[nodiscard]] tree_motion<S> motion_of_all(const tree_table& table, const X& x) {
  tree_motion<S> result;
  for (std::size_t k = 0; k < table.nodes.size(); ++k) {
    result.nodes.push_back(int(k));
    result.before.push_back(table.nodes[k].parent);
  }
  result.follow(table, x);
  return result;
}

} // namespace duet::detail
