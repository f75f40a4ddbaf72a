// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/twist.hpp>
#include <duet/planning/bounded_step.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/planning_model.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <functional>
#include <limits>

/// \file
/// Steps of a chain that bring its tip to a pose nearby, within the limits of the joints.

namespace duet::detail {

/// What takes joints away from their limits: up to a `step` that grows towards them.
template <class V>
[[nodiscard]] V towards_middle(const V& theta, const V& lower, const V& upper, double step) {
  V result = V::Zero(theta.size());
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    const double half = (upper[i] - lower[i]) / 2;
    if (half > 0 && half - half == 0) {
      const double x = (theta[i] - lower[i]) / half - 1; // from -1 to 1
      result[i] = -std::min(step, half) * x * x * x;     // never beyond the middle
    }
  }
  return result;
}

/// Poses by a parameter. Its type is forgotten, so that planners are compiled once for all.
using path_function = std::function<dual_quaternion<double>(double)>;

/// What became of an attempt to bring the tip to a pose.
template <int N>
struct attempt {
  chain_state<N> state;
  pose_deviation left = {}; ///< to the pose
  /// Of the Jacobians on the way, from above.
  double smallest_singular_value = std::numeric_limits<double>::infinity();
  bool is_bounded = false; ///< did a limit hold a joint back?
  bool is_blocked = false; ///< did obstacles leave no step?
  double shortfall = 0;    ///< of the margin to obstacles
  int iterations = 0;

  [[nodiscard]] bool is_within(double tolerance) const {
    return left.length <= tolerance && left.angle <= tolerance && shortfall <= tolerance;
  }
};

/// Brings the tip of a chain to poses nearby.
template <int N>
class pose_solver {
public:
  using vector = joint_vector<double, N>;

  pose_solver(const planning_model<N>& model, double tolerance)
      : model_(model), tolerance_(tolerance) {}

  [[nodiscard]] const planning_model<N>& model() const { return model_; }
  [[nodiscard]] double tolerance() const { return tolerance_; }

  /// From a state nearby, the step nearest to `wish` that takes the tip to the target to first
  /// order, and then Newton's method by least steps. None leaves the limits.
  [[nodiscard]] attempt<N> approach(const chain_state<N>& from,
                                    const dual_quaternion<double>& target,
                                    const vector& wish) const {
    attempt<N> result;
    if (move(result, from, error_twist(from.pose, target), wish)) {
      correct(result, target);
    } else {
      result.state = from;
    }
    return result;
  }

private:
  /// Rounding may have led beyond the limits.
  [[nodiscard]] vector within(const vector& theta) const {
    return theta.cwiseMax(model_.lower()).cwiseMin(model_.upper());
  }

  void correct(attempt<N>& x, const dual_quaternion<double>& target) const {
    double before = std::numeric_limits<double>::infinity();
    for (;;) {
      const vector6<double> error = error_twist(x.state.pose, target);
      x.left = {error.head<3>().norm(), error.tail<3>().norm()};
      x.shortfall = model_.shortfall(x.state.theta);
      const double size = std::max({x.left.length, x.left.angle, x.shortfall});
      // What does not at least halve the error will not get there.
      if (size <= tolerance_ || x.iterations == most || size > before / 2 ||
          !move(x, x.state, error, vector(vector::Zero(x.state.theta.size())))) {
        return;
      }
      before = size;
    }
  }

  /// The step nearest to `wish` that moves the tip by `e` to first order, from a state that may be
  /// that of x; false where obstacles leave none.
  [[nodiscard]] bool move(attempt<N>& x, const chain_state<N>& from, const vector6<double>& e,
                          const vector& wish) const {
    ++x.iterations;
    const auto beside = model_.step_beside(from, e, wish);
    x.smallest_singular_value = std::min(x.smallest_singular_value, beside.smallest_singular_value);
    if (beside.step) {
      model_.set(x.state, within(from.theta + *beside.step));
      return true;
    }
    if (!beside.is_free) {
      x.is_blocked = true;
      x.left.length = std::numeric_limits<double>::infinity();
      return false;
    }
    const vector aim = within(from.theta + wish);
    vector6<double> rest = e;
    for (Eigen::Index i = 0; i < aim.size(); ++i) {
      rest -= (aim[i] - from.theta[i]) * from.jacobian.col(i);
    }
    const auto step = bounded_step(from.jacobian, rest, vector(model_.lower() - aim),
                                   vector(model_.upper() - aim));
    x.smallest_singular_value = std::min(x.smallest_singular_value, step.smallest_singular_value);
    x.is_bounded = x.is_bounded || step.is_bounded;
    model_.set(x.state, within(aim + step.step));
    return true;
  }

  static constexpr int most = 12;

  const planning_model<N>& model_;
  double tolerance_;
};

} // namespace duet::detail
