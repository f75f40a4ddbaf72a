// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "options.hpp"
#include "tables.hpp"

#include "../support/drawing.hpp"

#include <duet/duet.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// \file
/// Drawing of the arm and its obstacles.

namespace motion_plan_example {

/// The first waypoint whose clearance is within 1 % of the smallest.
struct closest_approach {
  std::size_t waypoint;
  duet::chain_clearance<double> clearance;
};

/// Nothing without obstacles and collision pairs.
inline std::optional<closest_approach> closest(const problem& p, const plan_type& plan) {
  std::optional<closest_approach> result;
  for (std::size_t k = 0; k < plan.joints.size() && p.has_margins(); ++k) {
    const auto clearance_at_waypoint = duet::clearance(p.arm, plan.joints[k], p.scene);
    const double smallest = result ? result->clearance.distance : 0;
    if (!result || clearance_at_waypoint.distance < smallest - .01 * std::abs(smallest)) {
      result = {k, clearance_at_waypoint};
    }
  }
  return result;
}

/// The arm as the planner models it, capsules along its links, on a stand that the planner ignores.
inline void add_arm(example::drawing& d, const problem& p, const Eigen::VectorXd& theta,
                    const std::string& colour, double shift = 0) {
  d.capsule(point::Zero(), duet::translation(p.arm.pose(theta, 1)), .03, "#9aa5b1", shift);
  for (const duet::collision_body& each : p.scene.bodies) {
    const auto body = duet::transformed(p.arm.pose(theta, each.link), each.shape);
    d.capsule(body.from, body.to, body.radius, colour, shift);
  }
}

/// Draws a sphere with its margin, a capsule, a box as its faces, or a half-space as a grid around
/// the base.
inline void add_obstacle(example::drawing& d, const duet::obstacle& each, double margin) {
  std::visit(
      [&](const auto& o) {
        if constexpr (requires { o.centre; }) {
          d.ball(o.centre, o.radius, "#e69f00");
          d.circle(o.centre, o.radius + margin, "#24292f", "lw 1.5 dt 2");
        } else if constexpr (requires { o.radius; }) {
          d.capsule(o.from, o.to, o.radius, "#e69f00");
        } else if constexpr (requires { o.pose; }) {
          for (int axis = 0; axis < 3; ++axis) {
            for (const int side : {-1, 1}) {
              std::vector<point> corners;
              for (const auto& [a, b] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}, {-1, -1}}) {
                point x = o.half_extents;
                x[axis] *= side;
                x[(axis + 1) % 3] *= a;
                x[(axis + 2) % 3] *= b;
                corners.push_back(duet::transform_point(o.pose, x));
              }
              d.face(corners, axis == 2 ? "#f5c95c" : axis == 1 ? "#e69f00" : "#c98a00");
            }
          }
        } else {
          // The point of the surface below the base, and two directions along it.
          const point n = o.normal, middle = o.offset * n;
          const point along = n.unitOrthogonal(), across = n.cross(along);
          for (int i = -3; i <= 3; ++i) {
            const double x = .1 * i;
            d.line({middle + x * along - .3 * across, middle + x * along + .3 * across}, "#c4ccd4",
                   "lw 1");
            d.line({middle - .3 * along + x * across, middle + .3 * along + x * across}, "#c4ccd4",
                   "lw 1");
          }
        }
      },
      each);
}

/// Direction of view in which the closest approach has its true length and is not hidden by the
/// arm.
inline point viewpoint(const problem& p, const plan_type& plan,
                       const std::optional<closest_approach>& nearest) {
  const point n = nearest ? nearest->clearance.points.normal : point(0, 0, 1);
  if (std::hypot(n[0], n[1]) < .1) {
    return {.8, -1, .4};
  }
  const point level = n.cross(point::UnitZ()).normalized();
  const point tip = duet::translation(p.arm.pose(plan.joints[nearest->waypoint]));
  const bool hides = (tip - nearest->clearance.points.on_body).dot(level) > 0;
  return (hides ? -1 : 1) * level + .6 * (point::UnitZ() - n[2] * n).normalized();
}

/// The arm at its closest approach; behind it, pale, at the start and at the end.
inline example::drawing drawing_of(const problem& p, const plan_type& plan,
                                   const std::vector<point>& tip,
                                   const std::optional<closest_approach>& nearest) {
  example::drawing d(viewpoint(p, plan, nearest));
  constexpr double behind = -10;
  for (const duet::obstacle& each : p.scene.obstacles) {
    add_obstacle(d, each, p.scene.margin);
  }
  add_arm(d, p, plan.joints.front(), "#dfe5ea", behind);
  add_arm(d, p, plan.joints.back(), "#b4c3d0", behind);
  if (nearest) {
    add_arm(d, p, plan.joints[nearest->waypoint], "#0072b2");
  }
  d.line(tip, "#d55e00", "lw 4");
  return d;
}

} // namespace motion_plan_example
