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
    double smallest_singular_value = std::numeric_limits<double>::infinity();
  };
  struct route {
    std::vector<waypoint> waypoints;
    double step = .01; ///< the next one, of the path
    stop_reason reason = stop_reason::no_progress;

    explicit route(const waypoint& start) : waypoints{start} {}
    [[nodiscard]] const waypoint& back() const { return waypoints.back(); }
  };

  /// \param target  the tip's pose
  /// \param stops   parameters that become waypoints, increasing; the first and the last are the
  ///                ends of the path
  /// \param slope   or nothing
  path_follower(const planning_model<Room>& model, const path_function& target,
                std::vector<double> stops, const plan_options& options, const slope_function& slope)
      : solver_{model, options.tolerance}, target_(target), stops_(std::move(stops)),
        options_(options), slope_(slope), length_(stops_.back() - stops_.front()),
        iterations_left_(options.iterations) {}

  [[nodiscard]] route plan(const vector& start);

  /// Nothing but the start.
  [[nodiscard]] route stay(const vector& start, stop_reason why) const {
    route x({solver_.model.at(start), stops_.front()});
    x.reason = why;
    return x;
  }

  /// Why it ends.
  [[nodiscard]] stop_reason reason(const route& x) const {
    return is_at_end(x)            ? stop_reason::reached
           : iterations_left_ <= 0 ? stop_reason::iteration_limit
                                   : x.reason;
  }
  [[nodiscard]] int iterations() const { return options_.iterations - iterations_left_; }

private:
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

  /// A route with motions in place, from a waypoint of another one.
  [[nodiscard]] route with_search(const route& before, std::size_t first) {
    route result(before.waypoints.front());
    result.waypoints.assign(before.waypoints.begin(),
                            before.waypoints.begin() + std::ptrdiff_t(first) + 1);
    result.reason = before.reason;
    self_motion_search search(solver_, target_, options_.self_motion_step, iterations_left_);
    const auto way = search.run(result.back().state, search_parameters(result.back().u));
    iterations_left_ = search.iterations_left();
    for (std::size_t i = 1; i < way.size(); ++i) {
      result.step = options_.search_step;
      const vector& aim = way[i].state.theta;
      const bool is_ahead =
          !way[i].is_way_out && travel(result, way[i].u, options_.search_step, {&aim});
      if (!is_ahead && !travel_back(result, way[i])) {
        return result;
      }
    }
    go_on(result);
    return result;
  }

  /// From u on, where the search looks.
  [[nodiscard]] std::vector<double> search_parameters(double u) const {
    std::vector<double> result = {u};
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
    if (!travel(back, u, options_.search_step, {})) {
      x.reason = back.reason;
      return false;
    }
    if (!arrive(x, back.back().state.theta)) {
      return false;
    }
    if (excess_between(x.back(), back.back()) > 1) {
      x.reason = stop_reason::singular;
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
        deviation_between(solver_.model.at(middle).tip, place_of(target_((a.u + b.u) / 2)));
    return std::max(options_.deviation.times(half_way),
                    solver_.model.shortfall(middle) / options_.deviation.length);
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
      auto there = solver_.approach(here.state, place_of(target_(u)), wish);
      iterations_left_ -= there.iterations;
      if (have.lowers && there.smallest_singular_value < damping_threshold) {
        // A wish takes the joints to where the path leads no further.
        there = solver_.approach(here.state, place_of(target_(u)), {});
        iterations_left_ -= there.iterations;
      }
      double change = .25;
      if (there.is_within(options_.tolerance)) {
        const waypoint on{there.state, u, there.left, there.smallest_singular_value};
        const double excess = excess_between(here, on);
        // Between waypoints the deviation grows with the square of the step.
        change = std::clamp(.85 / std::sqrt(std::max(excess, 1e-12)), .2, 2.0);
        if (excess <= .95) { // half way is not quite where it is largest
          way = next;
          x.waypoints.push_back(on);
        }
      }
      x.step = std::min(options_.largest_step, x.step * change);
      if (way < 1 && (iterations_left_ <= 0 || x.step < options_.smallest_step)) {
        x.reason = iterations_left_ <= 0 ? stop_reason::iteration_limit
                   : there.is_blocked || there.shortfall > options_.tolerance.length
                       ? stop_reason::obstacle
                   : there.is_bounded ? stop_reason::joint_limit
                   : there.smallest_singular_value < 10 * damping_threshold
                       ? stop_reason::singular
                       : stop_reason::no_progress;
        return false;
      }
    }
    return true;
  }

  pose_solver<Room> solver_;
  const path_function& target_;
  std::vector<double> stops_;
  plan_options options_;
  const slope_function& slope_;
  double length_;
  int iterations_left_;
};

template <int Room>
typename path_follower<Room>::route path_follower<Room>::plan(const vector& start) {
  route best = stay(start, stop_reason::no_progress);
  go_on(best);
  // From where it got stuck, or else from the beginning.
  for (std::size_t first : {best.waypoints.size() - 1, std::size_t(0)}) {
    if (is_at_end(best) || options_.search_step == 0) {
      break;
    }
    route other = with_search(best, first);
    if (other.back().u > best.back().u) {
      best = std::move(other);
    }
  }
  return best;
}

#ifdef DUET_COMPILED
DUET_COMPILED_TEMPLATE class path_follower<8>;
DUET_COMPILED_TEMPLATE class path_follower<16>;
#endif

} // namespace duet::detail
