// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/path_step.hpp>
#include <duet/planning/path_tracker.hpp>
#include <duet/planning/planning_model.hpp>
#include <duet/planning/self_motion_search.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

/// \file
/// Planner behind `follow_path` and `plan_screw_motion`.

namespace duet::detail {

/// Planner along a path, first without stopping; if that ends early, with self-motions.
template <int Room>
class path_planner {
public:
  using traveller = path_tracker<Room>;
  using vector = typename traveller::vector;
  using waypoint = typename traveller::waypoint;
  using route = typename traveller::route;

  /// Arguments as in `path_tracker`.
  path_planner(const planning_model<Room>& model, const tip_path& target, std::vector<double> stops,
               const plan_options& options, const typename traveller::slope_function& slope)
      : steps_(model, target, std::move(stops), options, slope) {}

  [[nodiscard]] route plan(const vector& start);
  /// Route that consists of the start alone.
  [[nodiscard]] route stay(const vector& start) const { return steps_.stay(start); }
  [[nodiscard]] int iterations() const {
    return steps_.options.max_iterations - steps_.iterations_left;
  }

  /// Termination reason: what blocks the first step that fails, of some that grow.
  [[nodiscard]] stop_reason reason(const route& x) const {
    if (steps_.is_at_end(x) || steps_.iterations_left <= 0) {
      return steps_.is_at_end(x) ? stop_reason::reached : stop_reason::iteration_limit;
    }
    const waypoint& here = x.back();
    for (double step = steps_.options.smallest_step; step < 1; step *= 2) {
      const double u = std::min(here.u + step * steps_.length, steps_.stops.back());
      const auto there = steps_.solver.approach(here.state, steps_.target(u), {});
      if (there.is_within(steps_.solver.tolerance)) {
        continue;
      }
      const bool is_near_singularity = there.smallest_singular_value < 10 * damping_threshold;
      return there.is_blocked || there.shortfall > steps_.solver.tolerance.translation
                 ? stop_reason::obstacle
             : (there.is_bounded || is_near_singularity) && is_stopped_by_limits(x, u)
                 ? stop_reason::joint_limit
             : is_near_singularity ? stop_reason::singular
                                   : stop_reason::no_progress;
    }
    return stop_reason::no_progress;
  }

private:
  /// True if limits end the route: without them it leads beyond a parameter, from the end or from
  /// before the singularity there, if need be by a self-motion; or it leaves them on its path
  /// through that, if the arm is not redundant.
  [[nodiscard]] bool is_stopped_by_limits(const route& x, double u) const {
    constexpr int enough = 100000;
    traveller free = steps_;
    free.iterations_left = enough;
    free.solver.without_limits();
    const double beyond = std::min(u + 4 * (u - x.back().u), steps_.stops.back());
    free.stops = {steps_.stops.front(), beyond};
    route end = free.undamped(route(x.back()));
    if (!free.is_at_end(end) && x.back().smallest_singular_value < damping_threshold) {
      end = free.undamped(steps_.before_singularity(x));
    }
    return free.is_at_end(end) || continues_after_self_motion(free, end.back(), beyond) ||
           (steps_.solver.model.size <= 6 &&
            !steps_.solver.is_within_limits(end.back().state.theta));
  }
  [[nodiscard]] static bool continues_after_self_motion(traveller free, const waypoint& from,
                                                        double to) {
    free.solver.without_damping();
    self_motion_search search(free.solver, free.target, free.options.self_motion_step,
                              damping_threshold, to - from.u, free.iterations_left);
    return free.options.search_step > 0 &&
           search.run(from.state, {from.u, to}).front().back().u == to;
  }
  [[nodiscard]] static bool is_singular(const waypoint& x) {
    return smallest_singular_value_of(x.state.jacobian) < damping_threshold;
  }

  /// Better route with self-motions, from a waypoint of one, or that one.
  [[nodiscard]] route with_search(const route& before, std::size_t first) {
    route begin(before.waypoints.front());
    begin.waypoints.assign(before.waypoints.begin(),
                           before.waypoints.begin() + std::ptrdiff_t(first) + 1);
    route best = before;
    const double whole = steps_.options.search_step, enough = end_resolution();
    // Continuations near a singularity may lead across it where the tip cannot follow; then search
    // for those that do not. Or they pass it so near that joints get to its other side; then search
    // with shorter steps.
    for (const auto& [singular, step] :
         {std::pair(damping_threshold, whole), std::pair(singularity_threshold, whole),
          std::pair(damping_threshold, whole / 4), std::pair(damping_threshold, whole / 16)}) {
      self_motion_search search(steps_.solver, steps_.target, steps_.options.self_motion_step,
                                singular, enough, steps_.iterations_left);
      const auto ways = search.run(begin.back().state, search_parameters(begin.back(), step));
      steps_.iterations_left = search.iterations_left();
      for (const auto& way : ways) {
        if (!steps_.is_at_end(best)) {
          steps_.keep_furthest(best, along(begin, way));
        }
      }
      if (best.back().u + enough >= ways.front().back().u) {
        break;
      }
    }
    return best;
  }
  /// Parameter distance from its end to which a continuation is followed.
  [[nodiscard]] double end_resolution() const {
    return 100 * steps_.options.smallest_step * steps_.length;
  }

  /// Route along a continuation that a search has found, and beyond.
  [[nodiscard]] route along(route x, const typename self_motion_search<Room>::configurations& way) {
    for (std::size_t i = 1; i < way.size(); ++i) {
      const std::size_t kept = x.waypoints.size();
      const auto go = [&](bool is_back) {
        x.step = steps_.options.search_step;
        return is_back
                   ? track_backwards(x, way[i])
                   : steps_.track(x, way[i].u, steps_.options.search_step, {&way[i].state.theta});
      };
      if (!go(way[i].escapes_singularity)) {
        x.waypoints.erase(x.waypoints.begin() + std::ptrdiff_t(kept), x.waypoints.end());
        if (!go(!way[i].escapes_singularity)) {
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

  /// Continues to a configuration from the singular one before it: the path back from there is
  /// tracked and reversed, and a self-motion leads to where it ends.
  [[nodiscard]] bool track_backwards(route& x, const search_node<Room>& to) {
    route back({to.state, to.u, {}, smallest_singular_value_of(to.state.jacobian)});
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

  /// Self-motion to a configuration, or as near to it as the joints get.
  void move_to(route& x, const vector& aim) {
    for (double before = std::numeric_limits<double>::infinity();;) {
      const double left = norm(aim - x.back().state.theta);
      if (left < 1e-9 || !(left < .9 * before) ||
          !steps_.track(x, x.back().u, steps_.options.search_step, {&aim})) {
        return;
      }
      before = left;
    }
  }

  traveller steps_;
};

template <int Room>
typename path_planner<Room>::route path_planner<Room>::plan(const vector& start) {
  route best = steps_.continued(stay(start));
  // Search from where it got stuck, or else from the beginning, and there as far as possible.
  for (std::size_t first : {best.waypoints.size() - 1, std::size_t(0)}) {
    if (steps_.is_at_end(best) || steps_.options.search_step == 0) {
      break;
    }
    best = with_search(best, first);
  }
  return best;
}

#ifdef DUET_COMPILED
DUET_COMPILED_TEMPLATE class path_planner<8>;
DUET_COMPILED_TEMPLATE class path_planner<16>;
#endif

} // namespace duet::detail
