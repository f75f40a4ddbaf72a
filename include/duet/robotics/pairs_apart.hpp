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

namespace detail {

/// Neighbourhood of links: true if two links are one, fixed to each other, or connected by a single
/// joint.
template <LinkedMechanism M>
class link_neighbours {
public:
  explicit link_neighbours(const M& mechanism) {
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
        body_.push_back(fixed_to(i));
        below_.push_back(fixed_to(parent[body_.back()]));
      }
    }
  }

  [[nodiscard]] bool operator()(int a, int b) const {
    if constexpr (SerialChain<M>) {
      return std::abs(a - b) <= 1;
    } else {
      const auto i = std::size_t(a), k = std::size_t(b);
      return body_[i] == body_[k] || below_[i] == body_[k] || below_[k] == body_[i];
    }
  }

private:
  std::vector<std::size_t> body_;  ///< link to which each is fixed
  std::vector<std::size_t> below_; ///< link on which that one moves
};

} // namespace detail

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
  const detail::link_neighbours<M> are_neighbours(mechanism);
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
