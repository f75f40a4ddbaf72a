// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/planning/bounded_step.hpp>
#include <duet/planning/path_step.hpp>
#include <duet/planning/planning_model.hpp>
#include <duet/planning/self_motion_components.hpp>
#include <duet/planning/singularity.hpp>
#include <duet/planning/small_vector.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

/// \file
/// Search for what a chain can reach along a path of its tip if it may also make self-motions.

namespace duet::detail {

/// Collects reachable configurations, parameter by parameter.
///
/// At each parameter the configurations that hold the tip at its pose form curves (one degree of
/// redundancy), cut by the limits. One point of such a component is as good as any other, as the
/// arm can reach it by a self-motion; so the whole component is traced, in steps of `spacing`, and
/// from all its points one step is taken to the next parameter, where those components are traced
/// that are new. With several degrees of redundancy one curve of the manifold is traced, with none
/// a component is a point.
template <int Room>
class self_motion_search : self_motion_components<Room> {
  using base = self_motion_components<Room>;
  using base::follow, base::found_, base::is_known, base::left_, base::solver_, base::spacing_,
      base::tried;

public:
  using typename base::vector;

  /// \param singular  singular value below which configurations are left to both sides, too
  /// \param least     minimum of the shorter steps in which the ends of continuations are sought
  self_motion_search(const pose_solver<Room>& solver, const tip_path& target, double spacing,
                     double singular, double least, int iterations)
      : base(solver, spacing, iterations), target_(target), singular_(singular), least_(least) {}

  /// Sequence of configurations, each a step from the one before.
  using configurations = std::vector<search_node<Room>>;

  /// Continuations from a state at u.front() to u.back(), or as far as they go: one that leads
  /// farthest, the one that does in whole steps, and one to each other isolated component.
  [[nodiscard]] std::vector<configurations> run(const chain_state<Room>& start,
                                                const std::vector<double>& u) {
    found_.push_back({start, u.front(), -1});
    follow(0, target_(u.front()));
    std::size_t first = 0;
    double here = u.front();
    const auto reach = [&](double to) {
      const std::size_t end = found_.size();
      advance(first, end, here, to);
      const bool is_any = found_.size() > end;
      if (is_any) {
        first = end;
        here = to;
      }
      return is_any;
    };
    configurations in_whole_steps;
    for (std::size_t k = 1; k < u.size() && here == u[k - 1]; ++k) {
      double step = u[k] - here;
      for (int round = 0; here < u[k] && round < most_rounds && (round == 0 || step >= least_);
           ++round) {
        farthest_ = {here, first, first};
        // The next parameter, or else as far as one of the configurations gets, or else one nearer
        // than all of that.
        if (reach(step < u[k] - here ? here + step : u[k])) {
          step = u[k] - here;
          continue;
        }
        if (in_whole_steps.empty()) {
          in_whole_steps = way_to(farthest_.from);
        }
        if (farthest_.u >= here + least_ && reach(farthest_.u)) {
          step = u[k] - here;
        } else {
          step /= 1 << halvings;
        }
      }
    }
    const std::size_t best = std::max(first, farthest_.from);
    std::vector<configurations> result{way_to(best)};
    if (!in_whole_steps.empty() && in_whole_steps.back().u < here) {
      result.push_back(in_whole_steps);
    }
    for (std::size_t i = first; i < found_.size(); ++i) {
      if (i != best && found_[i].is_isolated) {
        result.push_back(way_to(i));
      }
    }
    return result;
  }
  [[nodiscard]] int iterations_left() const { return left_; }

private:
  static constexpr int halvings = 6; ///< number of halvings of a step from parameter to parameter
  /// Maximum number of rounds from one to the next: where poses are singular throughout no search
  /// ends by itself.
  static constexpr int most_rounds = 12;

  /// Adds what is reached at one parameter from the configurations found_[first] to found_[end − 1]
  /// at another.
  void advance(std::size_t first, std::size_t end, double u, double to) {
    const tip_pose target = target_(to);
    for (std::size_t i = first; i < end && left_ > 0; ++i) {
      const chain_state<Room> here = found_[i].state;
      const bool is_singular = smallest_singular_value_of(here.jacobian) < singular_;
      const auto add = [&](const step_result<Room>& next) {
        if (next.is_within(solver_.tolerance) && !is_known(next.state.theta, end) &&
            (!is_singular || leads(next.state, to, here, u))) {
          found_.push_back({next.state, to, std::ptrdiff_t(i), is_singular});
          follow(found_.size() - 1, target);
        }
      };
      farthest_.now = i;
      add(go(here, u, to, halvings));
      if (is_singular) {
        leave(here, target, add);
        const std::ptrdiff_t before = found_[i].from;
        if (before >= 0 && found_[std::size_t(before)].u == found_[i].u) {
          leave_between(found_[std::size_t(before)].state, here, target, add);
        }
      }
    }
  }

  [[nodiscard]] configurations way_to(std::size_t last) const {
    configurations result;
    for (auto i = std::ptrdiff_t(last); i >= 0; i = found_[std::size_t(i)].from) {
      result.push_back(found_[std::size_t(i)]);
    }
    std::reverse(result.begin(), result.end());
    return result;
  }

  /// Result of a step to another parameter, in up to 2^`left` parts.
  [[nodiscard]] step_result<Room> go(const chain_state<Room>& from, double u, double to, int left) {
    auto direct = tried(from, target_(to), {});
    const bool is_jump = norm(direct.state.theta - from.theta) > .15;
    if ((direct.is_within(solver_.tolerance) && !is_jump) || left == 0) {
      if (is_jump) {
        direct.left.translation = std::numeric_limits<double>::infinity();
      } else if (direct.is_within(solver_.tolerance) && to > farthest_.u) {
        farthest_ = {to, farthest_.now, farthest_.now};
      }
      return direct;
    }
    const double middle = (u + to) / 2;
    auto half = go(from, u, middle, left - 1);
    return half.is_within(solver_.tolerance) ? go(half.state, middle, to, left - 1) : half;
  }

  /// Adds configurations for a target near that of a singular one, which lie to both sides of it.
  template <class Add>
  void leave(const chain_state<Room>& singular, const tip_pose& target, const Add& add) {
    const singular_point<Room> here(singular.jacobian);
    const small_twist e = error_twist(singular.tip, target);
    const vector out = here.escape_direction();
    const auto [step, other] = here.steps_for(e);
    const double way = norm(e);
    for (const vector& offset :
         {step, other, way * out, -way * out, std::sqrt(way) * out, -std::sqrt(way) * out}) {
      if (!(norm(offset) > 0)) {
        continue;
      }
      vector beside = singular.theta + offset;
      for (std::ptrdiff_t i = 0; i < beside.size(); ++i) {
        beside[i] = std::clamp(beside[i], solver_.lower[i], solver_.upper[i]);
      }
      const auto next = tried(solver_.model.at(beside), target, {});
      if (norm(next.state.theta - singular.theta) < .5) {
        add(next);
      }
    }
  }

  /// Adds a configuration between two neighbours on a component of singular configurations: from
  /// where joint velocities can produce the twist to the target. Beside that Newton's method does
  /// not converge.
  template <class Add>
  void leave_between(chain_state<Room> a, chain_state<Room> b, const tip_pose& target,
                     const Add& add) {
    const tip_pose here = a.tip;
    small_twist w = left_singular_twist(a.jacobian);
    const auto missing = [&](const chain_state<Room>& x) {
      const small_twist next = left_singular_twist(x.jacobian);
      w = dot(next, w) < 0 ? -1 * next : next;
      return dot(w, error_twist(x.tip, target));
    };
    double at_a = missing(a), at_b = missing(b);
    if (!(at_a * at_b < 0)) {
      return;
    }
    for (int round = 0; round < 4 && at_a != at_b; ++round) { // the secant method
      const vector between = a.theta + at_a / (at_a - at_b) * (b.theta - a.theta);
      const auto there = tried(solver_.model.at(between), here, {});
      if (!there.is_within(solver_.tolerance)) {
        return;
      }
      a = b;
      at_a = at_b;
      b = there.state;
      at_b = missing(b);
    }
    add(tried(b, target, {}));
  }

  /// True if the path back leads to the configuration `to`.
  [[nodiscard]] bool leads(const chain_state<Room>& from, double u, const chain_state<Room>& to,
                           double back) {
    const auto end = go(from, u, back, halvings);
    return end.is_within(solver_.tolerance) && norm(end.state.theta - to.theta) < spacing_;
  }

  const tip_path& target_;
  double singular_, least_;
  struct {
    double u = 0;
    std::size_t from = 0, now = 0;
  } farthest_; ///< farthest parameter that was reached, and from which configuration
};

} // namespace duet::detail
