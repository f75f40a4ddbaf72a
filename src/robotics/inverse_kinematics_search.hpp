// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "bounded_step.hpp"
#include "goal_equations.hpp"
#include "nearest_pose.hpp"
#include "planning_model.hpp"
#include "small_vector.hpp"
#include "splitmix64.hpp"
#include <duet/core/errors.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <numbers>

/// \file
/// Search for joint coordinates that take the tip of a chain to a goal: damped least squares
/// (Levenberg–Marquardt) with random restarts.

namespace duet::detail {
DUET_ABI_BEGIN

/// \throws invalid_input
inline void require_options(const inverse_kinematics_options& options) {
  constexpr const char* caller = "inverse_kinematics";
  require_positive(caller, "tolerance", options.tolerance);
  require_positive(caller, "max_iterations", options.max_iterations);
  require_option(caller, "max_restarts", options.max_restarts, options.max_restarts >= 0,
                 "a non-negative number");
  require_positive(caller, "candidates", options.candidates);
}

/// Comparison a < b with nan greater than any number.
[[nodiscard]] inline bool is_less(double a, double b) {
  return a < b || (std::isnan(b) && !std::isnan(a));
}

/// Common part of all searches for configurations of a chain.
///
/// \tparam Goal  a pose, or a type with its own `set_equations` and `is_beyond`
template <int Capacity, class Goal = tip_pose>
class inverse_kinematics_search {
  using vector = small_vector<Capacity>;

public:
  struct attempt {
    vector joints;
    pose_error residual;
    double error; ///< |e|²
    int iterations = 0;
    int restarts = 0;
    stop_reason reason = stop_reason::no_progress;
  };

  inverse_kinematics_search(const planning_model<Capacity>& model, const vector& start,
                            const inverse_kinematics_options& options)
      : model_(model), options_(options), tolerance_(model.tolerance(options.tolerance)),
        start_(start) {
    require_options(options);
    for (int i = 0; i < model.size; ++i) {
      require(start[i] - start[i] == 0, "duet: inverse_kinematics: joint ", i, " of the start is ",
              model.unit[i] * start[i], " (expected a finite number)");
      const bool is_rotational = model.is_rotational[std::size_t(i)];
      constexpr double full_turn = 2 * std::numbers::pi;
      const bool has_full_turn = is_rotational && !model.is_translational[std::size_t(i)] &&
                                 model.upper[i] - model.lower[i] >= full_turn;
      period_[i] = has_full_turn ? full_turn : 0;
      beyond_[i] = has_full_turn ? std::numeric_limits<double>::infinity() : 0;
      spread_[i] = is_rotational ? std::numbers::pi : 1;
    }
    start_ = within_limits(start_);
  }

  [[nodiscard]] attempt operator()(const Goal& goal) const;

  /// Damped least squares from one initial guess, without random restarts.
  [[nodiscard]] attempt approach(vector theta, const Goal& goal) const {
    attempt best{theta, {}, std::numeric_limits<double>::infinity()};
    double before = best.error;
    int since = 0; // iterations since the error last fell by a tenth
    for (int iteration = 0;; ++iteration) {
      const equations current = equations_at(theta, goal);
      const double error = dot(current.e, current.e);
      const bool is_reached = tolerance_.ratio(current.residual) <= 1;
      if (iteration == 0 || error < best.error || is_reached) {
        best = {theta, current.residual, error};
      }
      if (error < .9 * before) {
        before = error;
        since = 0;
      }
      best.iterations = iteration;
      if (is_reached || since == 4 || iteration == options_.max_iterations) {
        best.reason = is_reached   ? stop_reason::reached
                      : since == 4 ? stop_reason::no_progress
                                   : stop_reason::iteration_limit;
        return best;
      }
      ++since;
      theta = within_limits(theta + step(current, damping(current)).step);
    }
  }

  /// Reason why the search cannot continue from a configuration.
  [[nodiscard]] stop_reason obstacle(const vector& theta, const Goal& goal) const {
    const equations current = equations_at(theta, goal);
    if (step(current, damping(current)).is_bounded) {
      return stop_reason::joint_limit;
    }
    gram_matrix gram = gram_of(current.at.jacobian);
    int count = 6;
    for (std::ptrdiff_t i = 0; i < 6; ++i) {
      if (current.is_free[std::size_t(i)]) {
        gram(i, i) = 1;
        --count;
      }
    }
    const bool is_singular =
        model_.size >= count && damped_gram(gram).smallest() < 10 * damping_threshold;
    return is_singular ? stop_reason::singular : stop_reason::no_progress;
  }

  /// Random configuration, uniform within the limits; without them, about the start.
  [[nodiscard]] vector configuration(splitmix64& random) const {
    vector theta;
    for (std::ptrdiff_t i = 0; i < model_.size; ++i) {
      double lower = model_.lower[i], upper = model_.upper[i];
      if (!(upper - lower < std::numeric_limits<double>::infinity())) {
        lower = std::max(lower, start_[i] - spread_[i]);
        upper = std::min(upper, start_[i] + spread_[i]);
      }
      theta[i] = lower + (upper - lower) * random();
    }
    return theta;
  }

  [[nodiscard]] const vector& start() const { return start_; }
  /// Changes of the coordinates that leave the pose unchanged: 0 or a full turn.
  [[nodiscard]] const vector& period() const { return period_; }

private:
  using equations = goal_equations<Capacity>;
  [[nodiscard]] equations equations_at(const vector& theta, const Goal& goal) const {
    equations result{model_.at(theta), {}, {}};
    set_equations(result, goal);
    return result;
  }

  /// Levenberg–Marquardt (damped least squares) step.
  [[nodiscard]] bounded_step_result<vector> step(const equations& x, double lambda) const {
    return bounded_step(x.at.jacobian, x.e, model_.lower - x.at.theta - beyond_,
                        model_.upper - x.at.theta + beyond_, {0, lambda});
  }
  /// Damping, which grows with the error.
  [[nodiscard]] static double damping(const equations& x) {
    return std::min(.02 * dot(x.e, x.e), .08) + 1e-9;
  }

  /// Nearest pose from a start on: minimum of the squared distance of the origins plus |ω|², by
  /// Newton's method with a damping that lets no step increase it. Joints at limits that block them
  /// are fixed there.
  template <std::same_as<tip_pose> Pose>
  [[nodiscard]] attempt nearest(const vector& start, const Pose& goal) const {
    point current = point_at(start, goal);
    double lambda = 0;
    int iterations = 0;
    for (bool is_lower = true; is_lower && iterations < options_.max_iterations &&
                               current.max_gradient > 1e-12 * (1 + current.error);
         ++iterations) {
      is_lower = false;
      for (; !is_lower && lambda < 1e6 * (1 + current.error); lambda = std::max(4 * lambda, 1e-3)) {
        const auto step = newton_step(current.to_second_order, current.is_fixed, lambda);
        if (!step) {
          continue;
        }
        vector theta = current.theta;
        for (std::ptrdiff_t i = 0; i < model_.size; ++i) {
          theta[i] += (*step)[i];
        }
        const point next = point_at(within_limits(theta), goal);
        // Near the minimum round-off hides a decrease of the error, but not of its gradient.
        const bool is_even = next.error <= current.error * (1 + 1e-14);
        is_lower = next.error < current.error * (1 - 1e-14) ||
                   (is_even && next.max_gradient < current.max_gradient);
        if (is_lower) {
          current = next;
        }
      }
      lambda = lambda < 1e-2 ? 0 : lambda / 16;
    }
    return {
        current.theta, current.residual, current.error, iterations, 0, stop_reason::out_of_reach};
  }

  struct point {
    vector theta;
    pose_error residual;
    double error; ///< squared distance of the origins plus |ω|²
    squared_error<Capacity> to_second_order;
    std::array<bool, std::size_t(Capacity)> is_fixed{}; ///< true if fixed at a limit that blocks it
    double max_gradient = 0; ///< largest entry of the gradient of joints that are not fixed
  };
  template <std::same_as<tip_pose> Pose>
  [[nodiscard]] point point_at(const vector& theta, const Pose& goal) const {
    const equations x = equations_at(theta, goal);
    const three_vector<double> displacement = goal.translation - x.at.tip.translation;
    const small_twist e{{displacement.x, displacement.y, displacement.z, x.e[3], x.e[4], x.e[5]}};
    point result{theta, x.residual, dot(e, e), squared_error_of(x.at.jacobian, e)};
    for (std::ptrdiff_t i = 0; i < Capacity; ++i) {
      const double gradient = result.to_second_order.gradient[i];
      const bool is_at_limit = period_[i] == 0 && (gradient > 0 ? theta[i] <= model_.lower[i]
                                                                : theta[i] >= model_.upper[i]);
      bool& is_fixed = result.is_fixed[std::size_t(i)];
      is_fixed = i >= model_.size || is_at_limit;
      result.max_gradient = std::max(result.max_gradient, is_fixed ? 0 : std::abs(gradient));
    }
    return result;
  }

  /// Revolute joints whose range contains a full turn are wrapped into it, others stop at limits.
  [[nodiscard]] vector within_limits(vector theta) const {
    for (std::ptrdiff_t i = 0; i < model_.size; ++i) {
      const double lower = model_.lower[i], upper = model_.upper[i];
      if (period_[i] > 0 && theta[i] > upper) {
        theta[i] -= period_[i] * std::ceil((theta[i] - upper) / period_[i]);
      } else if (period_[i] > 0 && theta[i] < lower) {
        theta[i] += period_[i] * std::ceil((lower - theta[i]) / period_[i]);
      }
      theta[i] = std::clamp(theta[i], lower, upper);
    }
    return theta;
  }

  const planning_model<Capacity>& model_;
  inverse_kinematics_options options_;
  pose_tolerance tolerance_;
  vector period_;
  vector beyond_; ///< admissible excess of steps beyond limits: infinite if joints are wrapped
  vector spread_; ///< distance from the start of random coordinates that have no limits
  vector start_;
};

template <int Capacity, class Goal>
typename inverse_kinematics_search<Capacity, Goal>::attempt
inverse_kinematics_search<Capacity, Goal>::operator()(const Goal& goal) const {
  const bool is_out_of_reach = is_beyond(model_.reach, goal, tolerance_);
  const auto search = [&](const vector& from) {
    if constexpr (std::same_as<Goal, tip_pose>) {
      if (is_out_of_reach) {
        return nearest(from, goal);
      }
    }
    return approach(from, goal);
  };
  attempt best = search(start_);
  int iterations = best.iterations, restarts = 0;
  splitmix64 random(options_.seed);
  while (best.reason != stop_reason::reached && restarts < options_.max_restarts) {
    const attempt next = search(configuration(random));
    iterations += next.iterations;
    ++restarts;
    if (is_less(next.error, best.error)) {
      best = next;
    }
  }
  if (is_out_of_reach && best.reason != stop_reason::reached) {
    best.reason = stop_reason::out_of_reach;
  } else if (best.reason == stop_reason::no_progress) {
    best.reason = obstacle(best.joints, goal);
  }
  best.iterations = iterations;
  best.restarts = restarts;
  return best;
}

DUET_ABI_END
} // namespace duet::detail
