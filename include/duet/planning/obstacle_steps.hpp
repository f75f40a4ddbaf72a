// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/planning/clearance.hpp>
#include <duet/planning/constrained_step.hpp>

#include <algorithm>
#include <limits>
#include <optional>
#include <sstream>
#include <vector>

/// \file
/// How planners keep away from obstacles.

namespace duet {

/// No obstacles.
struct no_scene {};

namespace detail {

/// How much a chain lacks to the margin of a scene; 0 where it keeps it.
template <class C, class V>
[[nodiscard]] double margin_shortfall(const C& chain, const V& theta, const scene& around) {
  return std::max(0.0, around.margin - clearance(chain, theta, around).distance);
}
template <class C, class V>
[[nodiscard]] double margin_shortfall(const C&, const V&, const no_scene&) {
  return 0;
}

/// What keeps a step from θ at the margin of a scene: ∇d·Δ ≥ margin − d for each distance d within
/// the horizon.
template <class C, class V>
[[nodiscard]] std::vector<inequality<V>> margin_inequalities(const C& chain, const V& theta,
                                                             const scene& around) {
  std::vector<inequality<V>> result;
  for (const link_body& body : around.bodies) {
    for (const obstacle& each : around.obstacles) {
      const double apart = closest_points(chain, theta, body, each).distance - around.margin;
      if (apart < around.horizon) {
        const auto [distance, slope] = distance_and_gradient(chain, theta, body, each);
        result.push_back({slope, around.margin - distance});
      }
    }
  }
  return result;
}

/// A step in the presence of obstacles.
template <class V>
struct step_beside_obstacles {
  constrained_step_result<V> result = {std::nullopt, std::numeric_limits<double>::infinity()};
  bool is_free = true; ///< is there nothing near, or nothing that obstacles could help with?
};

/// As `constrained_step`, among the obstacles of a scene.
template <class C, class J, class V>
[[nodiscard]] step_beside_obstacles<V>
step_beside(const C& chain, const V& theta, const J& jacobian, const vector6<double>& e,
            const V& wish, const V& lower, const V& upper, const scene& around) {
  const auto inequalities = margin_inequalities(chain, theta, around);
  if (inequalities.empty()) {
    return {};
  }
  const V down = lower - theta, up = upper - theta;
  const auto result = constrained_step(jacobian, e, wish, down, up, inequalities);
  // What cannot be done without obstacles either is not for them to answer for.
  const bool is_free = !result.step && !constrained_step(jacobian, e, wish, down, up, {}).step;
  return {result, is_free};
}

/// \throws invalid_input for a scene that is none, and where the chain is too close to an obstacle
template <class C, class V>
void require_clearance(const C& chain, const V& theta, const scene& around, double tolerance) {
  require_scene(chain, around);
  const auto nearest = clearance(chain, theta, around);
  if (!(nearest.distance >= around.margin - tolerance)) {
    std::ostringstream message;
    message << "duet: plan: at the start body " << nearest.body << " is " << nearest.distance
            << " from obstacle " << nearest.obstacle << ", closer than the margin of "
            << around.margin;
    throw invalid_input(message.str());
  }
}
template <class C, class V>
void require_clearance(const C&, const V&, const no_scene&, double) {}

} // namespace detail
} // namespace duet
