// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "bounded_step.hpp"
#include "planning_model.hpp"
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/motion_plan.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>

/// \file
/// Steps of a chain that bring its tip to a pose nearby, within the limits of the joints.

namespace duet::detail {
DUET_ABI_BEGIN

/// Joint-centring step (joint-limit avoidance): up to a `step` away from limits, growing towards
/// them.
template <class V>
[[nodiscard]] V joint_centring_step(const V& theta, const V& lower, const V& upper, double step) {
  V result = theta;
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    const double half = (upper[i] - lower[i]) / 2;
    const bool has_centre = half > 0 && half - half == 0;
    const double x = has_centre ? (theta[i] - lower[i]) / half - 1 : 0; // from -1 to 1
    result[i] = -std::min(step, half) * x * x * x;                      // never beyond the centre
  }
  return result;
}

/// Poses of the tip as a function of a parameter, with lengths in the planner's unit.
using tip_path = std::function<tip_pose(double)>;

/// Result of an attempt to bring the tip to a pose.
template <int Capacity>
struct step_result {
  chain_state<Capacity> state;
  pose_error residual = {}; ///< error of the tip relative to the pose
  /// Smallest singular value of the Jacobians of all iterates, from above.
  double smallest_singular_value = std::numeric_limits<double>::infinity();
  bool is_bounded = false;     ///< true if a limit was active
  bool is_blocked = false;     ///< true if no step satisfies the margins
  double margin_violation = 0; ///< violation of the margin to obstacles
  int iterations = 0;

  /// Ratio of the remaining error to the tolerance.
  [[nodiscard]] double error_ratio(const pose_tolerance& tolerance) const {
    return std::max(tolerance.ratio(residual), margin_violation / tolerance.translation);
  }
  [[nodiscard]] bool is_within(const pose_tolerance& tolerance) const {
    return error_ratio(tolerance) <= 1;
  }
};

/// Solver that brings the tip of a chain to poses nearby, to a tolerance.
template <int Capacity>
struct pose_solver {
  using vector = small_vector<Capacity>;

  const planning_model<Capacity>& model;
  pose_tolerance tolerance;
  vector lower = model.lower, upper = model.upper; ///< limits in use
  double damped_below = damping_threshold; ///< singular value below which steps are damped first

  [[nodiscard]] bool is_endless(Eigen::Index joint) const {
    return model.is_rotational[std::size_t(joint)] && std::isinf(upper[joint] - lower[joint]);
  }
  /// Difference of configurations except for full turns of joints without limits.
  [[nodiscard]] vector modulo_full_turns(vector difference) const {
    for (Eigen::Index i = 0; i < model.size; ++i) {
      if (is_endless(i)) {
        difference[i] = std::remainder(difference[i], 2 * std::numbers::pi);
      }
    }
    return difference;
  }

  /// Switches to steps without damping and nearer to targets: near singularities, damped joints
  /// would lag behind in a rapid reorientation.
  void without_damping() {
    damped_below = undamped_threshold_near_singularity;
    tolerance = {1e-3 * tolerance.translation, 1e-3 * tolerance.rotation};
  }

  /// Result of the step nearest to the desired joint step that takes the tip from a
  /// state nearby to the target to first order, and then of Newton's method by least-norm steps,
  /// without damping if that prevents convergence. No step leaves the limits.
  [[nodiscard]] step_result<Capacity> approach(const chain_state<Capacity>& from,
                                               const tip_pose& target,
                                               const vector& desired_step) const {
    auto result = approach(from, target, desired_step, damped_below);
    if (damped_below > undamped_threshold && result.smallest_singular_value < damped_below &&
        !result.is_within(tolerance)) {
      const int before = result.iterations;
      result = approach(from, target, desired_step, undamped_threshold);
      result.iterations += before;
    }
    return result;
  }

private:
  /// \param threshold  singular value below which steps are damped
  [[nodiscard]] step_result<Capacity> approach(const chain_state<Capacity>& from,
                                               const tip_pose& target, const vector& desired_step,
                                               double threshold) const {
    step_result<Capacity> result;
    if (!move(result, from, error_twist(from.tip, target), desired_step, threshold)) {
      result.state = from;
      return result;
    }
    for (double before = std::numeric_limits<double>::infinity();;) {
      const small_twist error = error_twist(result.state.tip, target);
      result.residual = deviation_of(error);
      result.margin_violation = model.margin_violation(result.state.theta);
      const double size = result.error_ratio(tolerance);
      // An iteration that does not at least halve the error will not converge.
      if (size <= 1 || result.iterations == max_iterations || size > before / 2 ||
          !move(result, result.state, error, vector::Zero(), threshold)) {
        return result;
      }
      before = size;
    }
  }

  /// Configuration clamped to the limits, which round-off may have violated.
  [[nodiscard]] vector within(const vector& theta) const {
    return theta.cwiseMax(lower).cwiseMin(upper);
  }

  /// Takes the step nearest to `desired_step` that moves the tip by `e` to first order, from a
  /// state that may be that of x; false if obstacles prevent every step.
  [[nodiscard]] bool move(step_result<Capacity>& x, const chain_state<Capacity>& from,
                          const small_twist& e, const vector& desired_step,
                          double threshold) const {
    ++x.iterations;
    const auto collision_free = model.find_collision_free_step(from, e, desired_step);
    x.smallest_singular_value =
        std::min(x.smallest_singular_value, collision_free.smallest_singular_value);
    if (collision_free.step) {
      model.set(x.state, within(from.theta + *collision_free.step));
      return true;
    }
    if (!collision_free.is_free) {
      x.is_blocked = true;
      x.residual.translation = std::numeric_limits<double>::infinity();
      return false;
    }
    const vector aim = within(from.theta + desired_step);
    const small_twist rest = e - from.jacobian * (aim - from.theta).head(model.size);
    const auto step = bounded_step(from.jacobian, rest, lower - aim, upper - aim, {threshold});
    x.smallest_singular_value = std::min(x.smallest_singular_value, step.smallest_singular_value);
    x.is_bounded = x.is_bounded || step.is_bounded;
    model.set(x.state, within(aim + step.step));
    return true;
  }

  static constexpr int max_iterations = 12;
};

DUET_ABI_END
} // namespace duet::detail
