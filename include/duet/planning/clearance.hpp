// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/planning/closest_points.hpp>
#include <duet/planning/motion_plan.hpp> // `stop_reason::obstacle` before `obstacle`: g++ -Wshadow
#include <duet/planning/shapes.hpp>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <limits>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

/// \file
/// How far a chain or a tree is from obstacles and from itself.

namespace duet {

/// A capsule, or a sphere, fixed to a link of a chain or a tree, in the frame of the link.
struct link_body {
  int link;              ///< number of the link
  capsule<double> shape; ///< in the frame of the link
  std::string name = {}; ///< for messages and `pairs_apart`, as a robot's description has the link
};

/// Two bodies that must not touch.
struct body_pair {
  std::size_t first = 0;  ///< which of `scene::bodies`
  std::size_t second = 0; ///< the other one
};

/// What a body can run into.
using obstacle = std::variant<sphere<double>, box<double>, half_space<double>, capsule<double>>;

/// What a chain or a tree consists of, and what must not touch, in the frame of its base.
struct scene {
  std::vector<link_body> bodies = {};   ///< what the chain consists of
  std::vector<obstacle> obstacles = {}; ///< in the frame of the chain's base
  /// How far planners keep them apart, in units of length.
  double margin = 0;
  /// From how far beyond the margin on planners look at an obstacle before each step.
  double horizon = .1;
  /// Bodies that are kept apart as from obstacles; `pairs_apart` lists them.
  std::vector<body_pair> pairs = {};
};

/// What has links with poses, as `serial_chain`, `kinematic_tree`.
template <class M>
concept LinkedMechanism = requires(const M& mechanism) {
  typename M::scalar_type;
  mechanism.link(0);
  mechanism.pose(std::vector<double>(), 0);
};

/// Looks whether a scene is one for a chain. For those who extend duet.
/// \throws invalid_input for shapes that are none (`require_shape`), links that `chain` lacks,
/// pairs of what are no two bodies, and a margin or horizon that is negative or not finite
template <LinkedMechanism C>
void require_scene(const C& chain, const scene& s) {
  for (std::size_t i = 0; i < s.bodies.size(); ++i) {
    static_cast<void>(chain.link(s.bodies[i].link));
    require_shape(s.bodies[i].shape, "body ", i);
  }
  for (std::size_t i = 0; i < s.obstacles.size(); ++i) {
    std::visit([&](const auto& o) { require_shape(o, "obstacle ", i); }, s.obstacles[i]);
  }
  for (std::size_t i = 0; i < s.pairs.size(); ++i) {
    const auto [first, second] = s.pairs[i];
    detail::require(first != second && std::max(first, second) < s.bodies.size(), "duet: pair ", i,
                    " of a scene is of bodies ", first, " and ", second, ", not of two of ",
                    s.bodies.size());
  }
  detail::require_extent(s.margin, "the margin of a scene");
  detail::require_extent(s.horizon, "the horizon of a scene");
}

/// Where a body of a chain is nearest to an obstacle, over the scalar of the coordinates θ.
/// \return `proximity<S>`
/// \throws invalid_input as `chain.pose`
template <LinkedMechanism C, VectorLike X>
[[nodiscard]] auto closest_points(const C& chain, const X& theta, const link_body& body,
                                  const obstacle& from) {
  const auto here = transformed(chain.pose(theta, body.link), body.shape);
  return std::visit([&](const auto& o) { return closest_points(here, o); }, from);
}

/// Where a body of a chain is nearest to another one, which stands as the obstacle.
/// \return `proximity<S>`
/// \throws invalid_input as `chain.pose`
template <LinkedMechanism C, VectorLike X>
[[nodiscard]] auto closest_points(const C& chain, const X& theta, const link_body& body,
                                  const link_body& from) {
  return closest_points(transformed(chain.pose(theta, body.link), body.shape),
                        transformed(chain.pose(theta, from.link), from.shape));
}

/// The distance of a body of a chain from an obstacle or another body, and its gradient by θ. By
/// dual numbers through the poses of the links and the closest points: nᵀ J of the closest point,
/// n the normal, less nᵀ J of the other body's.
/// \return `value_and_gradient`
/// \throws invalid_input as `chain.pose`
template <LinkedMechanism C, VectorLike X, class From>
  requires std::constructible_from<obstacle, From> || std::same_as<From, link_body>
[[nodiscard]] auto distance_and_gradient(const C& chain, const X& theta, const link_body& body,
                                         const From& from) {
  return gradient([&](const auto& x) { return closest_points(chain, x, body, from).distance; },
                  theta);
}

/// The least distance of a chain's bodies from obstacles and from each other: which, and where.
template <class S>
struct chain_clearance {
  /// In units of length; negative where they overlap, infinite where there is nothing to touch.
  S distance = S(std::numeric_limits<double>::infinity());
  std::size_t body = 0;     ///< which of `scene::bodies`
  std::size_t other = 0;    ///< which of `scene::obstacles`, of `scene::bodies` where `is_self`
  bool is_self = false;     ///< is it a distance between two bodies?
  proximity<S> points = {}; ///< of these two

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("distance", distance);
    f("body", body);
    f("other", other);
    f("is_self", is_self);
    f("points", points);
  }
};

namespace detail {

/// Calls visit with where each body of a chain is nearest to each obstacle, and to the other one
/// of each pair, as a `chain_clearance`.
template <class C, class X, class Visit>
void for_each_proximity(const C& chain, const X& theta, const scene& s, const Visit& visit) {
  using S = std::decay_t<decltype(translation(chain.pose(theta, 0))[0])>;
  std::vector<capsule<S>> placed;
  placed.reserve(s.bodies.size());
  for (const link_body& each : s.bodies) {
    placed.push_back(transformed(chain.pose(theta, each.link), each.shape));
  }
  const auto visit_pair = [&](std::size_t i, std::size_t k, bool is_self, const auto& other) {
    const proximity<S> points = closest_points(placed[i], other);
    visit(chain_clearance<S>{points.distance, i, k, is_self, points});
  };
  for (std::size_t i = 0; i < s.bodies.size(); ++i) {
    for (std::size_t k = 0; k < s.obstacles.size(); ++k) {
      std::visit([&](const auto& o) { visit_pair(i, k, false, o); }, s.obstacles[k]);
    }
  }
  for (const auto [first, second] : s.pairs) {
    visit_pair(first, second, true, placed[second]);
  }
}

/// `duet::clearance` of a scene that has been looked at.
template <class C, class X>
[[nodiscard]] auto least_clearance(const C& chain, const X& theta, const scene& s) {
  using S = std::decay_t<decltype(translation(chain.pose(theta, 0))[0])>;
  chain_clearance<S> result;
  for_each_proximity(chain, theta, s, [&](const chain_clearance<S>& each) {
    const auto least = innermost(result.distance);
    if (least == least && !(innermost(each.distance) >= least)) { // one that is nan stays
      result = each;
    }
  });
  return result;
}

} // namespace detail

/// How far the chain is from all obstacles at coordinates θ of any scalar, and the bodies of all
/// pairs from each other, in units of length; negative where they overlap, infinite where there are
/// none, nan where any distance is.
/// \return `chain_clearance<S>`
/// \throws invalid_input as `require_scene` and `chain.pose`
template <LinkedMechanism C, VectorLike X>
[[nodiscard]] auto clearance(const C& chain, const X& theta, const scene& s) {
  require_scene(chain, s);
  return detail::least_clearance(chain, theta, s);
}

} // namespace duet
