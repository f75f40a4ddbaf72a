// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/mechanism/chain_walk.hpp>
#include <duet/mechanism/urdf_contents.hpp>
#include <duet/planning/clearance.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <vector>

/// \file
/// Which bodies of a mechanism can run into each other.

namespace duet {

namespace detail {

/// Are two links one, or does a single joint connect them?
template <LinkedMechanism M>
[[nodiscard]] bool are_neighbours(const M& mechanism, int a, int b) {
  if constexpr (SerialChain<M>) {
    return std::abs(a - b) <= 1;
  } else {
    const auto& table = mechanism.table(); // in which links that are fixed to each other are one
    const auto parent = [&](int node) {
      return node < 0 ? node : table.nodes[std::size_t(node)].parent;
    };
    const int x = table.links[std::size_t(a)].node, y = table.links[std::size_t(b)].node;
    return x == y || parent(x) == y || parent(y) == x;
  }
}

} // namespace detail

/// All pairs of bodies but those whose links are one, fixed to each other or connected by a single
/// joint, and but those whose links have the names of an excluded pair: for `scene::pairs`.
///
/// \param mechanism  a chain or a tree
/// \param excluded   names of links, in either order, as `read_disabled_collisions` has them
/// \throws invalid_input for bodies on links that `mechanism` has not
template <LinkedMechanism M>
[[nodiscard]] std::vector<body_pair> pairs_apart(const M& mechanism,
                                                 const std::vector<link_body>& bodies,
                                                 const std::vector<link_pair>& excluded = {}) {
  for (const link_body& each : bodies) {
    static_cast<void>(mechanism.link(each.link));
  }
  const auto is_excluded = [&](const link_body& a, const link_body& b) {
    return detail::are_neighbours(mechanism, a.link, b.link) ||
           std::any_of(excluded.begin(), excluded.end(), [&](const link_pair& names) {
             return (names.first == a.name && names.second == b.name) ||
                    (names.first == b.name && names.second == a.name);
           });
  };
  std::vector<body_pair> result;
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
