// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/robotics/clearance.hpp>
#include <duet/robotics/constrained_step.hpp>
#include <duet/robotics/planning_model.hpp>
#include <duet/robotics/small_vector.hpp>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// \file
/// Collision avoidance of planners: distance constraints from obstacles and between links.

namespace duet::detail {

/// Constraints that keep a step from θ at the margin of a scene: ∇d·Δ ≥ margin − d for each
/// distance d within the influence distance, with ∇d = Jᵀ [n; p × n] of the closest point p and the
/// normal n there. A joint below both of two bodies does not change
/// their distance; one between them moves one body only.
template <class C, class V>
[[nodiscard]] std::vector<inequality<V>> margin_inequalities(const C& chain, const V& theta,
                                                             const scene& around) {
  std::vector<inequality<V>> result;
  std::optional<decltype(jacobian(chain, theta, frame::spatial))> j; // if something is near
  for_each_proximity(chain, theta, around, [&](const chain_clearance<double>& nearest) {
    if (nearest.distance - around.margin < around.influence_distance_offset) {
      if (!j) {
        j = jacobian(chain, theta, frame::spatial);
      }
      const int link = around.bodies[nearest.body].link;
      const int other = nearest.is_self ? around.bodies[nearest.other].link : 0;
      const vector3<double>& n = nearest.points.normal;
      const vector3<double>& p = link > other ? nearest.points.on_body : nearest.points.on_obstacle;
      const vector3<double> moment = cross(components(p), components(n));
      V gradient = V::Zero(theta.size());
      for (int i = std::min(link, other); i < std::max(link, other); ++i) {
        const vector6<double> column = j->col(i);
        const double outwards = n.dot(column.head<3>()) + moment.dot(column.tail<3>());
        gradient[i] = link > other ? outwards : -outwards;
      }
      result.push_back({gradient, around.margin - nearest.distance});
    }
  });
  return result;
}

/// `body 3 (wrist)`
[[nodiscard]] inline std::string name_of_body(const scene& around, std::size_t i) {
  const std::string& name = around.bodies[i].name;
  return "body " + std::to_string(i) + (name.empty() ? "" : " (" + name + ")");
}

/// Model of a chain among the obstacles of a scene.
template <class C>
class chain_with_obstacles final : public chain_model<C> {
public:
  using typename chain_model<C>::state;
  using typename chain_model<C>::vector;

  /// \throws invalid_input for an invalid scene
  chain_with_obstacles(const C& chain, const scene& around)
      : chain_model<C>(chain), around_(around) {
    require_scene(chain, around);
    this->margin = around.margin / this->length;
  }

  [[nodiscard]] double clearance(const vector& theta) const override {
    return nearest(theta).distance / this->length;
  }
  /// `margin_inequalities` in the planner's coordinates and lengths.
  [[nodiscard]] std::vector<inequality<joint_vector<double, C::joints>>>
  margins(const vector& theta) const {
    auto result = margin_inequalities(
        this->chain(), to_chain_joints(this->chain(), this->unscaled_joints(theta)), around_);
    for (auto& each : result) {
      each.bound /= this->length;
      for (int i = 0; i < this->size; ++i) {
        each.normal[i] *= this->unit[i] / this->length;
      }
    }
    return result;
  }
  [[nodiscard]] collision_free_step<int(vector::size())>
  find_collision_free_step(const state& from, const small_twist& e,
                           const vector& desired_step) const override {
    using joints = joint_vector<double, C::joints>;
    const auto chain_joints = [&](const vector& x) { return to_chain_joints(this->chain(), x); };
    const auto inequalities = margins(from.theta);
    if (inequalities.empty()) {
      return {};
    }
    const joints down = chain_joints(this->lower - from.theta),
                 up = chain_joints(this->upper - from.theta);
    const auto step = [&](const std::vector<inequality<joints>>& active) {
      return constrained_step(from.jacobian, e, chain_joints(desired_step), down, up, active);
    };
    const auto result = step(inequalities);
    if (result.step) {
      return {scaled_joints<int(vector::size())>(*result.step, this->size),
              result.smallest_singular_value};
    }
    // A step that is infeasible without obstacles too is not blocked by them.
    return {std::nullopt, result.smallest_singular_value, !step({}).step};
  }
  void require_clearance(const vector& theta, double tolerance) const override {
    const auto closest = nearest(theta);
    if (!(closest.distance >= around_.margin - tolerance)) {
      raise(invalid_input(
          printable(message("duet: follow_path: at the start ", name_of_body(around_, closest.body),
                            " is ", closest.distance, " from ",
                            closest.is_self ? name_of_body(around_, closest.other)
                                            : "obstacle " + std::to_string(closest.other),
                            ", closer than the margin of ", around_.margin))));
    }
  }

private:
  [[nodiscard]] chain_clearance<double> nearest(const vector& theta) const {
    return min_clearance(this->chain(),
                         to_chain_joints(this->chain(), this->unscaled_joints(theta)), around_);
  }

  const scene& around_;
};

} // namespace duet::detail
