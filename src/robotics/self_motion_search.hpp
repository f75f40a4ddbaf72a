// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "bounded_step.hpp"
#include "path_step.hpp"
#include "planning_model.hpp"
#include "singularity.hpp"
#include "small_vector.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

/// \file
/// Search for the configurations that a chain can reach along a path of its tip with self-motions.

namespace duet::detail {
DUET_ABI_BEGIN

/// Configuration that can be reached, and its predecessor: one at the same parameter, by a
/// self-motion, or one before.
template <int Capacity>
struct search_node {
  chain_state<Capacity> state;
  double u;
  std::ptrdiff_t from;              ///< index of the predecessor, −1 for none
  bool escapes_singularity = false; ///< true if the predecessor is singular, and this one near it
  bool is_isolated = false;         ///< true if it is an isolated component
};

/// Collects configurations, and with each the self-motion component that contains it.
template <int Capacity>
class self_motion_components {
public:
  using vector = small_vector<Capacity>;

  /// \param spacing     joint step from one configuration of a component to the next
  /// \param iterations  maximum number of iterations of Newton's method
  self_motion_components(const pose_solver<Capacity>& solver, double spacing, int iterations)
      : solver_(solver), spacing_(spacing), remaining_iterations_(iterations) {
    for (std::ptrdiff_t i = 0; i < solver.model.size; ++i) {
      is_endless_ = is_endless_ || solver.is_endless(i);
    }
  }

protected:
  [[nodiscard]] step_result<Capacity> tried(const chain_state<Capacity>& from,
                                            const tip_pose& target, const vector& desired_step) {
    auto result = solver_.approach(from, target, desired_step);
    remaining_iterations_ -= result.iterations;
    return result;
  }

  [[nodiscard]] bool is_known(const vector& theta, std::size_t first) const {
    return std::any_of(nodes_.begin() + std::ptrdiff_t(first), nodes_.end(), [&](const auto& x) {
      // Two components that separate at a singularity are near each other at first.
      return is_near(x.state.theta, theta, (x.is_isolated ? 1e-4 : .5) * spacing_ * spacing_);
    });
  }

  /// Adds the component that contains nodes_[start], unless it is larger than a point only because
  /// of the tolerance.
  void follow(std::size_t start, const tip_pose& target) {
    extend(start, target);
    const bool is_isolated =
        std::all_of(nodes_.begin() + std::ptrdiff_t(start), nodes_.end(), [&](const auto& x) {
          return norm(x.state.theta - nodes_[start].state.theta) < .1 * spacing_;
        });
    if (is_isolated) {
      nodes_.erase(nodes_.begin() + std::ptrdiff_t(start) + 1, nodes_.end());
      nodes_[start].is_isolated = true;
    }
  }

  const pose_solver<Capacity>& solver_;
  double spacing_;
  int remaining_iterations_;
  std::vector<search_node<Capacity>> nodes_;

private:
  /// True if near each other except for full turns of joints without limits.
  [[nodiscard]] bool is_near(const vector& a, const vector& b, double square) const {
    const vector difference = a - b;
    const auto square_of = [](const vector& x) { return dot(x, x); };
    return square_of(difference) < square ||
           (is_endless_ && square_of(solver_.modulo_full_turns(difference)) < square);
  }

  /// Adds the configurations on a curve with nodes_[start], alternately in both directions, so that
  /// those nearby come first.
  void extend(std::size_t start, const tip_pose& target) {
    const vector along = self_motion_space(nodes_[start].state.jacobian).any_direction();
    front ends[2] = {{start, along, spacing_}, {start, -1 * along, spacing_}};
    bool is_open[2] = {norm(along) > 0, norm(along) > 0};
    for (int count = 0; (is_open[0] || is_open[1]) && remaining_iterations_ > 0; ++count) {
      const int side = count % 2;
      if (is_open[side]) {
        is_open[side] = extend_by_step(ends[side], target);
        // If the ends meet, the curve is closed.
        if (count > 6 && is_near(nodes_[ends[0].at].state.theta, nodes_[ends[1].at].state.theta,
                                 .64 * spacing_ * spacing_)) {
          return;
        }
      }
    }
  }

  struct front {
    std::size_t at;
    vector direction;
    double step;
  };

  /// Takes one step on; false at the end of the component.
  bool extend_by_step(front& end, const tip_pose& target) {
    const chain_state<Capacity>& current = nodes_[end.at].state;
    // Step length up to the limits.
    double reach = end.step;
    for (std::ptrdiff_t i = 0; i < current.theta.size(); ++i) {
      const double d = end.direction[i];
      if (std::abs(d) > 1e-9) {
        const double bound = d > 0 ? solver_.upper[i] : solver_.lower[i];
        reach = std::min(reach, (bound - current.theta[i]) / d);
      }
    }
    for (; reach > spacing_ / 100; reach /= 2) {
      const auto next = tried(current, target, reach * end.direction);
      const vector displacement = next.state.theta - current.theta;
      if (next.is_within(solver_.tolerance) && norm(displacement) < 2 * reach &&
          dot(displacement, end.direction) > .7 * reach) {
        const vector direction = self_motion_space(next.state.jacobian).direction(end.direction);
        const bool reverses_orientation = orientation(next.state.jacobian, direction) *
                                              orientation(current.jacobian, end.direction) <
                                          0;
        if (dot(direction, end.direction) > .7 &&
            (!reverses_orientation || reach < spacing_ / 50)) {
          nodes_.push_back({next.state, nodes_[end.at].u, std::ptrdiff_t(end.at)});
          end = {nodes_.size() - 1, direction, std::min(spacing_, 2 * reach)};
          return true;
        }
      }
    }
    return false;
  }

  bool is_endless_ = false; ///< true if any joint has no limits
};

/// Collects reachable configurations, parameter by parameter.
///
/// At each parameter the configurations with the tip at its pose form curves (one degree of
/// redundancy), cut by the limits. One point of such a component is as good as any other, as the
/// arm can reach it by a self-motion; so the whole component is traced, in steps of `spacing`, and
/// from all its points one step is taken to the next parameter, where those components are traced
/// that are new. With several degrees of redundancy one curve of the manifold is traced, with none
/// a component is a point.
template <int Capacity>
class self_motion_search : self_motion_components<Capacity> {
  using base = self_motion_components<Capacity>;
  using base::follow, base::nodes_, base::is_known, base::remaining_iterations_, base::solver_,
      base::spacing_, base::tried;

public:
  using typename base::vector;

  /// \param singular  singular value below which configurations on both sides are tried, too
  /// \param min_step     minimum parameter step of the search for the ends of continuations
  self_motion_search(const pose_solver<Capacity>& solver, const tip_path& target, double spacing,
                     double singular, double min_step, int iterations)
      : base(solver, spacing, iterations), target_(target), singular_(singular),
        min_step_(min_step) {}

  /// Sequence of configurations, each a step from the one before.
  using configurations = std::vector<search_node<Capacity>>;

  /// Continuations from a state at u.front() to u.back(), or as far as they go: the one that
  /// gets furthest, the one that gets furthest in full steps, and one to each other isolated
  /// component.
  [[nodiscard]] std::vector<configurations> run(const chain_state<Capacity>& start,
                                                const std::vector<double>& u) {
    nodes_.push_back({start, u.front(), -1});
    follow(0, target_(u.front()));
    std::size_t first = 0;
    double current = u.front();
    const auto reach = [&](double to) {
      const std::size_t end = nodes_.size();
      advance(first, end, current, to);
      const bool is_any = nodes_.size() > end;
      if (is_any) {
        first = end;
        current = to;
      }
      return is_any;
    };
    configurations in_full_steps;
    for (std::size_t k = 1; k < u.size() && current == u[k - 1]; ++k) {
      double step = u[k] - current;
      for (int round = 0; current < u[k] && round < max_rounds && (round == 0 || step >= min_step_);
           ++round) {
        furthest_ = {current, first, first};
        // Try the next parameter, then the furthest that any configuration reaches, then a shorter
        // step.
        if (reach(step < u[k] - current ? current + step : u[k])) {
          step = u[k] - current;
          continue;
        }
        if (in_full_steps.empty()) {
          in_full_steps = configurations_to(furthest_.from);
        }
        if (furthest_.u >= current + min_step_ && reach(furthest_.u)) {
          step = u[k] - current;
        } else {
          step /= 1 << halvings;
        }
      }
    }
    const std::size_t best = std::max(first, furthest_.from);
    std::vector<configurations> result{configurations_to(best)};
    if (!in_full_steps.empty() && in_full_steps.back().u < current) {
      result.push_back(in_full_steps);
    }
    for (std::size_t i = first; i < nodes_.size(); ++i) {
      if (i != best && nodes_[i].is_isolated) {
        result.push_back(configurations_to(i));
      }
    }
    return result;
  }
  [[nodiscard]] int remaining_iterations() const { return remaining_iterations_; }

private:
  static constexpr int halvings = 6; ///< number of halvings of a step from parameter to parameter
  /// Maximum number of rounds from one parameter to the next: if all poses are singular, the search
  /// does not end by itself.
  static constexpr int max_rounds = 12;

  /// Adds the configurations reached at one parameter from the configurations nodes_[first] to
  /// nodes_[end − 1] at another.
  void advance(std::size_t first, std::size_t end, double u, double to) {
    const tip_pose target = target_(to);
    for (std::size_t i = first; i < end && remaining_iterations_ > 0; ++i) {
      const chain_state<Capacity> current = nodes_[i].state;
      const bool is_singular = smallest_singular_value_of(current.jacobian) < singular_;
      const auto add = [&](const step_result<Capacity>& next) {
        if (next.is_within(solver_.tolerance) && !is_known(next.state.theta, end) &&
            (!is_singular || leads(next.state, to, current, u))) {
          nodes_.push_back({next.state, to, std::ptrdiff_t(i), is_singular});
          follow(nodes_.size() - 1, target);
        }
      };
      furthest_.now = i;
      add(move_to_parameter(current, u, to, halvings));
      if (is_singular) {
        leave(current, target, add);
        const std::ptrdiff_t before = nodes_[i].from;
        if (before >= 0 && nodes_[std::size_t(before)].u == nodes_[i].u) {
          leave_between(nodes_[std::size_t(before)].state, current, target, add);
        }
      }
    }
  }

  [[nodiscard]] configurations configurations_to(std::size_t last) const {
    configurations result;
    for (auto i = std::ptrdiff_t(last); i >= 0; i = nodes_[std::size_t(i)].from) {
      result.push_back(nodes_[std::size_t(i)]);
    }
    std::reverse(result.begin(), result.end());
    return result;
  }

  /// Result of a step to another parameter, in up to 2^`remaining_halvings` parts.
  [[nodiscard]] step_result<Capacity> move_to_parameter(const chain_state<Capacity>& from, double u,
                                                        double to, int remaining_halvings) {
    auto direct = tried(from, target_(to), {});
    const bool is_jump = norm(direct.state.theta - from.theta) > .15;
    if ((direct.is_within(solver_.tolerance) && !is_jump) || remaining_halvings == 0) {
      if (is_jump) {
        direct.residual.translation = std::numeric_limits<double>::infinity();
      } else if (direct.is_within(solver_.tolerance) && to > furthest_.u) {
        furthest_ = {to, furthest_.now, furthest_.now};
      }
      return direct;
    }
    const double midpoint = (u + to) / 2;
    auto half = move_to_parameter(from, u, midpoint, remaining_halvings - 1);
    return half.is_within(solver_.tolerance)
               ? move_to_parameter(half.state, midpoint, to, remaining_halvings - 1)
               : half;
  }

  /// Adds configurations on both sides of a singular one, for a target near its pose.
  template <class Add>
  void leave(const chain_state<Capacity>& singular, const tip_pose& target, const Add& add) {
    const singular_point<Capacity> current(singular.jacobian);
    const small_twist e = error_twist(singular.tip, target);
    const vector escape = current.escape_direction();
    const auto [step, other] = current.steps_for(e);
    const double size = norm(e);
    for (const vector& offset : {step, other, size * escape, -size * escape,
                                 std::sqrt(size) * escape, -std::sqrt(size) * escape}) {
      if (!(norm(offset) > 0)) {
        continue;
      }
      vector guess = singular.theta + offset;
      for (std::ptrdiff_t i = 0; i < guess.size(); ++i) {
        guess[i] = std::clamp(guess[i], solver_.lower[i], solver_.upper[i]);
      }
      const auto next = tried(solver_.model.at(guess), target, {});
      if (norm(next.state.theta - singular.theta) < .5) {
        add(next);
      }
    }
  }

  /// Adds a configuration reached from between two neighbours on a component of singular
  /// configurations, from where joint velocities can produce the twist to the target. Newton's
  /// method does not converge from other configurations nearby.
  template <class Add>
  void leave_between(chain_state<Capacity> a, chain_state<Capacity> b, const tip_pose& target,
                     const Add& add) {
    const tip_pose current = a.tip;
    small_twist w = left_singular_twist(a.jacobian);
    const auto residual = [&](const chain_state<Capacity>& x) {
      const small_twist next = left_singular_twist(x.jacobian);
      w = dot(next, w) < 0 ? -1 * next : next;
      return dot(w, error_twist(x.tip, target));
    };
    double at_a = residual(a), at_b = residual(b);
    if (!(at_a * at_b < 0)) {
      return;
    }
    for (int round = 0; round < 4 && at_a != at_b; ++round) { // the secant method
      const vector between = a.theta + at_a / (at_a - at_b) * (b.theta - a.theta);
      const auto corrected = tried(solver_.model.at(between), current, {});
      if (!corrected.is_within(solver_.tolerance)) {
        return;
      }
      a = b;
      at_a = at_b;
      b = corrected.state;
      at_b = residual(b);
    }
    add(tried(b, target, {}));
  }

  /// True if the path back leads to the configuration `to`.
  [[nodiscard]] bool leads(const chain_state<Capacity>& from, double u,
                           const chain_state<Capacity>& to, double back) {
    const auto end = move_to_parameter(from, u, back, halvings);
    return end.is_within(solver_.tolerance) && norm(end.state.theta - to.theta) < spacing_;
  }

  const tip_path& target_;
  double singular_, min_step_;
  struct {
    double u = 0;
    std::size_t from = 0, now = 0;
  } furthest_; ///< furthest parameter reached, and the configurations from which
};

DUET_ABI_END
} // namespace duet::detail
