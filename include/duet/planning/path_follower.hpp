// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/path_step.hpp>
#include <duet/planning/path_traveller.hpp>
#include <duet/planning/planning_model.hpp>
#include <duet/planning/self_motion_search.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

/// \file
/// The planner behind `follow_path` and `plan_screw_motion`.

namespace duet::detail {

/// Plans along a path, first without stopping; where that comes to an end, with motions in place.
template <int Room>
class path_follower : public path_traveller<Room> {
  using base = path_traveller<Room>;

public:
  using base::base;
  using base::stay;
  using typename base::route;
  using typename base::vector;
  using typename base::waypoint;

  [[nodiscard]] route plan(const vector& start);

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

private:
  using base::before_singularity;
  using base::continued;
  using base::excess_between;
  using base::is_at_end;
  using base::iterations_left_;
  using base::keep_better;
  using base::length_;
  using base::options_;
  using base::solver_;
  using base::stops_;
  using base::target_;
  using base::travel;
  using base::undamped;

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

  /// A better route with motions in place, from a waypoint of one, or that one.
  [[nodiscard]] route with_search(const route& before, std::size_t first) {
    route begin(before.waypoints.front());
    begin.waypoints.assign(before.waypoints.begin(),
                           before.waypoints.begin() + std::ptrdiff_t(first) + 1);
    route best = before;
    // Ways beside a singularity may lead over it where the tip cannot go: then those that do not.
    for (const double singular : {damping_threshold, no_singular_value}) {
      self_motion_search search(solver_, target_, options_.self_motion_step, singular,
                                iterations_left_);
      const auto ways = search.run(begin.back().state, search_parameters(begin.back()));
      iterations_left_ = search.iterations_left();
      for (const auto& way : ways) {
        if (!is_at_end(best)) {
          keep_better(best, along(begin, way));
        }
      }
      if (best.back().u >= ways.front().back().u) {
        break;
      }
    }
    return best;
  }

  /// On along a way that a search has found, and beyond.
  [[nodiscard]] route along(route x, const typename self_motion_search<Room>::configurations& way) {
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
    if (!travel(back, u, options_.search_step, {})) {
      return false;
    }
    for (int round = 0; round < 5 && excess_between(x.back(), back.back()) > 1; ++round) {
      arrive(x, back.back().state.theta);
      arrive(back, x.back().state.theta);
    }
    if (excess_between(x.back(), back.back()) > 1) {
      return false;
    }
    x.waypoints.insert(x.waypoints.end(), back.waypoints.rbegin(), back.waypoints.rend());
    x.step = options_.search_step;
    return true;
  }

  /// In place, to a configuration or as near to it as the joints get.
  void arrive(route& x, const vector& aim) {
    for (double before = std::numeric_limits<double>::infinity();;) {
      const double left = norm(aim - x.back().state.theta);
      if (left < 1e-9 || !(left < .9 * before) ||
          !travel(x, x.back().u, options_.search_step, {&aim})) {
        return;
      }
      before = left;
    }
  }
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
