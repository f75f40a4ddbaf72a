// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/twist.hpp>
#include <duet/mechanism/jacobian.hpp>
#include <duet/planning/bounded_step.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/obstacle_steps.hpp>
#include <duet/quaternion/exponential.hpp>

#include <algorithm>
#include <concepts>
#include <functional>
#include <limits>

/// \file
/// Steps of a chain that bring its tip to a pose nearby, within the limits of the joints.

namespace duet::detail {

/// The twist, in `frame::hybrid`, of the shorter screw motion from one pose to another in unit
/// time.
[[nodiscard]] inline vector6<double> error_twist(const dual_quaternion<double>& from,
                                                 const dual_quaternion<double>& to) {
  dual_quaternion<double> difference = to * conj(from);
  if (innermost(difference.w()) < 0) {
    difference = -difference;
  }
  const auto spatial = twist_of(dual_vector<double>(log(difference).vec()));
  return hybrid_twist(from, vector6<double>(2 * spatial));
}

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

/// A configuration of a chain, with its tip's pose and Jacobian in `frame::hybrid`.
template <class C>
struct chain_state {
  using vector = joint_vector<double, C::joints>;
  vector theta;
  dual_quaternion<double> pose;
  chain_jacobian<C, vector> jacobian;

  chain_state(const C& chain, const vector& at) : theta(at), jacobian(6, chain.size()) {
    const auto [a, m] = pose_and_jacobian(chain, theta, frame::hybrid);
    pose = a;
    jacobian = m;
  }
};

/// What became of an attempt to bring the tip to a pose.
template <class C>
struct attempt {
  chain_state<C> state;
  pose_deviation left; ///< to the pose
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
///
/// \tparam Scene  `scene` or `no_scene`
template <class C, class Scene = no_scene>
class pose_solver {
public:
  using vector = typename chain_state<C>::vector;

  pose_solver(const C& chain, double tolerance, const Scene& around)
      : chain_(chain), around_(around), lower_(lower_limits(chain)), upper_(upper_limits(chain)),
        tolerance_(tolerance) {}

  [[nodiscard]] const C& chain() const { return chain_; }
  [[nodiscard]] const vector& lower() const { return lower_; }
  [[nodiscard]] const vector& upper() const { return upper_; }
  [[nodiscard]] double tolerance() const { return tolerance_; }
  /// How much is missing to the margin to obstacles.
  [[nodiscard]] double shortfall(const vector& theta) const {
    return margin_shortfall(chain_, theta, around_);
  }

  /// From a state nearby, the step nearest to `wish` that takes the tip to the target to first
  /// order, and then Newton's method by least steps. None leaves the limits.
  [[nodiscard]] attempt<C> approach(const chain_state<C>& from,
                                    const dual_quaternion<double>& target,
                                    const vector& wish) const {
    attempt<C> result{from, {}};
    if (move(result, error_twist(from.pose, target), wish)) {
      correct(result, target);
    }
    return result;
  }

private:
  /// Rounding may have led beyond the limits.
  [[nodiscard]] vector within(const vector& theta) const {
    return theta.cwiseMax(lower_).cwiseMin(upper_);
  }

  void correct(attempt<C>& x, const dual_quaternion<double>& target) const {
    double before = std::numeric_limits<double>::infinity();
    for (;;) {
      const vector6<double> error = error_twist(x.state.pose, target);
      x.left = {error.head<3>().norm(), error.tail<3>().norm()};
      x.shortfall = shortfall(x.state.theta);
      const double size = std::max({x.left.length, x.left.angle, x.shortfall});
      // What does not at least halve the error will not get there.
      if (size <= tolerance_ || x.iterations == most || size > before / 2 ||
          !move(x, error, vector(vector::Zero(lower_.size())))) {
        return;
      }
      before = size;
    }
  }

  /// The step nearest to `wish` that moves the tip by `e` to first order; false where obstacles
  /// leave none.
  [[nodiscard]] bool move(attempt<C>& x, const vector6<double>& e, const vector& wish) const {
    ++x.iterations;
    const chain_state<C>& from = x.state;
    if constexpr (!std::same_as<Scene, no_scene>) {
      const auto beside =
          step_beside(chain_, from.theta, from.jacobian, e, wish, lower_, upper_, around_);
      x.smallest_singular_value =
          std::min(x.smallest_singular_value, beside.result.smallest_singular_value);
      if (beside.result.step) {
        x.state = chain_state<C>(chain_, within(from.theta + *beside.result.step));
        return true;
      }
      if (!beside.is_free) {
        x.is_blocked = true;
        x.left.length = std::numeric_limits<double>::infinity();
        return false;
      }
    }
    const vector aim = within(from.theta + wish);
    const vector6<double> rest = e - from.jacobian * (aim - from.theta);
    const auto step = bounded_step(from.jacobian, rest, vector(lower_ - aim), vector(upper_ - aim));
    x.smallest_singular_value = std::min(x.smallest_singular_value, step.smallest_singular_value);
    x.is_bounded = x.is_bounded || step.is_bounded;
    x.state = chain_state<C>(chain_, within(aim + step.step));
    return true;
  }

  static constexpr int most = 12;

  const C& chain_;
  const Scene& around_;
  vector lower_, upper_;
  double tolerance_;
};

} // namespace duet::detail
