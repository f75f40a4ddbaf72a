// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/mechanism/jacobian.hpp>
#include <duet/mechanism/serial_chain.hpp>

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>

/// \file
/// What planners see of a chain and of what is around it. Nothing in a planner depends on the type
/// of the chain but the few functions here, so that compilers make it once for all chains.

namespace duet::detail {

/// What stands for the number N of joints of a chain in planners: up to 8, 16, 32 … of them.
[[nodiscard]] constexpr int joint_room(int n) {
  return -int(std::bit_ceil(unsigned(std::max({8, n, -n}))));
}

/// A configuration of a chain, with its tip's pose and Jacobian in `frame::hybrid`.
template <int N>
struct chain_state {
  joint_vector<double, N> theta;
  dual_quaternion<double> pose;
  joint_columns<double, 6, N> jacobian;
};

/// Makes a state that of a chain at θ.
template <class C, int N>
void set_state(chain_state<N>& state, const C& chain, const joint_vector<double, N>& theta) {
  const auto tip = pose_and_jacobian(chain, joint_vector<double, C::joints>(theta), frame::hybrid);
  state.theta = theta;
  state.pose = tip.value;
  state.jacobian = tip.jacobian;
}

/// A step in the presence of obstacles.
template <int N>
struct step_beside_obstacles {
  std::optional<joint_vector<double, N>> step; ///< nothing where they leave none
  /// Of the Jacobian, from above.
  double smallest_singular_value = std::numeric_limits<double>::infinity();
  bool is_free = true; ///< is there nothing near, or nothing that obstacles could help with?
};

/// A chain of which N is as of `serial_chain`, and nothing around it.
template <int N>
class planning_model {
public:
  using vector = joint_vector<double, N>;

  planning_model(const vector& lower, const vector& upper) : lower_(lower), upper_(upper) {}
  virtual ~planning_model() = default;

  /// Of the joints.
  [[nodiscard]] const vector& lower() const { return lower_; }
  [[nodiscard]] const vector& upper() const { return upper_; }
  [[nodiscard]] virtual dual_quaternion<double> pose(const vector& theta) const = 0;
  virtual void set(chain_state<N>& state, const vector& theta) const = 0;

  /// The distance of the bodies of the chain from obstacles.
  [[nodiscard]] virtual double clearance(const vector&) const {
    return std::numeric_limits<double>::infinity();
  }
  /// \throws invalid_input where obstacles are closer than their margin
  virtual void require_clearance(const vector&, double /*tolerance*/) const {}
  /// How much of that margin is missing.
  [[nodiscard]] virtual double shortfall(const vector&) const { return 0; }
  /// The step nearest to `wish` that moves the tip by `e` to first order and keeps the margin.
  [[nodiscard]] virtual step_beside_obstacles<N> step_beside(const chain_state<N>& /*from*/,
                                                             const vector6<double>& /*e*/,
                                                             const vector& /*wish*/) const {
    return {};
  }

private:
  vector lower_, upper_;
};

/// A chain of the type C.
template <class C>
class chain_model : public planning_model<joint_room(C::joints)> {
  using base = planning_model<joint_room(C::joints)>;

public:
  using typename base::vector;

  explicit chain_model(const C& chain)
      : base(vector(lower_limits(chain)), vector(upper_limits(chain))), chain_(chain) {}

  [[nodiscard]] const C& chain() const { return chain_; }
  [[nodiscard]] dual_quaternion<double> pose(const vector& theta) const override {
    return chain_.pose(joint_vector<double, C::joints>(theta));
  }
  void set(chain_state<joint_room(C::joints)>& state, const vector& theta) const override {
    set_state(state, chain_, theta);
  }

private:
  const C& chain_;
};

} // namespace duet::detail
