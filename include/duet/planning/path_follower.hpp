// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/path_step.hpp>
#include <duet/planning/planning_model.hpp>
#include <duet/planning/self_motion_search.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

/// \file
/// The planner behind `follow_path` and `plan_screw_motion`.

namespace duet::detail {

/// Plans along a path, first without stopping; where that comes to an end, with motions in place.
template <int Room>
class path_follower {
public:
  using vector = small_vector<Room>;
  /// The gradient of what the joints are to lower.
  using slope_function = std::function<vector(const vector&)>;
  struct waypoint {
    chain_state<Room> state;
    double u;
    pose_deviation left = {};
    /// Of the Jacobians on the way to it, as planners count lengths.
    double smallest_singular_value = std::numeric_limits<double>::infinity();
  };
  struct route {
    std::vector<waypoint> waypoints;
    double step = .01; ///< the next one, of the path

    explicit route(const waypoint& start) : waypoints{start} {}
    [[nodiscard]] const waypoint& back() const { return waypoints.back(); }
  };

  /// \param target  the tip's pose
  /// \param stops   parameters that become waypoints, increasing; the first and the last are the
  ///                ends of the path
  /// \param slope   or nothing
  path_follower(const planning_model<Room>& model, const place_function& target,
                std::vector<double> stops, const plan_options& options, const slope_function& slope)
      : solver_{model, model.tolerance(options.tolerance)},
        deviation_(model.tolerance(options.deviation)), target_(target), stops_(std::move(stops)),
        options_(options), slope_(slope), length_(stops_.back() - stops_.front()),
        iterations_left_(options.iterations) {}

  [[nodiscard]] route plan(const vector& start);

  /// Nothing but the start.
  [[nodiscard]] route stay(const vector& start) const {
    return route({solver_.model.at(start), stops_.front()});
  }

  /// Why it ends: what is in the way of the first step that fails, of some that grow.
  [[nodiscard]] stop_reason reason(const route& x) const {
    if (is_at_end(x) || iterations_left_ <= 0) {
      return is_at_end(x) ? stop_reason::reached : stop_reason::iteration_limit;
    }
    const waypoint& here = x.back();
    for (double step = options_.smallest_step; step < 1; step *= 2) {
      const double u = std::min(here.u + step * length_, stops_.back());
      const auto there = solver_.approach(here.state, target_(u), {});
      if (there.is_within(solver_.tolerance)) {
        continue;
      }
      const bool is_near_singularity = there.smallest_singular_value < 10 * damping_threshold;
      return there.is_blocked || there.shortfall > solver_.tolerance.length ? stop_reason::obstacle
             : (there.is_bounded || is_near_singularity) && is_stopped_by_limits(x, u)
                 ? stop_reason::joint_limit
             : is_near_singularity ? stop_reason::singular
                                   : stop_reason::no_progress;
    }
    return stop_reason::no_progress;
  }
  [[nodiscard]] int iterations() const { return options_.iterations - iterations_left_; }

private:
  /// Does the way lead beyond a parameter without limits?
  [[nodiscard]] bool is_stopped_by_limits(const route& x, double u) const {
    constexpr int enough = 100000;
    path_follower free = *this;
    free.iterations_left_ = enough;
    free.solver_.without_limits();
    const double beyond = std::min(u + 4 * (u - x.back().u), stops_.back());
    free.stops_ = {stops_.front(), beyond};
    if (free.is_at_end(free.undamped(route(x.back())))) {
      return true;
    }
    route before = x;
    while (before.waypoints.size() > 1) {
      before = before_singularity(before);
      if (free.is_at_end(free.undamped(before))) {
        return true;
      }
    }
    return false;
  }
  [[nodiscard]] static bool is_singular(const waypoint& x) {
    return smallest_singular_value_of(x.state.jacobian) < damping_threshold;
  }

  [[nodiscard]] bool is_at_end(const route& x) const { return x.back().u == stops_.back(); }

  /// What joints do with the freedom that the tip leaves them.
  struct wishes {
    const vector* aim = nullptr; ///< where they should be at the end
    bool lowers = false;         ///< do they lower the objectives?
  };

  /// As far as possible without stopping.
  void go_on(route& x) {
    for (const double stop : stops_) {
      if (stop > x.back().u && !travel(x, stop, (stop - x.back().u) / length_, {.lowers = true})) {
        return;
      }
    }
  }

  /// What lowers the objectives.
  [[nodiscard]] vector downhill(const vector& theta, double step) const {
    const vector centre =
        towards_middle(theta, solver_.model.lower, solver_.model.upper, options_.centring * step);
    return slope_ ? centre - step * slope_(theta) : centre;
  }

  /// As far as possible without motions in place.
  [[nodiscard]] route continued(route best) {
    go_on(best);
    for (route before = best; before.waypoints.size() > 1 && !is_at_end(best);) {
      before = before_singularity(before);
      keep_better(best, undamped(before));
    }
    return best;
  }
  static void keep_better(route& best, route other) {
    if (other.back().u > best.back().u) {
      best = std::move(other);
    }
  }

  /// A better route with motions in place, from a waypoint of one, or that one.
  [[nodiscard]] route with_search(const route& before, std::size_t first) {
    route begin(before.waypoints.front());
    begin.waypoints.assign(before.waypoints.begin(),
                           before.waypoints.begin() + std::ptrdiff_t(first) + 1);
    self_motion_search search(solver_, target_, options_.self_motion_step, iterations_left_);
    const auto ways = search.run(begin.back().state, search_parameters(begin.back()));
    iterations_left_ = search.iterations_left();
    route best = before;
    for (const auto& way : ways) {
      if (!is_at_end(best)) {
        keep_better(best, along(begin, way));
      }
    }
    return best;
  }

  /// On along a way that a search has found, and beyond.
  [[nodiscard]] route along(route x, const typename self_motion_search<Room>::way& way) {
    for (std::size_t i = 1; i < way.size(); ++i) {
      const std::size_t kept = x.waypoints.size();
      const auto go = [&](bool is_back) {
        x.step = options_.search_step;
        return is_back ? travel_back(x, way[i])
                       : travel(x, way[i].u, options_.search_step, {&way[i].state.theta});
      };
      if (!go(way[i].is_way_out)) {
        x.waypoints.erase(x.waypoints.begin() + std::ptrdiff_t(kept), x.waypoints.end());
        if (!go(!way[i].is_way_out)) {
          return x;
        }
      }
    }
    return continued(std::move(x));
  }

  /// From a waypoint on, where the search looks: nearer to it where it is singular, as ways out may
  /// be short.
  [[nodiscard]] std::vector<double> search_parameters(const waypoint& from) const {
    std::vector<double> result = {from.u};
    if (is_singular(from)) {
      for (const double part : {1. / 256, 1. / 16}) {
        result.push_back(std::min(from.u + part * options_.search_step * length_, stops_.back()));
      }
    }
    for (const double stop : stops_) {
      const double begin = result.back();
      if (stop > begin) {
        const int count = int(std::ceil((stop - begin) / (options_.search_step * length_)));
        for (int i = 1; i < count; ++i) {
          result.push_back(begin + (stop - begin) * i / count);
        }
        result.push_back(stop);
      }
    }
    return result;
  }

  /// On to a configuration from the singular one before it: the way back from there leads to it,
  /// and the joints get to where that ends in place.
  [[nodiscard]] bool travel_back(route& x, const reachable<Room>& to) {
    route back({to.state, to.u});
    back.step = options_.search_step;
    const double u = x.back().u;
    if (!travel(back, u, options_.search_step, {}) || !arrive(x, back.back().state.theta) ||
        excess_between(x.back(), back.back()) > 1) {
      return false;
    }
    x.waypoints.insert(x.waypoints.end(), back.waypoints.rbegin(), back.waypoints.rend());
    x.step = options_.search_step;
    return true;
  }

  /// In place, to a configuration or as near to it as the joints get.
  [[nodiscard]] bool arrive(route& x, const vector& aim) {
    for (double before = std::numeric_limits<double>::infinity();;) {
      const double left = norm(aim - x.back().state.theta);
      if (left < 1e-9 || !(left < .9 * before)) {
        return true;
      }
      before = left;
      if (!travel(x, x.back().u, options_.search_step, {&aim})) {
        return false;
      }
    }
  }

  /// How many times the deviation is the tip off the path half way between two waypoints?
  [[nodiscard]] double excess_between(const waypoint& a, const waypoint& b) const {
    const vector middle = .5 * (a.state.theta + b.state.theta);
    const pose_deviation half_way =
        deviation_between(solver_.model.at(middle).tip, target_((a.u + b.u) / 2));
    return std::max(deviation_.times(half_way),
                    solver_.model.shortfall(middle) / deviation_.length);
  }

  /// Do the joints move far in a step along the path that is as short as that?
  [[nodiscard]] bool is_swinging(const waypoint& at, double step) const {
    constexpr double least = 1e-12;
    return solver_.damped_below == undamped_threshold && step > least &&
           solver_.way_to(at.state, target_(std::min(at.u + step * length_, stops_.back()))) >
               least_swing;
  }

  /// As far as where a route last came near a singularity, if it did.
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

  /// On without damping and nearer to the path: beside singularities joints that are to swing would
  /// lag behind.
  [[nodiscard]] route undamped(route x) {
    const pose_solver<Room> damped = solver_;
    solver_.damped_below = undamped_threshold;
    solver_.tolerance = {1e-3 * damped.tolerance.length, 1e-3 * damped.tolerance.angle};
    x.step = options_.smallest_step;
    go_on(x);
    solver_.damped_below = damped.damped_below;
    solver_.tolerance = damped.tolerance;
    return x;
  }

  /// On to the parameter `end`, in steps that keep the tip near the path between waypoints too.
  ///
  /// \param part  how much of the path that counts for
  /// \return false where there is no going on
  [[nodiscard]] bool travel(route& x, double end, double part, const wishes& have) {
    const double begin = x.back().u;
    double way = 0; // 1 at the end
    while (way < 1) {
      const waypoint& here = x.back();
      const double next = way + x.step / part > 1 - 1e-9 ? 1 : way + x.step / part;
      const double u = next == 1 ? end : begin + (end - begin) * next;
      const vector& theta = here.state.theta;
      const vector wish = have.aim != nullptr ? (next - way) / (1 - way) * (*have.aim - theta)
                          : have.lowers       ? downhill(theta, (next - way) * part)
                                              : vector{};
      auto there = solver_.approach(here.state, target_(u), wish);
      iterations_left_ -= there.iterations;
      if (have.lowers && there.smallest_singular_value < damping_threshold) {
        // A wish takes the joints to where the path leads no further.
        there = solver_.approach(here.state, target_(u), {});
        iterations_left_ -= there.iterations;
      }
      double change = .25;
      if (there.is_within(solver_.tolerance)) {
        const waypoint on{there.state, u, there.left, there.smallest_singular_value};
        const double excess = excess_between(here, on);
        // Between waypoints the deviation grows with the square of the step.
        change = std::clamp(.85 / std::sqrt(std::max(excess, 1e-12)), .2, 2.0);
        if (x.step < options_.smallest_step && norm(there.state.theta - theta) < least_swing) {
          change = .25;             // within tolerance of two parameters, but no way on
        } else if (excess <= .95) { // half way is not quite where it is largest
          way = next;
          x.waypoints.push_back(on);
        }
      }
      x.step = std::min(options_.largest_step, x.step * change);
      if (way < 1 && (iterations_left_ <= 0 ||
                      (x.step < options_.smallest_step && !is_swinging(x.back(), x.step)))) {
        return false;
      }
    }
    return true;
  }

  static constexpr double least_swing = 1e-3;
  pose_solver<Room> solver_;
  pose_tolerance deviation_;
  const place_function& target_;
  std::vector<double> stops_;
  plan_options options_;
  const slope_function& slope_;
  double length_;
  int iterations_left_;
};

template <int Room>
typename path_follower<Room>::route path_follower<Room>::plan(const vector& start) {
  route best = continued(stay(start));
  // From where it got stuck, or else from the beginning.
  for (std::size_t first : {best.waypoints.size() - 1, std::size_t(0)}) {
    if (is_at_end(best) || options_.search_step == 0) {
      break;
    }
    best = with_search(best, first);
  }
  return best;
}

#ifdef DUET_COMPILED
DUET_COMPILED_TEMPLATE class path_follower<8>;
DUET_COMPILED_TEMPLATE class path_follower<16>;
#endif

} // namespace duet::detail
