// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/mechanism/serial_chain.hpp>
#include <duet/planning/closest_points.hpp>
#include <duet/planning/motion_plan.hpp> // `stop_reason::obstacle` before `obstacle`: g++ -Wshadow
#include <duet/planning/shapes.hpp>

#include <cstddef>
#include <limits>
#include <string>
#include <variant>
#include <vector>

/// \file
/// How far a chain is from obstacles.

namespace duet {

/// A capsule, or a sphere, fixed to a link of a chain, in the frame of the link.
struct link_body {
  int link;              ///< number of the link
  capsule<double> shape; ///< in the frame of the link
};

/// What a body can run into.
using obstacle = std::variant<sphere<double>, box<double>, half_space<double>>;

/// What a chain consists of, and what it must not touch, in the frame of its base.
struct scene {
  std::vector<link_body> bodies = {};   ///< what the chain consists of
  std::vector<obstacle> obstacles = {}; ///< in the frame of the chain's base
  /// How far planners keep them apart, in units of length.
  double margin = 0;
  /// From how far beyond the margin on planners look at an obstacle before each step.
  double horizon = .1;
};

/// Looks whether a scene is one for a chain. For those who extend duet.
/// \throws invalid_input for shapes that are none (`require_shape`), links that `chain` lacks, and
/// a margin or horizon that is negative or not finite
template <SerialChain C>
void require_scene(const C& chain, const scene& s) {
  for (std::size_t i = 0; i < s.bodies.size(); ++i) {
    static_cast<void>(chain.link(s.bodies[i].link));
    require_shape(s.bodies[i].shape, "body " + std::to_string(i));
  }
  for (std::size_t i = 0; i < s.obstacles.size(); ++i) {
    std::visit([&](const auto& o) { require_shape(o, "obstacle " + std::to_string(i)); },
               s.obstacles[i]);
  }
  detail::require_extent("the margin of a scene", s.margin);
  detail::require_extent("the horizon of a scene", s.horizon);
}

/// Where a body of a chain is nearest to an obstacle, over the scalar of the coordinates θ.
/// \return `proximity<S>`
/// \throws invalid_input as `chain.pose`
template <SerialChain C, VectorLike X>
[[nodiscard]] auto closest_points(const C& chain, const X& theta, const link_body& body,
                                  const obstacle& from) {
  const auto here = transformed(chain.pose(theta, body.link), body.shape);
  return std::visit([&](const auto& o) { return closest_points(here, o); }, from);
}

/// The distance of a body of a chain from an obstacle, and its gradient by θ. By dual numbers
/// through the pose of the link and the closest points: nᵀ J of the closest point, n the normal.
/// \return `value_and_gradient`
/// \throws invalid_input as `chain.pose`
template <SerialChain C, VectorLike X>
[[nodiscard]] auto distance_and_gradient(const C& chain, const X& theta, const link_body& body,
                                         const obstacle& from) {
  return gradient([&](const auto& x) { return closest_points(chain, x, body, from).distance; },
                  theta);
}

/// The least distance of a chain's bodies from obstacles: which, and where.
template <class S>
struct chain_clearance {
  /// In units of length; negative where they overlap, infinite where there is nothing to touch.
  S distance = S(std::numeric_limits<double>::infinity());
  std::size_t body = 0;     ///< which of `scene::bodies`
  std::size_t obstacle = 0; ///< which of `scene::obstacles`
  proximity<S> points = {}; ///< of these two

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("distance", distance);
    f("body", body);
    f("obstacle", obstacle);
    f("points", points);
  }
};

namespace detail {

/// Calls visit(i, k, points) with where body i of a chain is nearest to obstacle k, for all of
/// them.
template <class C, class X, class Visit>
void for_each_proximity(const C& chain, const X& theta, const scene& s, const Visit& visit) {
  for (std::size_t i = 0; i < s.bodies.size(); ++i) {
    const auto body = transformed(chain.pose(theta, s.bodies[i].link), s.bodies[i].shape);
    for (std::size_t k = 0; k < s.obstacles.size(); ++k) {
      visit(i, k,
            std::visit([&](const auto& o) { return closest_points(body, o); }, s.obstacles[k]));
    }
  }
}

} // namespace detail

/// How far the chain is from all obstacles at coordinates θ of any scalar, in units of length;
/// negative where it overlaps one of them, infinite where there are none.
/// \return `chain_clearance<S>`
/// \throws invalid_input as `chain.pose`
template <SerialChain C, VectorLike X>
[[nodiscard]] auto clearance(const C& chain, const X& theta, const scene& s) {
  using S = detail::chain_scalar<C, X>;
  chain_clearance<S> result;
  detail::for_each_proximity(chain, theta, s,
                             [&](std::size_t i, std::size_t k, const auto& points) {
                               if (innermost(points.distance) < innermost(result.distance)) {
                                 result = {points.distance, i, k, points};
                               }
                             });
  return result;
}

} // namespace duet
