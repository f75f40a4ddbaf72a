// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/planning/bounded_step.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/planning_model.hpp>
#include <duet/planning/small_vector.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>

/// \file
/// Steps of a chain that bring its tip to a pose nearby, within the limits of the joints.

namespace duet::detail {

/// What takes joints away from their limits: up to a `step` that grows towards them.
template <class V>
[[nodiscard]] V towards_middle(const V& theta, const V& lower, const V& upper, double step) {
  V result = theta;
  for (std::ptrdiff_t i = 0; i < theta.size(); ++i) {
    const double half = (upper[i] - lower[i]) / 2;
    const bool has_middle = half > 0 && half - half == 0;
    const double x = has_middle ? (theta[i] - lower[i]) / half - 1 : 0; // from -1 to 1
    result[i] = -std::min(step, half) * x * x * x;                      // never beyond the middle
  }
  return result;
}

/// Poses by a parameter. Its type is forgotten, so that planners are compiled once for all.
using path_function = std::function<dual_quaternion<double>(double)>;
/// Places of the tip by a parameter, lengths as planners count them.
using place_function = std::function<tip_place(double)>;

/// What became of an attempt to bring the tip to a pose.
template <int Room>
struct attempt {
  chain_state<Room> state;
  pose_deviation left = {}; ///< to the pose
  /// Of the Jacobians on the way, from above.
  double smallest_singular_value = std::numeric_limits<double>::infinity();
  bool is_bounded = false; ///< did a limit hold a joint back?
  bool is_blocked = false; ///< did obstacles leave no step?
  double shortfall = 0;    ///< of the margin to obstacles
  int iterations = 0;

  /// How many times the tolerance is what is left?
  [[nodiscard]] double excess(const pose_tolerance& tolerance) const {
    return std::max(tolerance.times(left), shortfall / tolerance.length);
  }
  [[nodiscard]] bool is_within(const pose_tolerance& tolerance) const {
    return excess(tolerance) <= 1;
  }
};

/// Brings the tip of a chain to poses nearby, to a tolerance.
template <int Room>
struct pose_solver {
  using vector = small_vector<Room>;

  const planning_model<Room>& model;
  pose_tolerance tolerance;
  vector lower = model.lower, upper = model.upper; ///< the limits that count
  double damped_below = damping_threshold; ///< singular values with which steps are damped first

  void without_limits() {
    for (std::ptrdiff_t i = 0; i < model.size; ++i) {
      lower[i] = -std::numeric_limits<double>::infinity();
      upper[i] = std::numeric_limits<double>::infinity();
    }
  }

  [[nodiscard]] bool is_endless(std::ptrdiff_t joint) const {
    return model.turns[std::size_t(joint)] && std::isinf(upper[joint] - lower[joint]);
  }
  /// How far configurations are apart but for whole turns of joints without limits.
  [[nodiscard]] vector without_turns(vector apart) const {
    for (std::ptrdiff_t i = 0; i < model.size; ++i) {
      if (is_endless(i)) {
        apart[i] = std::remainder(apart[i], 2 * std::numbers::pi);
      }
    }
    return apart;
  }

  /// Steps without damping and nearer to targets: beside singularities joints that are to swing
  /// would lag behind.
  void without_damping() {
    damped_below = swing_threshold;
    tolerance = {1e-3 * tolerance.length, 1e-3 * tolerance.angle};
  }

  [[nodiscard]] bool is_within_limits(const vector& theta) const {
    for (std::ptrdiff_t i = 0; i < model.size; ++i) {
      if (theta[i] < lower[i] || theta[i] > upper[i]) {
        return false;
      }
    }
    return true;
  }

  /// From a state nearby, the step nearest to `wish` that takes the tip to the target to first
  /// order, and then Newton's method by least steps, without damping where that is in the way. None
  /// leaves the limits.
  [[nodiscard]] attempt<Room> approach(const chain_state<Room>& from, const tip_place& target,
                                       const vector& wish) const {
    auto result = approach(from, target, wish, damped_below);
    if (damped_below > undamped_threshold && result.smallest_singular_value < damped_below &&
        !result.is_within(tolerance)) {
      const int before = result.iterations;
      result = approach(from, target, wish, undamped_threshold);
      result.iterations += before;
    }
    return result;
  }

  /// How far do joints go to a target beside a state, to first order, without damping?
  [[nodiscard]] double way_to(const chain_state<Room>& from, const tip_place& target) const {
    const auto step = bounded_step(from.jacobian, error_twist(from.tip, target), lower - from.theta,
                                   upper - from.theta, {swing_threshold});
    return norm(step.step);
  }

private:
  /// \param threshold  of singular values, below which steps are damped
  [[nodiscard]] attempt<Room> approach(const chain_state<Room>& from, const tip_place& target,
                                       const vector& wish, double threshold) const {
    attempt<Room> result;
    if (!move(result, from, error_twist(from.tip, target), wish, threshold)) {
      result.state = from;
      return result;
    }
    for (double before = std::numeric_limits<double>::infinity();;) {
      const small_twist error = error_twist(result.state.tip, target);
      result.left = deviation_of(error);
      result.shortfall = model.shortfall(result.state.theta);
      const double size = result.excess(tolerance);
      // What does not at least halve the error will not get there.
      if (size <= 1 || result.iterations == most || size > before / 2 ||
          !move(result, result.state, error, {}, threshold)) {
        return result;
      }
      before = size;
    }
  }

  /// Rounding may have led beyond the limits.
  [[nodiscard]] vector within(vector theta) const {
    for (std::ptrdiff_t i = 0; i < theta.size(); ++i) {
      theta[i] = std::clamp(theta[i], lower[i], upper[i]);
    }
    return theta;
  }

  /// The step nearest to `wish` that moves the tip by `e` to first order, from a state that may be
  /// that of x; false where obstacles leave none.
  [[nodiscard]] bool move(attempt<Room>& x, const chain_state<Room>& from, const small_twist& e,
                          const vector& wish, double threshold) const {
    ++x.iterations;
    const auto beside = model.step_beside(from, e, wish);
    x.smallest_singular_value = std::min(x.smallest_singular_value, beside.smallest_singular_value);
    if (beside.step) {
      model.set(x.state, within(from.theta + *beside.step));
      return true;
    }
    if (!beside.is_free) {
      x.is_blocked = true;
      x.left.length = std::numeric_limits<double>::infinity();
      return false;
    }
    const vector aim = within(from.theta + wish);
    const small_twist rest = what_is_left(e, from.jacobian, aim - from.theta);
    const auto step = bounded_step(from.jacobian, rest, lower - aim, upper - aim, {threshold});
    x.smallest_singular_value = std::min(x.smallest_singular_value, step.smallest_singular_value);
    x.is_bounded = x.is_bounded || step.is_bounded;
    model.set(x.state, within(aim + step.step));
    return true;
  }

  static constexpr int most = 12;
};

} // namespace duet::detail
