// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "constrained_step.hpp"
#include "tip_pose.hpp"

#include <duet/core/errors.hpp>
#include <duet/kinematics/chain_view.hpp>
#include <duet/kinematics/chain_walk.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/robotics/clearance.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

/// \file
/// Model of a chain and its surroundings for planners, in vectors of the planner's capacity.

namespace duet::detail {
DUET_ABI_BEGIN

/// \throws invalid_input unless the value is finite and `is_good`: within the `range` of the
/// message
inline void require_option(const char* caller, const char* name, double value, bool is_good,
                           const char* range) {
  require(is_good && value - value == 0, "duet: ", caller, ": ", name, " is ", value, " (expected ",
          range, ")");
}
inline void require_positive(const char* caller, const char* name, double value) {
  require_option(caller, name, value, value > 0, "a positive number");
}
inline void require_positive(const char* caller, const char* name, const pose_tolerance& value) {
  const bool is_length = !(value.translation > 0);
  if (is_length || !(value.rotation > 0)) {
    const std::string part = std::string(name) + (is_length ? ".translation" : ".rotation");
    require_positive(caller, part.c_str(), is_length ? value.translation : value.rotation);
  }
}

/// Throws an error for an input that is nan, with the joint coordinates at which it is.
///
/// \param what  beginning of the message, as "duet: follow_path: the objective is nan at the
/// start,"
/// \throws invalid_input
[[noreturn]] inline void fail_not_a_number(const std::string& what, const Eigen::VectorXd& joints) {
  std::string text;
  for (const double x : joints) {
    text += (text.empty() ? "" : ", ") + message(x);
  }
  raise(invalid_input(what + " joints (" + text + ")"));
}

/// Largest number of joints of a chain.
inline constexpr int max_capacity = 100;

/// Calls `f` with the capacity of vectors for a number of joints, as an integral constant: searches
/// are fastest in short vectors of fixed size.
///
/// \throws invalid_input for more than `max_capacity` joints
template <class F>
auto with_capacity(int joints, const F& f) {
  require(joints <= max_capacity, "duet: the chain has ", joints, " joints (expected at most ",
          max_capacity, ")");
  return joints <= 8    ? f(std::integral_constant<int, 8>())
         : joints <= 16 ? f(std::integral_constant<int, 16>())
         : joints <= 32 ? f(std::integral_constant<int, 32>())
                        : f(std::integral_constant<int, max_capacity>());
}

/// Column of up to `Capacity` coordinates.
template <int Capacity>
using bounded_vector = joint_vector<double, -Capacity>;

/// Configuration of a chain, with its tip's pose and Jacobian in `frame::hybrid`.
template <int Capacity>
struct chain_state {
  small_vector<Capacity> theta;
  tip_pose tip;
  small_jacobian<Capacity> jacobian;
};

/// Reach of a chain: the origin of the first joint is fixed in the base, that of the last in the
/// tip's frame, and between the two are links and prismatic joints.
struct chain_reach {
  three_vector<double> first; ///< origin of the first joint in the base
  three_vector<double> back;  ///< origin of the last joint in the tip's frame
  double links = 0, tool = 0; ///< total lengths
  double travel = 0;          ///< total displacement of prismatic joints
  double limited_travel = 0;  ///< displacement of those that have limits
  bool has_joints = false;

  /// True if certainly no pose of the tip is within the tolerance of the goal.
  [[nodiscard]] bool is_beyond(const tip_pose& goal, const pose_tolerance& tolerance) const {
    const double distance = length_of(goal.point(back) - first);
    return has_joints && distance > (links + travel) * (1 + 1e-12) + tolerance.translation +
                                        tolerance.rotation * tool;
  }
  /// Characteristic length of the chain, 1 if its table contains no length; proportional to the
  /// unit of length of the input.
  [[nodiscard]] double scale() const {
    const double all = links + tool + limited_travel;
    return all > 0 ? all : 1;
  }
  /// Reach with lengths in units of `length`.
  [[nodiscard]] chain_reach in_units_of(double length) const {
    const double s = 1 / length;
    return {s * first, s * back, s * links, s * tool, s * travel, s * limited_travel, has_joints};
  }
};

/// Step in the presence of obstacles.
template <int Capacity>
struct collision_free_step {
  std::optional<small_vector<Capacity>> step; ///< empty if obstacles leave none
  /// Smallest singular value of the Jacobian, from above.
  double smallest_singular_value = std::numeric_limits<double>::infinity();
  bool is_free = true; ///< true if nothing is near, or the step fails without obstacles too
};

/// Model of a chain, among the obstacles of a scene if there is one. Lengths, also displacements of
/// prismatic joints and those in Jacobians, are relative to the chain's characteristic length, so
/// that planning does not depend on the unit of length. They are converted nowhere else.
template <int Capacity>
class planning_model {
public:
  using vector = small_vector<Capacity>;
  using state = chain_state<Capacity>;

  /// \param around  null without obstacles
  /// \throws invalid_input for an invalid scene
  explicit planning_model(const chain_view& chain, const scene* around = nullptr)
      : size(chain.size()), chain_(chain), around_(around) {
    lower = upper = vector::Zero();
    unit = vector::Ones();
    for (int i = 0; i < size; ++i) {
      const auto k = std::size_t(i);
      const auto& step = chain.steps()[k];
      const three_vector<double> offset = step.offset;
      const joint_limits<double> limits = chain.limits(i);
      lower[i] = limits.lower;
      upper[i] = limits.upper;
      is_rotational[k] = step.is_rotational;
      is_translational[k] = step.is_translational;
      if (i == 0) {
        reach.first = offset;
      } else {
        reach.links += length_of(offset);
      }
      if (step.is_translational) {
        const double displacement =
            std::abs(step.pitch) * std::max(std::abs(lower[i]), std::abs(upper[i]));
        reach.travel += displacement;
        reach.limited_travel += displacement - displacement == 0 ? displacement : 0;
      }
    }
    const auto& offset = chain.tip().offset;
    const three_vector<double> tool = components(offset.translation);
    reach.back = -1 * rotated(conj(offset.rotation), tool);
    reach.tool = length_of(tool);
    reach.has_joints = size > 0;
    length = reach.scale();
    reach = reach.in_units_of(length);
    for (int i = 0; i < size; ++i) {
      unit[i] = is_rotational[std::size_t(i)] ? 1 : length;
    }
    unscaled_lower_ = lower;
    unscaled_upper_ = upper;
    lower = lower.cwiseQuotient(unit);
    upper = upper.cwiseQuotient(unit);
    if (around != nullptr) {
      require_scene(chain, *around);
      margin = around->margin / length;
      table_.emplace(chain);
    }
  }

  /// Conversions from and to the user's units.
  ///
  /// \param theta  a vector of any kind
  template <class X>
  [[nodiscard]] vector joints(const X& theta) const {
    vector result = vector::Zero();
    for (int i = 0; i < size; ++i) {
      result[i] = theta[i] / unit[i];
    }
    return result;
  }
  /// Joints in the user's units as a column of the chain's size.
  [[nodiscard]] bounded_vector<Capacity> chain_joints(const vector& theta) const {
    return theta.cwiseProduct(unit).head(size);
  }
  /// Joints in the user's units, clamped to the limits, which round-off may have violated.
  [[nodiscard]] bounded_vector<Capacity> joints_within_limits(const vector& theta) const {
    return theta.cwiseProduct(unit).cwiseMax(unscaled_lower_).cwiseMin(unscaled_upper_).head(size);
  }
  [[nodiscard]] tip_pose scaled_pose(const dual_quaternion<double>& a) const {
    const tip_pose x = to_tip_pose(a);
    return {x.rotation, 1 / length * x.translation};
  }
  [[nodiscard]] dual_quaternion<double> unscaled_pose(const tip_pose& a) const {
    return detail::to_dual_quaternion({a.rotation, length * a.translation});
  }
  [[nodiscard]] small_jacobian<Capacity> unscaled_jacobian(small_jacobian<Capacity> j) const {
    for (int i = 0; i < size; ++i) {
      j.col(i).template head<3>() *= length / unit[i];
    }
    return j;
  }
  [[nodiscard]] pose_tolerance tolerance(const pose_tolerance& x) const {
    return {x.translation / length, x.rotation};
  }
  [[nodiscard]] pose_error unscaled_error(const pose_error& x) const {
    return {length * x.translation, x.rotation};
  }

  int size;          ///< number of joints
  double length = 1; ///< characteristic length of the chain, in the user's unit
  vector unit;       ///< unit of each coordinate, in the user's
  vector lower, upper;
  std::array<bool, std::size_t(Capacity)> is_rotational{}, is_translational{};
  chain_reach reach;
  double margin = 0; ///< minimum distance from obstacles

  [[nodiscard]] const chain_view& chain() const { return chain_; }

  void set(state& of, const vector& theta) const {
    of.theta = theta;
    of.jacobian.resize(6, size);
    const vector unscaled = theta.cwiseProduct(unit);
    of.tip = chain_.pose_and_jacobian(unscaled.data(), of.jacobian.data());
    of.tip.translation = 1 / length * of.tip.translation;
    for (int i = 0; i < size; ++i) {
      of.jacobian.col(i).template head<3>() *= unit[i] / length; // ω of prismatic joints is 0
    }
  }
  [[nodiscard]] state at(const vector& theta) const {
    state result;
    set(result, theta);
    return result;
  }

  /// Clearance: distance of the bodies of the chain from obstacles; infinite without any.
  [[nodiscard]] double clearance(const vector& theta) const {
    return around_ == nullptr ? std::numeric_limits<double>::infinity()
                              : nearest_obstacle(theta).distance / length;
  }
  [[nodiscard]] chain_clearance<double> nearest_obstacle(const vector& theta) const {
    return min_clearance(bodies_at(chain_joints(theta)), *around_);
  }
  /// Margin violation: the part of the margin that is missing.
  [[nodiscard]] double margin_violation(const vector& theta) const {
    return std::max(0.0, margin - clearance(theta));
  }
  /// Constraints that keep a step from θ at the margin: ∇d·Δ ≥ margin − d for each distance d
  /// within the influence distance, in the planner's coordinates and lengths. The gradient ∇d =
  /// Jᵀ [n; p × n] follows from the closest point p and the normal n there. A joint below both of
  /// two bodies does not change their distance; one between them moves one body only.
  ///
  /// \tparam V  column of the chain's number of joints
  template <class V>
  [[nodiscard]] std::vector<inequality<V>> margin_inequalities(const vector& theta) const {
    std::vector<inequality<V>> result;
    if (around_ == nullptr) {
      return result;
    }
    const bounded_vector<Capacity> joints = chain_joints(theta);
    std::optional<joint_columns<double, 6, -Capacity>> j; // if something is near
    for_each_proximity(bodies_at(joints), *around_, [&](const chain_clearance<double>& nearest) {
      if (nearest.distance - around_->margin < around_->influence_distance_offset) {
        if (!j) {
          j = jacobian(*table_, joints, frame::spatial);
        }
        const int link = around_->bodies[nearest.body].link;
        const int other = nearest.is_self ? around_->bodies[nearest.other].link : 0;
        const vector3<double>& n = nearest.points.normal;
        const vector3<double>& p =
            link > other ? nearest.points.on_body : nearest.points.on_obstacle;
        const vector3<double> moment = p.cross(n);
        V gradient = V::Zero(V::RowsAtCompileTime == Eigen::Dynamic ? size : V::RowsAtCompileTime);
        for (int i = std::min(link, other); i < std::max(link, other); ++i) {
          const double outwards =
              n.dot(j->col(i).template head<3>()) + moment.dot(j->col(i).template tail<3>());
          gradient[i] = (link > other ? outwards : -outwards) * unit[i] / length;
        }
        result.push_back({gradient, (around_->margin - nearest.distance) / length});
      }
    });
    return result;
  }
  /// Step nearest to the desired joint step that moves the tip by `e` to first order and
  /// keeps the margin.
  [[nodiscard]] collision_free_step<Capacity>
  find_collision_free_step(const state& from, const small_twist& e,
                           const vector& desired_step) const {
    if (around_ == nullptr) {
      return {};
    }
    const auto inequalities = margin_inequalities<column>(from.theta);
    if (inequalities.empty()) {
      return {};
    }
    const vector down = lower - from.theta, up = upper - from.theta;
    const auto step = [&](const std::vector<inequality<column>>& active) {
      return constrained_step(from.jacobian, e, to_column(desired_step), to_column(down),
                              to_column(up), active);
    };
    const auto result = step(inequalities);
    if (result.step) {
      vector wide = vector::Zero();
      wide.head(result.step->size()) = *result.step;
      return {wide, result.smallest_singular_value};
    }
    // A step that is infeasible without obstacles too is not blocked by them.
    return {std::nullopt, result.smallest_singular_value, !step({}).step};
  }

private:
  /// Columns for steps beside obstacles: those of fixed size take a quarter less.
  using column = std::conditional_t<Capacity == 8, vector, bounded_vector<Capacity>>;
  [[nodiscard]] column to_column(const vector& x) const {
    if constexpr (Capacity == 8) {
      return x;
    } else {
      return x.head(size);
    }
  }

  /// Bodies of the scene in the frame of the base, by one traversal of the chain.
  [[nodiscard]] std::vector<capsule<double>>
  bodies_at(const bounded_vector<Capacity>& theta) const {
    std::array<tip_pose, std::size_t(Capacity) + 1> joints;
    const half_angle_sincos<double, -Capacity, bounded_vector<Capacity>> half_angles(theta, size,
                                                                                     size);
    joints[0] = {quaternion<double>(1), {0, 0, 0}};
    for (int i = 0; i < size; ++i) {
      const auto k = std::size_t(i);
      joints[k + 1] = after_joint<true>(joints[k], step_in_memory<double>{chain_.steps()[k]}, i,
                                        theta[i], half_angles, visit_nothing);
    }
    return moved_bodies(*around_, [&](int link) {
      return to_dual_quaternion(attached(joints[std::size_t(link)], table_->link(link).offset));
    });
  }

  vector unscaled_lower_, unscaled_upper_;
  chain_view chain_;
  const scene* around_;
  std::optional<bounded_chain<Capacity>> table_; ///< among obstacles, for poses of links
};

DUET_ABI_END
} // namespace duet::detail
