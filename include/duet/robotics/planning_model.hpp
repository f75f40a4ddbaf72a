// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/robotics/small_vector.hpp>
#include <duet/robotics/tip_pose.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#ifdef DUET_COMPILED
#include <duet/kinematics/robots.hpp>
#endif

/// \file
/// Models of a chain and its surroundings for planners. Only the few functions here depend on the
/// type of the chain, so that planners are compiled once for all chains.

namespace duet {

/// Scene without obstacles.
struct no_scene {};

} // namespace duet

namespace duet::detail {

/// Capacity of a planner's vectors for a chain of N joints: 8, 16, 32 …
[[nodiscard]] constexpr int joint_capacity(int n) {
  return int(std::bit_ceil(unsigned(std::max({8, n, -n}))));
}

/// Coordinates in a planner's vector; entries beyond the joints of the chain are 0 and remain so.
template <int Capacity, class X>
[[nodiscard]] small_vector<Capacity> scaled_joints(const X& theta, int size) {
  small_vector<Capacity> result;
  for (int i = 0; i < size; ++i) {
    result[i] = vector_argument<X>::get(theta, i);
  }
  return result;
}

/// Configuration of a chain, with its tip's pose and Jacobian in `frame::hybrid`.
template <int Capacity>
struct chain_state {
  small_vector<Capacity> theta;
  tip_pose tip;
  small_matrix<6, Capacity> jacobian;
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

/// Model of a chain without obstacles. Lengths, also displacements of prismatic joints and those in
/// Jacobians, are relative to the chain's characteristic length, so that planning does not depend
/// on the unit of length. They are converted nowhere else.
template <int Capacity>
class planning_model {
public:
  using vector = small_vector<Capacity>;
  using state = chain_state<Capacity>;

  template <class C>
  explicit planning_model(const C& chain) : size(chain.size()) {
    for (int i = 0; i < size; ++i) {
      const auto k = std::size_t(i);
      const auto& step = chain.steps()[k];
      const three_vector<double> offset = step.offset;
      lower[i] = chain.limits(i).lower;
      upper[i] = chain.limits(i).upper;
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
    for (int i = 0; i < Capacity; ++i) {
      unit[i] = i >= size || is_rotational[std::size_t(i)] ? 1 : length;
      row_unit_[i] = unit[i] / length;
      unscaled_lower_[i] = lower[i];
      unscaled_upper_[i] = upper[i];
      lower[i] /= unit[i];
      upper[i] /= unit[i];
    }
  }
  virtual ~planning_model() = default;

  /// Conversions from and to the user's units.
  ///
  /// \param theta  a vector of any kind
  template <class X>
  [[nodiscard]] vector joints(const X& theta) const {
    vector result = scaled_joints<Capacity>(theta, size);
    for (int i = 0; i < size; ++i) {
      result[i] /= unit[i];
    }
    return result;
  }
  [[nodiscard]] vector unscaled_joints(vector theta) const {
    for (int i = 0; i < Capacity; ++i) {
      theta[i] *= unit[i];
    }
    return theta;
  }
  /// Joints in the user's units, clamped to the limits, which round-off may have violated.
  [[nodiscard]] vector unscaled_joints_within_limits(const vector& theta) const {
    vector result = unscaled_joints(theta);
    for (int i = 0; i < size; ++i) {
      result[i] = std::clamp(result[i], unscaled_lower_[i], unscaled_upper_[i]);
    }
    return result;
  }
  [[nodiscard]] tip_pose scaled_pose(const dual_quaternion<double>& a) const {
    const tip_pose x = to_tip_pose(a);
    return {x.rotation, 1 / length * x.translation};
  }
  [[nodiscard]] dual_quaternion<double> unscaled_pose(const tip_pose& a) const {
    return detail::to_dual_quaternion({a.rotation, length * a.translation});
  }
  [[nodiscard]] small_matrix<6, Capacity> unscaled_jacobian(small_matrix<6, Capacity> j) const {
    for (int i = 0; i < size; ++i) {
      for (int k = 0; k < 3; ++k) {
        j(k, i) *= length / unit[i];
      }
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

  virtual void set(state& of, const vector& theta) const = 0;
  [[nodiscard]] state at(const vector& theta) const {
    state result;
    set(result, theta);
    return result;
  }

  /// Clearance: distance of the bodies of the chain from obstacles.
  [[nodiscard]] virtual double clearance(const vector&) const {
    return std::numeric_limits<double>::infinity();
  }
  /// \throws invalid_input if obstacles are closer than their margin
  virtual void require_clearance(const vector&, double /*tolerance*/) const {}
  /// Margin violation: the part of the margin that is missing.
  [[nodiscard]] double margin_violation(const vector& theta) const {
    return std::max(0.0, margin - clearance(theta));
  }
  /// Step nearest to the desired joint step that moves the tip by `e` to first order and
  /// keeps the margin.
  [[nodiscard]] virtual collision_free_step<Capacity>
  find_collision_free_step(const state& /*from*/, const small_twist& /*e*/,
                           const vector& /*desired_step*/) const {
    return {};
  }

protected:
  vector row_unit_; ///< units of the coordinates relative to the length

private:
  vector unscaled_lower_, unscaled_upper_;
};

/// Model of a chain of the type C.
template <class C>
class chain_model : public planning_model<joint_capacity(C::joints)> {
public:
  using base = planning_model<joint_capacity(C::joints)>;
  using typename base::state;
  using typename base::vector;

  explicit chain_model(const C& chain, const no_scene& = {}) : base(chain), chain_(chain) {}

  [[nodiscard]] const C& chain() const { return chain_; }
  void set(state& of, const vector& theta) const override;

private:
  const C& chain_;
};

template <class C>
void chain_model<C>::set(state& of, const vector& theta) const {
  of.theta = theta;
  of.tip = fill_jacobian<hybrid_frame, true, double>(
      of.jacobian, chain_, to_chain_joints(chain_, this->unscaled_joints(theta)), tip_of_chain{});
  of.tip.translation = 1 / this->length * of.tip.translation;
  for (std::size_t i = 0; i < of.jacobian.columns.size(); ++i) {
    auto& column = of.jacobian.columns[i].values;
    const double part = this->row_unit_.values[i]; // ω of prismatic joints is 0
    column[0] *= part;
    column[1] *= part;
    column[2] *= part;
  }
}

#ifdef DUET_COMPILED
DUET_COMPILED_TEMPLATE class chain_model<static_chain<robots::panda_arm>>;
DUET_COMPILED_TEMPLATE class chain_model<static_chain<robots::iiwa14_arm>>;
DUET_COMPILED_TEMPLATE class chain_model<static_chain<robots::ur5e_arm>>;
DUET_COMPILED_TEMPLATE class chain_model<static_chain<robots::baxter_left_arm>>;
DUET_COMPILED_TEMPLATE class chain_model<serial_chain<6>>;
DUET_COMPILED_TEMPLATE class chain_model<serial_chain<7>>;
DUET_COMPILED_TEMPLATE class chain_model<bounded_chain<16>>; // of URDF
#endif

} // namespace duet::detail
