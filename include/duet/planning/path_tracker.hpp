// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/planning/bounded_step.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/path_step.hpp>
#include <duet/planning/planning_model.hpp>
#include <duet/planning/small_vector.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

/// \file
/// Tracking of a path, waypoint by waypoint.

namespace duet::detail {

/// Moves the joints along a path as far as possible without self-motions.
template <int Room>
class path_tracker {
public:
  using vector = small_vector<Room>;
  /// Gradient of the objective that the joints lower.
  using slope_function = std::function<vector(const vector&)>;
  struct waypoint {
    chain_state<Room> state;
    double u;
    pose_error left = {};
    /// Smallest singular value of the Jacobians on the way to it, in the planner's units.
    double smallest_singular_value = std::numeric_limits<double>::infinity();
  };
  struct route {
    std::vector<waypoint> waypoints;
    double step = .01; ///< next step, as a fraction of the path

    explicit route(const waypoint& start) : waypoints{start} {}
    [[nodiscard]] const waypoint& back() const { return waypoints.back(); }
  };

  /// \param path        pose of the tip as a function of the parameter
  /// \param parameters  parameters that become waypoints, increasing; the first and the last are
  /// the ends of the path
  /// \param slope       gradient of the objective, or nothing
  path_tracker(const planning_model<Room>& model, const tip_path& path,
               std::vector<double> parameters, const plan_options& how, const slope_function& slope)
      : solver{model, model.tolerance(how.tolerance)}, target(path), stops(std::move(parameters)),
        options(how), length(stops.back() - stops.front()), iterations_left(how.max_iterations),
        deviation_(model.tolerance(how.deviation)), slope_(slope) {}

  pose_solver<Room> solver;
  const tip_path& target;
  std::vector<double> stops;
  plan_options options;
  double length; ///< length of the path's parameter interval
  int iterations_left;

  /// Route that consists of the start alone.
  [[nodiscard]] route stay(const vector& start) const {
    return route({solver.model.at(start), stops.front()});
  }
  [[nodiscard]] bool is_at_end(const route& x) const { return x.back().u == stops.back(); }

  /// Route continued as far as possible without self-motions.
  [[nodiscard]] route continued(route best) {
    advance(best);
    for (route before = best; before.waypoints.size() > 1 && !is_at_end(best);) {
      before = before_singularity(before);
      keep_furthest(best, undamped(before));
    }
    return best;
  }
  static void keep_furthest(route& best, route other) {
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
                    solver.model.shortfall(between) / deviation_.translation);
  }

  /// Route up to where it last came near a singularity, if it did.
  [[nodiscard]] route before_singularity(route x) const {
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

  /// Route continued without damping.
  [[nodiscard]] route undamped(route x) {
    const pose_solver<Room> damped = solver;
    solver.without_damping();
    x.step = options.smallest_step;
    advance(x);
    solver.damped_below = damped.damped_below;
    solver.tolerance = damped.tolerance;
    return x;
  }

  /// Preferences of the joints in the null space of the Jacobian, which the tip leaves free.
  struct wishes {
    const vector* aim = nullptr; ///< configuration to reach at the end
    bool lowers = false;         ///< true if they lower the objectives
  };

  /// Tracks the path up to the parameter `end`, in steps that keep the tip near it between
  /// waypoints too.
  ///
  /// \param part  fraction of the path that this counts for
  /// \return false if there is no continuation
  [[nodiscard]] bool track(route& x, double end, double part, const wishes& have);

private:
  /// Continues as far as possible without stopping.
  void advance(route& x) {
    for (const double stop : stops) {
      if (stop > x.back().u && !track(x, stop, (stop - x.back().u) / length, {.lowers = true})) {
        return;
      }
    }
  }

  /// Descent step of the objectives.
  [[nodiscard]] vector descent_step(const vector& theta, double step) const {
    const vector centre =
        joint_centring_step(theta, solver.model.lower, solver.model.upper, options.centring * step);
    return slope_ ? centre - step * slope_(theta) : centre;
  }

  /// True if the joints move far in a step along the path that is as short as that.
  [[nodiscard]] bool is_reorienting(const waypoint& at, double step) const {
    constexpr double least = 1e-12;
    return solver.damped_below == undamped_threshold_near_singularity && step > least &&
           solver.way_to(at.state, target(std::min(at.u + step * length, stops.back()))) >
               least_swing;
  }

  static constexpr double least_swing = 1e-3;
  pose_tolerance deviation_;
  const slope_function& slope_;
};

template <int Room>
bool path_tracker<Room>::track(route& x, double end, double part, const wishes& have) {
  const double begin = x.back().u;
  double way = 0; // 1 at the end
  while (way < 1) {
    const waypoint& here = x.back();
    const double next = way + x.step / part > 1 - 1e-9 ? 1 : way + x.step / part;
    const double u = next == 1 ? end : begin + (end - begin) * next;
    const vector& theta = here.state.theta;
    const vector wish = have.aim != nullptr ? (next - way) / (1 - way) * (*have.aim - theta)
                        : have.lowers       ? descent_step(theta, (next - way) * part)
                                            : vector{};
    auto there = solver.approach(here.state, target(u), wish);
    iterations_left -= there.iterations;
    if (have.lowers && there.smallest_singular_value < damping_threshold) {
      // The objective may lead the joints to where the path does not continue.
      there = solver.approach(here.state, target(u), {});
      iterations_left -= there.iterations;
    }
    double change = .25;
    if (there.is_within(solver.tolerance)) {
      const waypoint on{there.state, u, there.left, there.smallest_singular_value};
      const double excess = error_ratio_between(here, on);
      // The deviation between waypoints grows with the square of the step.
      change = std::clamp(.85 / std::sqrt(std::max(excess, 1e-12)), .2, 2.0);
      if (x.step < options.smallest_step && norm(there.state.theta - theta) < least_swing) {
        change = .25;             // within tolerance of two parameters, but no progress
      } else if (excess <= .95 || // not quite largest half way
                 (excess <= 1 && there.smallest_singular_value < 3 * damping_threshold &&
                  error_ratio_between(here, on, .25) <= 1 &&
                  error_ratio_between(here, on, .75) <= 1)) {
        // Near a singularity steps that are just allowed may lead straight on, shorter ones not.
        way = next;
        x.waypoints.push_back(on);
      }
    }
    x.step = std::min(options.largest_step, x.step * change);
    if (way < 1 && (iterations_left <= 0 ||
                    (x.step < options.smallest_step && !is_reorienting(x.back(), x.step)))) {
      return false;
    }
  }
  return true;
}

#ifdef DUET_COMPILED
DUET_COMPILED_TEMPLATE class path_tracker<8>;
DUET_COMPILED_TEMPLATE class path_tracker<16>;
#endif

} // namespace duet::detail
