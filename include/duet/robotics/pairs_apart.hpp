// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/kinematics/chain_walk.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/robot_description.hpp>
#include <duet/robotics/clearance.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

/// \file
/// Pairs of collision bodies of a mechanism to be checked for self-collision.

namespace duet {

/// Pairs of bodies to be checked for self-collision, for `scene::pairs`: all except those whose
/// links are one, fixed to each other or connected by a single joint, and those whose links have
/// the names of an excluded pair.
///
/// \param mechanism  a chain or a tree
/// \param excluded   names of links, in either order, as returned by `read_disabled_collisions`
/// \throws invalid_input for bodies on links that `mechanism` lacks
template <LinkedMechanism M>
[[nodiscard]] std::vector<collision_pair>
self_collision_pairs(const M& mechanism, const std::vector<collision_body>& bodies,
                     const std::vector<link_pair>& excluded = {}) {
  for (const collision_body& each : bodies) {
    static_cast<void>(mechanism.link(each.link));
  }
  std::vector<std::size_t> body;  // link to which each is fixed
  std::vector<std::size_t> below; // link on which that one moves
  if constexpr (!SerialChain<M>) {
    const auto number = [&](const std::string& name) {
      return std::size_t(mechanism.link(name).link);
    };
    std::vector<std::size_t> parent(mechanism.links().size());
    std::vector<bool> is_fixed(parent.size(), false);
    std::iota(parent.begin(), parent.end(), 0U);
    for (const auto& each : mechanism.joints()) {
      parent[number(each.child)] = number(each.parent);
      is_fixed[number(each.child)] = each.motion.kind == joint_kind::fixed;
    }
    const auto fixed_to = [&](std::size_t link) {
      while (is_fixed[link]) {
        link = parent[link];
      }
      return link;
    };
    for (std::size_t i = 0; i < parent.size(); ++i) {
      body.push_back(fixed_to(i));
      below.push_back(fixed_to(parent[body.back()]));
    }
  }
  const auto are_neighbours = [&](int a, int b) {
    if constexpr (SerialChain<M>) {
      return std::abs(a - b) <= 1;
    } else {
      const auto i = std::size_t(a), k = std::size_t(b);
      return body[i] == body[k] || below[i] == body[k] || below[k] == body[i];
    }
  };
  const auto is_excluded = [&](const collision_body& a, const collision_body& b) {
    return are_neighbours(a.link, b.link) ||
           std::any_of(excluded.begin(), excluded.end(), [&](const link_pair& names) {
             return (names.first == a.name && names.second == b.name) ||
                    (names.first == b.name && names.second == a.name);
           });
  };
  std::vector<collision_pair> result;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t k = i + 1; k < bodies.size(); ++k) {
      if (!is_excluded(bodies[i], bodies[k])) {
        result.push_back({i, k});
      }
    }
  }
  return result;
}

} // namespace duet
