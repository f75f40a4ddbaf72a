// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/mechanism/jacobian.hpp>
#include <duet/mechanism/serial_chain.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/small_vector.hpp>
#include <duet/planning/tip_place.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#ifdef DUET_COMPILED
#include <duet/mechanism/robots.hpp>
#endif

/// \file
/// What planners see of a chain and of what is around it. Nothing in a planner depends on the type
/// of the chain but the few functions here, so that compilers make it once for all chains.

namespace duet {

/// No obstacles.
struct no_scene {};

} // namespace duet

namespace duet::detail {

/// What stands for the number N of joints of a chain in planners: 8, 16, 32 … are room enough.
[[nodiscard]] constexpr int joint_room(int n) {
  return int(std::bit_ceil(unsigned(std::max({8, n, -n}))));
}

/// Coordinates as the planner's own. Those of joints that the chain has not got are 0 and stay it.
template <int Room, class X>
[[nodiscard]] small_vector<Room> planned_joints(const X& theta, int size) {
  small_vector<Room> result;
  for (int i = 0; i < size; ++i) {
    result[i] = vector_argument<X>::get(theta, i);
  }
  return result;
}

/// A configuration of a chain, with its tip's place and Jacobian in `frame::hybrid`.
template <int Room>
struct chain_state {
  small_vector<Room> theta;
  tip_place tip;
  small_matrix<6, Room> jacobian;
};

/// How far a chain can stretch: the origin of the first joint stands still in the base, that of the
/// last in the tip's frame, and between the two are links and sliding joints.
struct chain_reach {
  three_vector<double> first; ///< the origin of the first joint
  three_vector<double> back;  ///< of the last one, in the tip's frame
  double links = 0, tool = 0; ///< lengths
  double travel = 0;          ///< of sliding joints
  double limited_travel = 0;  ///< of those that have limits
  bool has_joints = false;

  /// Is it certain that no pose of the tip is as near to the goal as that?
  [[nodiscard]] bool is_beyond(const tip_place& goal, const pose_tolerance& tolerance) const {
    const double distance = length_of(goal.point(back) - first);
    return has_joints &&
           distance > (links + travel) * (1 + 1e-12) + tolerance.length + tolerance.angle * tool;
  }
  /// A length typical of the chain, 1 where there is none in its table. In other units it is that
  /// many times as large.
  [[nodiscard]] double scale() const {
    const double all = links + tool + limited_travel;
    return all > 0 ? all : 1;
  }
  /// The reach with lengths in units of one that is given.
  [[nodiscard]] chain_reach in_units_of(double length) const {
    const double s = 1 / length;
    return {s * first, s * back, s * links, s * tool, s * travel, s * limited_travel, has_joints};
  }
};

/// A step in the presence of obstacles.
template <int Room>
struct step_beside_obstacles {
  std::optional<small_vector<Room>> step; ///< nothing where they leave none
  /// Of the Jacobian, from above.
  double smallest_singular_value = std::numeric_limits<double>::infinity();
  bool is_free = true; ///< is there nothing near, or nothing that obstacles could help with?
};

/// A chain and nothing around it. Lengths are counted in units of the chain's own, those that
/// joints slide and those of Jacobians, too: what planners do does not depend on the unit of
/// length. Here alone they are turned into others.
template <int Room>
class planning_model {
public:
  using vector = small_vector<Room>;
  using state = chain_state<Room>;

  template <class C>
  explicit planning_model(const C& chain) : size(chain.size()) {
    for (int i = 0; i < size; ++i) {
      const auto k = std::size_t(i);
      const auto& step = chain.steps()[k];
      const three_vector<double> offset = step.offset;
      lower[i] = chain.limits(i).lower;
      upper[i] = chain.limits(i).upper;
      turns[k] = step.turns;
      slides[k] = step.slides;
      if (i == 0) {
        reach.first = offset;
      } else {
        reach.links += length_of(offset);
      }
      if (step.slides) {
        const double way = std::abs(step.pitch) * std::max(std::abs(lower[i]), std::abs(upper[i]));
        reach.travel += way;
        reach.limited_travel += way - way == 0 ? way : 0;
      }
    }
    const auto& offset = chain.tip().offset;
    const three_vector<double> tool = components(offset.translation);
    reach.back = -1 * rotated(conj(offset.rotation), tool);
    reach.tool = length_of(tool);
    reach.has_joints = size > 0;
    length = reach.scale();
    reach = reach.in_units_of(length);
    for (int i = 0; i < Room; ++i) {
      unit[i] = i >= size || turns[std::size_t(i)] ? 1 : length;
      row_unit_[i] = unit[i] / length;
      given_lower_[i] = lower[i];
      given_upper_[i] = upper[i];
      lower[i] /= unit[i];
      upper[i] /= unit[i];
    }
  }
  virtual ~planning_model() = default;

  /// From and to what a user counts.
  /// \param theta  a vector of any kind
  template <class X>
  [[nodiscard]] vector joints(const X& theta) const {
    vector result = planned_joints<Room>(theta, size);
    for (int i = 0; i < size; ++i) {
      result[i] /= unit[i];
    }
    return result;
  }
  [[nodiscard]] vector given_joints(vector theta) const {
    for (int i = 0; i < Room; ++i) {
      theta[i] *= unit[i];
    }
    return theta;
  }
  /// Rounding may have led beyond the limits.
  [[nodiscard]] vector given_joints_within_limits(const vector& theta) const {
    vector result = given_joints(theta);
    for (int i = 0; i < size; ++i) {
      result[i] = std::clamp(result[i], given_lower_[i], given_upper_[i]);
    }
    return result;
  }
  [[nodiscard]] tip_place place(const dual_quaternion<double>& a) const {
    const tip_place x = place_of(a);
    return {x.rotation, 1 / length * x.translation};
  }
  [[nodiscard]] dual_quaternion<double> given_pose(const tip_place& a) const {
    return detail::pose_at({a.rotation, length * a.translation});
  }
  [[nodiscard]] small_matrix<6, Room> given_jacobian(small_matrix<6, Room> j) const {
    for (int i = 0; i < size; ++i) {
      for (int k = 0; k < 3; ++k) {
        j(k, i) *= length / unit[i];
      }
    }
    return j;
  }
  [[nodiscard]] pose_tolerance tolerance(const pose_tolerance& x) const {
    return {x.length / length, x.angle};
  }
  [[nodiscard]] pose_deviation given_deviation(const pose_deviation& x) const {
    return {length * x.length, x.angle};
  }

  int size;          ///< number of joints
  double length = 1; ///< of the chain, in a user's units
  vector unit;       ///< of each coordinate, in a user's
  vector lower, upper;
  std::array<bool, std::size_t(Room)> turns{}, slides{};
  chain_reach reach;
  double margin = 0; ///< to obstacles

  virtual void set(state& of, const vector& theta) const = 0;
  [[nodiscard]] state at(const vector& theta) const {
    state result;
    set(result, theta);
    return result;
  }

  /// The distance of the bodies of the chain from obstacles.
  [[nodiscard]] virtual double clearance(const vector&) const {
    return std::numeric_limits<double>::infinity();
  }
  /// \throws invalid_input where obstacles are closer than their margin
  virtual void require_clearance(const vector&, double /*tolerance*/) const {}
  /// How much of that margin is missing.
  [[nodiscard]] double shortfall(const vector& theta) const {
    return std::max(0.0, margin - clearance(theta));
  }
  /// The step nearest to `wish` that moves the tip by `e` to first order and keeps the margin.
  [[nodiscard]] virtual step_beside_obstacles<Room>
  step_beside(const state& /*from*/, const small_twist& /*e*/, const vector& /*wish*/) const {
    return {};
  }

protected:
  vector row_unit_; ///< of the coordinates by the length

private:
  vector given_lower_, given_upper_;
};

/// A chain of the type C.
template <class C>
class chain_model : public planning_model<joint_room(C::joints)> {
public:
  using base = planning_model<joint_room(C::joints)>;
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
      of.jacobian, chain_, own_joints(chain_, this->given_joints(theta)), tip_of_chain{});
  of.tip.translation = 1 / this->length * of.tip.translation;
  for (std::size_t i = 0; i < of.jacobian.columns.size(); ++i) {
    auto& column = of.jacobian.columns[i].values;
    const double part = this->row_unit_.values[i]; // of joints that slide ω is 0
    column[0] *= part;
    column[1] *= part;
    column[2] *= part;
  }
}

#ifdef DUET_COMPILED
DUET_COMPILED_TEMPLATE class chain_model<compiled_chain<robots::panda_arm>>;
DUET_COMPILED_TEMPLATE class chain_model<compiled_chain<robots::iiwa14_arm>>;
DUET_COMPILED_TEMPLATE class chain_model<compiled_chain<robots::ur5e_arm>>;
DUET_COMPILED_TEMPLATE class chain_model<compiled_chain<robots::baxter_left_arm>>;
DUET_COMPILED_TEMPLATE class chain_model<serial_chain<6>>;
DUET_COMPILED_TEMPLATE class chain_model<serial_chain<7>>;
DUET_COMPILED_TEMPLATE class chain_model<serial_chain<-16>>; // of URDF
#endif

} // namespace duet::detail
