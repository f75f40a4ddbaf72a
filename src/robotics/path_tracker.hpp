// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "bounded_step.hpp"
#include "path_step.hpp"
#include "planning_model.hpp"
#include "small_vector.hpp"
#include <duet/kinematics/motion_plan.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

/// \file
/// Tracking of a path, waypoint by waypoint.

namespace duet::detail {
DUET_ABI_BEGIN

/// Moves the joints along a path as far as possible without self-motions.
template <int Capacity>
class path_tracker {
public:
  using vector = small_vector<Capacity>;
  /// Gradient of the secondary objective.
  using gradient_function = std::function<vector(const vector&)>;
  struct waypoint {
    chain_state<Capacity> state;
    double u;
    pose_error residual = {};
    /// Smallest singular value of the Jacobians up to it, in the planner's units.
    double smallest_singular_value = std::numeric_limits<double>::infinity();
  };
  struct partial_plan {
    std::vector<waypoint> waypoints;
    double step = .01; ///< next step, as a fraction of the path

    explicit partial_plan(const waypoint& start) : waypoints{start} {}
    [[nodiscard]] const waypoint& back() const { return waypoints.back(); }
  };

  /// \param path        pose of the tip as a function of the parameter
  /// \param parameters  parameters that become waypoints, increasing; the first and the last are
  /// the ends of the path
  /// \param objective_gradient  gradient of the objective, or nothing
  path_tracker(const planning_model<Capacity>& model, const tip_path& path,
               std::vector<double> parameters, const plan_options& how,
               const gradient_function& objective_gradient)
      : solver{model, model.tolerance(how.tolerance)}, target(path), stops(std::move(parameters)),
        options(how), length(stops.back() - stops.front()),
        remaining_iterations(how.max_iterations), deviation_(model.tolerance(how.deviation)),
        objective_gradient_(objective_gradient) {}

  pose_solver<Capacity> solver;
  const tip_path& target;
  std::vector<double> stops;
  plan_options options;
  double length; ///< length of the path's parameter interval
  int remaining_iterations;

  /// Partial plan that consists of the start alone.
  [[nodiscard]] partial_plan stay(const vector& start) const {
    return partial_plan({solver.model.at(start), stops.front()});
  }
  [[nodiscard]] bool is_at_end(const partial_plan& x) const { return x.back().u == stops.back(); }

  /// Partial plan continued as far as possible without self-motions.
  [[nodiscard]] partial_plan continued(partial_plan best) {
    advance(best);
    for (partial_plan before = best; before.waypoints.size() > 1 && !is_at_end(best);) {
      before = before_singularity(before);
      keep_furthest(best, undamped(before));
    }
    return best;
  }
  static void keep_furthest(partial_plan& best, partial_plan other) {
    if (other.back().u > best.back().u) {
      best = std::move(other);
    }
  }

  /// Ratio of the tip's error to the deviation at a fraction `part` of the step between two
  /// waypoints.
  [[nodiscard]] double error_ratio_between(const waypoint& a, const waypoint& b,
                                           double part = .5) const {
    const vector between = (1 - part) * a.state.theta + part * b.state.theta;
    const pose_error off =
        pose_error_between(solver.model.at(between).tip, target((1 - part) * a.u + part * b.u));
    return std::max(deviation_.ratio(off),
                    solver.model.margin_violation(between) / deviation_.translation);
  }

  /// Partial plan up to where it last came near a singularity, if it did.
  [[nodiscard]] partial_plan before_singularity(partial_plan x) const {
    const auto drop_while = [&](bool is_near) {
      while (x.waypoints.size() > 1 &&
             (x.back().smallest_singular_value < damping_threshold) == is_near) {
        x.waypoints.pop_back();
      }
    };
    drop_while(false);
    drop_while(true);
    return x;
  }

  /// Partial plan continued without damping.
  [[nodiscard]] partial_plan undamped(partial_plan x) {
    const pose_solver<Capacity> damped = solver;
    solver.without_damping();
    x.step = options.smallest_step;
    advance(x);
    solver.damped_below = damped.damped_below;
    solver.tolerance = damped.tolerance;
    return x;
  }

  /// Secondary task of the joints in the null space of the Jacobian.
  struct null_space_task {
    const vector* aim = nullptr;   ///< configuration to reach at the end, or null
    bool lowers_objective = false; ///< true if steps descend along the gradient of the objectives
  };

  /// Tracks the path up to the parameter `end`, in steps that keep the tip near it between
  /// waypoints too.
  ///
  /// \param part  fraction of the path that this counts for
  /// \return false if there is no continuation
  [[nodiscard]] bool track(partial_plan& x, double end, double part, const null_space_task& task);

private:
  /// Continues as far as possible without stopping.
  void advance(partial_plan& x) {
    for (const double stop : stops) {
      if (stop > x.back().u &&
          !track(x, stop, (stop - x.back().u) / length, {.lowers_objective = true})) {
        return;
      }
    }
  }

  /// Descent step of the objectives.
  [[nodiscard]] vector descent_step(const vector& theta, double step) const {
    const vector centre =
        joint_centring_step(theta, solver.model.lower, solver.model.upper, options.centring * step);
    return objective_gradient_ ? centre - step * objective_gradient_(theta) : centre;
  }

  /// True if the joints move far in a short step along the path.
  [[nodiscard]] bool is_reorienting(const waypoint& at, double step) const {
    constexpr double min_step = 1e-12;
    return solver.damped_below == undamped_threshold_near_singularity && step > min_step &&
           solver.joint_distance_to(
               at.state, target(std::min(at.u + step * length, stops.back()))) > min_reorientation;
  }

  static constexpr double min_reorientation = 1e-3;
  pose_tolerance deviation_;
  const gradient_function& objective_gradient_;
};

template <int Capacity>
bool path_tracker<Capacity>::track(partial_plan& x, double end, double part,
                                   const null_space_task& task) {
  const double begin = x.back().u;
  double progress = 0; // fraction of the path up to `end`
  while (progress < 1) {
    const waypoint& current = x.back();
    const double next_progress = progress + x.step / part > 1 - 1e-9 ? 1 : progress + x.step / part;
    const double u = next_progress == 1 ? end : begin + (end - begin) * next_progress;
    const vector& theta = current.state.theta;
    const vector desired_step =
        task.aim != nullptr     ? (next_progress - progress) / (1 - progress) * (*task.aim - theta)
        : task.lowers_objective ? descent_step(theta, (next_progress - progress) * part)
                                : vector{};
    auto result = solver.approach(current.state, target(u), desired_step);
    remaining_iterations -= result.iterations;
    if (task.lowers_objective && result.smallest_singular_value < damping_threshold) {
      // The objective may move the joints to where the path has no continuation.
      result = solver.approach(current.state, target(u), {});
      remaining_iterations -= result.iterations;
    }
    double change = .25;
    if (result.is_within(solver.tolerance)) {
      const waypoint on{result.state, u, result.residual, result.smallest_singular_value};
      const double error_ratio = error_ratio_between(current, on);
      // The deviation between waypoints grows with the square of the step.
      change = std::clamp(.85 / std::sqrt(std::max(error_ratio, 1e-12)), .2, 2.0);
      if (x.step < options.smallest_step && norm(result.state.theta - theta) < min_reorientation) {
        change = .25; // the pose is within tolerance of both parameters: no progress
      } else if (error_ratio <= .95 || // halfway the deviation is not quite largest
                 (error_ratio <= 1 && result.smallest_singular_value < 3 * damping_threshold &&
                  error_ratio_between(current, on, .25) <= 1 &&
                  error_ratio_between(current, on, .75) <= 1)) {
        // Near a singularity the longest admissible steps may lead across it, shorter ones not.
        progress = next_progress;
        x.waypoints.push_back(on);
      }
    }
    x.step = std::min(options.largest_step, x.step * change);
    if (progress < 1 && (remaining_iterations <= 0 ||
                         (x.step < options.smallest_step && !is_reorienting(x.back(), x.step)))) {
      return false;
    }
  }
  return true;
}

DUET_ABI_END
} // namespace duet::detail
