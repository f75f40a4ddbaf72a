// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/closest_points.hpp>
#include <duet/kinematics/motion_plan.hpp> // `stop_reason::obstacle` before `obstacle`: g++ -Wshadow
#include <duet/kinematics/shapes.hpp>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <limits>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

/// \file
/// Clearance: distance of a chain or a tree from obstacles and from itself (self-collision).

namespace duet {

/// Collision body: a capsule, or a sphere, fixed to a link of a chain or a tree.
struct collision_body {
  int link;              ///< index of the link
  capsule<double> shape; ///< shape in the frame of the link
  std::string name =
      {}; ///< name in messages and for `self_collision_pairs`, that of the link in a description
};

/// Collision pair: two bodies that must not touch.
struct collision_pair {
  std::size_t first = 0;  ///< index into `scene::bodies`
  std::size_t second = 0; ///< index of the other one
};

/// Obstacle that a body can collide with: a sphere, box, half-space or capsule.
using obstacle = std::variant<sphere<double>, box<double>, half_space<double>, capsule<double>>;

/// Collision bodies of a chain or a tree, and the obstacles and pairs that must not touch.
struct scene {
  std::vector<collision_body> bodies = {}; ///< collision bodies of the chain
  std::vector<obstacle> obstacles = {};    ///< obstacles in the frame of the chain's base
  /// Distance that planners keep, in units of length.
  double margin = 0;
  /// Influence distance beyond the margin, in units of length: nearer obstacles constrain each step
  /// of a planner.
  double influence_distance_offset = .1;
  /// Pairs of bodies that are kept apart like obstacles (self-collision), see
  /// `self_collision_pairs`.
  std::vector<collision_pair> pairs = {};
};

/// Mechanism whose links have poses, such as `serial_chain` and `kinematic_tree`.
template <class M>
concept LinkedMechanism = requires(const M& mechanism) {
  typename M::scalar_type;
  mechanism.link(0);
  mechanism.pose(std::vector<double>(), 0);
};

/// Checks whether a scene is valid for a chain. For those who extend duet.
///
/// \throws invalid_input for invalid shapes (`require_shape`), links that `chain` lacks, pairs that
/// are not two bodies of the scene, and a margin or influence distance that is negative or not
/// finite
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
    detail::require(first != second && std::max(first, second) < s.bodies.size(),
                    "duet: scene: pair ", i, " consists of bodies ", first, " and ", second,
                    " (expected two different indices below ", s.bodies.size(), ")");
  }
  detail::require_extent(s.margin, "the margin of a scene");
  detail::require_extent(s.influence_distance_offset, "the influence distance of a scene");
}

/// Closest points of a body of a chain and an obstacle, over the scalar of the coordinates θ.
///
/// \return `proximity<S>`
/// \throws invalid_input as `chain.pose`
template <LinkedMechanism C, VectorLike X>
[[nodiscard]] auto closest_points(const C& chain, const X& theta, const collision_body& body,
                                  const obstacle& from) {
  const auto moved = transformed(chain.pose(theta, body.link), body.shape);
  return std::visit([&](const auto& o) { return closest_points(moved, o); }, from);
}

/// Closest points of a body of a chain and another one, which takes the role of the obstacle.
///
/// \return `proximity<S>`
/// \throws invalid_input as `chain.pose`
template <LinkedMechanism C, VectorLike X>
[[nodiscard]] auto closest_points(const C& chain, const X& theta, const collision_body& body,
                                  const collision_body& from) {
  return closest_points(transformed(chain.pose(theta, body.link), body.shape),
                        transformed(chain.pose(theta, from.link), from.shape));
}

/// Distance of a body of a chain from an obstacle or another body, and its gradient with respect to
/// θ, by dual numbers through the poses of the links and the closest points: nᵀ J of the closest
/// point, n the normal, less nᵀ J of the other body's.
///
/// \return `value_and_gradient`
/// \throws invalid_input as `chain.pose`
template <LinkedMechanism C, VectorLike X, class From>
  requires std::constructible_from<obstacle, From> || std::same_as<From, collision_body>
[[nodiscard]] auto distance_and_gradient(const C& chain, const X& theta, const collision_body& body,
                                         const From& from) {
  return gradient([&](const auto& x) { return closest_points(chain, x, body, from).distance; },
                  theta);
}

/// Smallest distance of a chain's bodies from obstacles and from each other, with the closest pair.
template <class S>
struct chain_clearance {
  /// Distance in units of length; negative if they overlap, infinite if there is nothing to touch.
  S distance = S(std::numeric_limits<double>::infinity());
  std::size_t body = 0;     ///< index into `scene::bodies`
  std::size_t other = 0;    ///< index into `scene::obstacles`, or into `scene::bodies` if `is_self`
  bool is_self = false;     ///< true if it is a distance between two bodies
  proximity<S> points = {}; ///< closest points of the two

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

/// Bodies of a scene in the frame of the base.
///
/// \param pose_of  pose of a link by its number
template <class PoseOf>
[[nodiscard]] auto moved_bodies(const scene& s, const PoseOf& pose_of) {
  using S = std::decay_t<decltype(translation(pose_of(0))[0])>;
  std::vector<capsule<S>> result;
  result.reserve(s.bodies.size());
  for (const collision_body& each : s.bodies) {
    result.push_back(transformed(pose_of(each.link), each.shape));
  }
  return result;
}

/// Calls `visit` with a `chain_clearance` for each body and each obstacle, and for each pair of
/// bodies.
///
/// \param moved_capsules  as returned by `moved_bodies`
template <class S, class Visit>
void for_each_proximity(const std::vector<capsule<S>>& moved_capsules, const scene& s,
                        const Visit& visit) {
  const auto visit_pair = [&](std::size_t i, std::size_t k, bool is_self, const auto& other) {
    const proximity<S> points = closest_points(moved_capsules[i], other);
    visit(chain_clearance<S>{points.distance, i, k, is_self, points});
  };
  for (std::size_t i = 0; i < s.bodies.size(); ++i) {
    for (std::size_t k = 0; k < s.obstacles.size(); ++k) {
      std::visit([&](const auto& o) { visit_pair(i, k, false, o); }, s.obstacles[k]);
    }
  }
  for (const auto [first, second] : s.pairs) {
    visit_pair(first, second, true, moved_capsules[second]);
  }
}

/// Smallest clearance of the bodies of a validated scene.
template <class S>
[[nodiscard]] chain_clearance<S> min_clearance(const std::vector<capsule<S>>& moved_capsules,
                                               const scene& s) {
  chain_clearance<S> result;
  for_each_proximity(moved_capsules, s, [&](const chain_clearance<S>& each) {
    const auto smallest = innermost(result.distance);
    if (smallest == smallest &&
        !(innermost(each.distance) >= smallest)) { // a distance that is nan is kept
      result = each;
    }
  });
  return result;
}

} // namespace detail

/// Clearance of a chain at coordinates θ of any scalar: the smallest distance of its bodies from
/// all obstacles and of the bodies of all pairs from each other, in units of length; negative if
/// they overlap, infinite if there are none, nan if any distance is nan.
///
/// \return `chain_clearance<S>`
/// \throws invalid_input as `require_scene` and `chain.pose`
template <LinkedMechanism C, VectorLike X>
[[nodiscard]] auto clearance(const C& chain, const X& theta, const scene& s) {
  require_scene(chain, s);
  const auto pose_of = [&](int link) { return chain.pose(theta, link); };
  return detail::min_clearance(detail::moved_bodies(s, pose_of), s);
}

} // namespace duet
