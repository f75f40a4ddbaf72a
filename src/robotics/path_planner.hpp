// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "path_step.hpp"
#include "path_tracker.hpp"
#include "planning_model.hpp"
#include "self_motion_search.hpp"
#include <duet/kinematics/motion_plan.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

/// \file
/// Planner behind `follow_path` and `plan_screw_motion`.

namespace duet::detail {
DUET_ABI_BEGIN

/// Planner along a path, first without stopping; if that ends early, with self-motions.
template <int Capacity>
class path_planner {
public:
  using tracker = path_tracker<Capacity>;
  using vector = typename tracker::vector;
  using waypoint = typename tracker::waypoint;
  using partial_plan = typename tracker::partial_plan;

  /// Arguments as in `path_tracker`.
  path_planner(const planning_model<Capacity>& model, const tip_path& target,
               std::vector<double> stops, const plan_options& options,
               const typename tracker::gradient_function& objective_gradient)
      : steps_(model, target, std::move(stops), options, objective_gradient) {}

  [[nodiscard]] partial_plan plan(const vector& start);
  /// Partial plan that consists of the start alone.
  [[nodiscard]] partial_plan stay(const vector& start) const { return steps_.stay(start); }
  [[nodiscard]] int iterations() const {
    return steps_.options.max_iterations - steps_.remaining_iterations;
  }

  /// Termination reason: the cause of failure of the first step that fails, of steps that grow.
  [[nodiscard]] stop_reason reason(const partial_plan& x) const {
    if (steps_.is_at_end(x) || steps_.remaining_iterations <= 0) {
      return steps_.is_at_end(x) ? stop_reason::reached : stop_reason::iteration_limit;
    }
    const waypoint& current = x.back();
    for (double step = steps_.options.smallest_step; step < 1; step *= 2) {
      const double u = std::min(current.u + step * steps_.length, steps_.stops.back());
      const auto result = steps_.solver.approach(current.state, steps_.target(u), {});
      if (result.is_within(steps_.solver.tolerance)) {
        continue;
      }
      const bool is_near_singularity = result.smallest_singular_value < 10 * damping_threshold;
      return result.is_blocked || result.margin_violation > steps_.solver.tolerance.translation
                 ? stop_reason::obstacle
             : (result.is_bounded || is_near_singularity) && is_stopped_by_limits(x, u)
                 ? stop_reason::joint_limit
             : is_near_singularity ? stop_reason::singular
                                   : stop_reason::no_progress;
    }
    return stop_reason::no_progress;
  }

private:
  /// True if joint limits end the plan: without limits it continues beyond the parameter u, from
  /// its end or from before the singularity there, if necessary by a self-motion; or, if the arm is
  /// not redundant, its continuation through the singularity leaves the limits.
  [[nodiscard]] bool is_stopped_by_limits(const partial_plan& x, double u) const {
    constexpr int max_iterations = 100000;
    tracker free = steps_;
    free.remaining_iterations = max_iterations;
    free.solver.without_limits();
    const double beyond = std::min(u + 4 * (u - x.back().u), steps_.stops.back());
    free.stops = {steps_.stops.front(), beyond};
    partial_plan end = free.undamped(partial_plan(x.back()));
    if (!free.is_at_end(end) && x.back().smallest_singular_value < damping_threshold) {
      end = free.undamped(steps_.before_singularity(x));
    }
    return free.is_at_end(end) || continues_after_self_motion(free, end.back(), beyond) ||
           (steps_.solver.model.size <= 6 &&
            !steps_.solver.is_within_limits(end.back().state.theta));
  }
  [[nodiscard]] static bool continues_after_self_motion(tracker free, const waypoint& from,
                                                        double to) {
    free.solver.without_damping();
    self_motion_search search(free.solver, free.target, free.options.self_motion_step,
                              damping_threshold, to - from.u, free.remaining_iterations);
    return free.options.search_step > 0 &&
           search.run(from.state, {from.u, to}).front().back().u == to;
  }
  [[nodiscard]] static bool is_singular(const waypoint& x) {
    return smallest_singular_value_of(x.state.jacobian) < damping_threshold;
  }

  /// Better plan with self-motions from a waypoint of `before`, or `before` itself.
  [[nodiscard]] partial_plan with_search(const partial_plan& before, std::size_t first) {
    partial_plan begin(before.waypoints.front());
    begin.waypoints.assign(before.waypoints.begin(),
                           before.waypoints.begin() + std::ptrdiff_t(first) + 1);
    partial_plan best = before;
    const double full_step = steps_.options.search_step, enough = end_resolution();
    // A continuation near a singularity may cross it where the tip cannot follow; the second search
    // therefore avoids such crossings. Or it passes so near that joints get to the other side; the
    // further searches therefore use shorter steps.
    for (const auto& [singular, step] :
         {std::pair(damping_threshold, full_step), std::pair(singularity_threshold, full_step),
          std::pair(damping_threshold, full_step / 4),
          std::pair(damping_threshold, full_step / 16)}) {
      self_motion_search search(steps_.solver, steps_.target, steps_.options.self_motion_step,
                                singular, enough, steps_.remaining_iterations);
      const auto continuations =
          search.run(begin.back().state, search_parameters(begin.back(), step));
      steps_.remaining_iterations = search.remaining_iterations();
      for (const auto& continuation : continuations) {
        if (!steps_.is_at_end(best)) {
          steps_.keep_furthest(best, along(begin, continuation));
        }
      }
      if (best.back().u + enough >= continuations.front().back().u) {
        break;
      }
    }
    return best;
  }
  /// Parameter distance from its end to which a continuation is followed.
  [[nodiscard]] double end_resolution() const {
    return 100 * steps_.options.smallest_step * steps_.length;
  }

  /// Plan along a continuation from the search, and beyond.
  [[nodiscard]] partial_plan
  along(partial_plan x, const typename self_motion_search<Capacity>::configurations& continuation) {
    for (std::size_t i = 1; i < continuation.size(); ++i) {
      const std::size_t count = x.waypoints.size();
      const auto track_to = [&](bool is_back) {
        x.step = steps_.options.search_step;
        return is_back ? track_backwards(x, continuation[i])
                       : steps_.track(x, continuation[i].u, steps_.options.search_step,
                                      {&continuation[i].state.theta});
      };
      if (!track_to(continuation[i].escapes_singularity)) {
        x.waypoints.erase(x.waypoints.begin() + std::ptrdiff_t(count), x.waypoints.end());
        if (!track_to(!continuation[i].escapes_singularity)) {
          return x;
        }
      }
    }
    return steps_.continued(std::move(x));
  }

  /// Parameters of the search from a waypoint on, a step apart: nearer to the waypoint if it is
  /// singular, as escapes may be short.
  [[nodiscard]] std::vector<double> search_parameters(const waypoint& from, double step) const {
    std::vector<double> result = {from.u};
    if (is_singular(from)) {
      for (const double part : {1. / 256, 1. / 16}) {
        result.push_back(std::min(from.u + part * step * steps_.length, steps_.stops.back()));
      }
    }
    for (const double stop : steps_.stops) {
      const double begin = result.back();
      if (stop > begin) {
        const int count = int(std::ceil((stop - begin) / (step * steps_.length)));
        for (int i = 1; i < count; ++i) {
          result.push_back(begin + (stop - begin) * i / count);
        }
        result.push_back(stop);
      }
    }
    return result;
  }

  /// Continues to a configuration from the singular one before it: the path back from it is
  /// tracked and reversed, and a self-motion leads to the end of that path.
  [[nodiscard]] bool track_backwards(partial_plan& x, const search_node<Capacity>& to) {
    partial_plan back({to.state, to.u, {}, smallest_singular_value_of(to.state.jacobian)});
    back.step = steps_.options.search_step;
    const double u = x.back().u;
    if (!steps_.track(back, u, steps_.options.search_step, {})) {
      return false;
    }
    for (int round = 0; round < 5 && steps_.error_ratio_between(x.back(), back.back()) > 1;
         ++round) {
      move_to(x, back.back().state.theta);
      move_to(back, x.back().state.theta);
    }
    if (steps_.error_ratio_between(x.back(), back.back()) > 1) {
      return false;
    }
    x.waypoints.insert(x.waypoints.end(), back.waypoints.rbegin(), back.waypoints.rend());
    x.step = steps_.options.search_step;
    return true;
  }

  /// Self-motion to a configuration, or as near to it as possible.
  void move_to(partial_plan& x, const vector& aim) {
    for (double before = std::numeric_limits<double>::infinity();;) {
      const double remaining = norm(aim - x.back().state.theta);
      if (remaining < 1e-9 || !(remaining < .9 * before) ||
          !steps_.track(x, x.back().u, steps_.options.search_step, {&aim})) {
        return;
      }
      before = remaining;
    }
  }

  tracker steps_;
};

template <int Capacity>
typename path_planner<Capacity>::partial_plan path_planner<Capacity>::plan(const vector& start) {
  partial_plan best = steps_.continued(stay(start));
  // Search from the last waypoint; if that fails, from the start.
  for (std::size_t first : {best.waypoints.size() - 1, std::size_t(0)}) {
    if (steps_.is_at_end(best) || steps_.options.search_step == 0) {
      break;
    }
    best = with_search(best, first);
  }
  return best;
}

DUET_ABI_END
} // namespace duet::detail
