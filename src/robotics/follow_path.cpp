// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "bounded_step.hpp"
#include "path_step.hpp"
#include "planning_model.hpp"

#include <duet/core/errors.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/robotics/follow_path.hpp>
#include <duet/robotics/plan_screw_motion.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace duet::detail {
namespace {

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

/// Collects reachable configurations, parameter by parameter.
///
/// At each parameter the configurations with the tip at its pose form curves (one degree of
/// redundancy), cut by the limits. One point of such a component is as good as any other, as the
/// arm can reach it by a self-motion; so the whole component is traced, in steps of `spacing`, and
/// from all its points one step is taken to the next parameter, where those components are traced
/// that are new. With several degrees of redundancy one curve of the manifold is traced, with none
/// a component is a point.
template <int Capacity>
class self_motion_search {
public:
  using vector = small_vector<Capacity>;

  /// \param spacing     joint step from one configuration of a component to the next
  /// \param singular    singular value below which configurations on both sides are tried, too
  /// \param min_step    minimum parameter step of the search for the ends of continuations
  /// \param iterations  maximum number of iterations of Newton's method
  self_motion_search(const pose_solver<Capacity>& solver, const tip_path& target, double spacing,
                     double singular, double min_step, int iterations)
      : solver_(solver), target_(target), spacing_(spacing), singular_(singular),
        min_step_(min_step), remaining_iterations_(iterations) {
    for (Eigen::Index i = 0; i < solver.model.size; ++i) {
      is_endless_ = is_endless_ || solver.is_endless(i);
    }
  }

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
    auto direct = tried(from, target_(to), vector::Zero());
    const bool is_jump = (direct.state.theta - from.theta).norm() > .15;
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
  void leave(const chain_state<Capacity>& singular, const tip_pose& target, const auto& add) {
    const singular_point<Capacity> current(singular.jacobian);
    const small_twist e = error_twist(singular.tip, target);
    const vector escape = current.escape_direction();
    const auto [step, other] = current.steps_for(e);
    const double size = e.norm();
    for (const vector& offset :
         {step, other, vector(size * escape), vector(-size * escape),
          vector(std::sqrt(size) * escape), vector(-std::sqrt(size) * escape)}) {
      if (!(offset.norm() > 0)) {
        continue;
      }
      const vector guess =
          (singular.theta + offset).cwiseMax(solver_.lower).cwiseMin(solver_.upper);
      const auto next = tried(solver_.model.at(guess), target, vector::Zero());
      if ((next.state.theta - singular.theta).norm() < .5) {
        add(next);
      }
    }
  }

  /// Adds a configuration reached from between two neighbours on a component of singular
  /// configurations, from where joint velocities can produce the twist to the target. Newton's
  /// method does not converge from other configurations nearby.
  void leave_between(chain_state<Capacity> a, chain_state<Capacity> b, const tip_pose& target,
                     const auto& add) {
    const tip_pose current = a.tip;
    small_twist w = left_singular_twist(a.jacobian);
    const auto residual = [&](const chain_state<Capacity>& x) {
      const small_twist next = left_singular_twist(x.jacobian);
      w = next.dot(w) < 0 ? small_twist(-next) : next;
      return w.dot(error_twist(x.tip, target));
    };
    double at_a = residual(a), at_b = residual(b);
    if (!(at_a * at_b < 0)) {
      return;
    }
    for (int round = 0; round < 4 && at_a != at_b; ++round) { // the secant method
      const vector between = a.theta + at_a / (at_a - at_b) * (b.theta - a.theta);
      const auto corrected = tried(solver_.model.at(between), current, vector::Zero());
      if (!corrected.is_within(solver_.tolerance)) {
        return;
      }
      a = b;
      at_a = at_b;
      b = corrected.state;
      at_b = residual(b);
    }
    add(tried(b, target, vector::Zero()));
  }

  /// True if the path back leads to the configuration `to`.
  [[nodiscard]] bool leads(const chain_state<Capacity>& from, double u,
                           const chain_state<Capacity>& to, double back) {
    const auto end = move_to_parameter(from, u, back, halvings);
    return end.is_within(solver_.tolerance) && (end.state.theta - to.theta).norm() < spacing_;
  }

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
          return (x.state.theta - nodes_[start].state.theta).norm() < .1 * spacing_;
        });
    if (is_isolated) {
      nodes_.erase(nodes_.begin() + std::ptrdiff_t(start) + 1, nodes_.end());
      nodes_[start].is_isolated = true;
    }
  }

  /// True if near each other except for full turns of joints without limits.
  [[nodiscard]] bool is_near(const vector& a, const vector& b, double square) const {
    const vector difference = a - b;
    return difference.squaredNorm() < square ||
           (is_endless_ && solver_.modulo_full_turns(difference).squaredNorm() < square);
  }

  /// Adds the configurations on a curve with nodes_[start], alternately in both directions, so that
  /// those nearby come first.
  void extend(std::size_t start, const tip_pose& target) {
    const vector along = self_motion_space(nodes_[start].state.jacobian).any_direction();
    front ends[2] = {{start, along, spacing_}, {start, -along, spacing_}};
    bool is_open[2] = {along.norm() > 0, along.norm() > 0};
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
      if (next.is_within(solver_.tolerance) && displacement.norm() < 2 * reach &&
          displacement.dot(end.direction) > .7 * reach) {
        const vector direction = self_motion_space(next.state.jacobian).direction(end.direction);
        const bool reverses_orientation = orientation(next.state.jacobian, direction) *
                                              orientation(current.jacobian, end.direction) <
                                          0;
        if (direction.dot(end.direction) > .7 && (!reverses_orientation || reach < spacing_ / 50)) {
          nodes_.push_back({next.state, nodes_[end.at].u, std::ptrdiff_t(end.at)});
          end = {nodes_.size() - 1, direction, std::min(spacing_, 2 * reach)};
          return true;
        }
      }
    }
    return false;
  }

  const pose_solver<Capacity>& solver_;
  const tip_path& target_;
  double spacing_, singular_, min_step_;
  int remaining_iterations_;
  std::vector<search_node<Capacity>> nodes_;
  bool is_endless_ = false; ///< true if any joint has no limits
  struct {
    double u = 0;
    std::size_t from = 0, now = 0;
  } furthest_; ///< furthest parameter reached, and the configurations from which
};

/// Planner along a path, first without stopping; if that ends early, with self-motions.
template <int Capacity>
class path_planner {
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

  /// \param path   pose of the tip as a function of the parameter
  /// \param stops  parameters that become waypoints, increasing; the first and the last are the
  /// ends of the path
  /// \param objective_gradient  gradient of the objective, or nothing
  path_planner(const planning_model<Capacity>& model, const tip_path& path,
               std::vector<double> stops, const plan_options& options,
               const gradient_function& objective_gradient)
      : solver_{model, model.tolerance(options.tolerance)}, target_(path), stops_(std::move(stops)),
        options_(options), length_(stops_.back() - stops_.front()),
        remaining_iterations_(options.max_iterations),
        deviation_(model.tolerance(options.deviation)), objective_gradient_(objective_gradient) {}

  [[nodiscard]] partial_plan plan(const vector& start) {
    partial_plan best = continued(stay(start));
    // Search from the last waypoint; if that fails, from the start.
    for (std::size_t first : {best.waypoints.size() - 1, std::size_t(0)}) {
      if (is_at_end(best) || options_.search_step == 0) {
        break;
      }
      best = with_search(best, first);
    }
    return best;
  }

  /// Partial plan that consists of the start alone.
  [[nodiscard]] partial_plan stay(const vector& start) const {
    return partial_plan({solver_.model.at(start), stops_.front()});
  }
  [[nodiscard]] int iterations() const { return options_.max_iterations - remaining_iterations_; }

  /// Termination reason: the cause of failure of the first step that fails, of steps that grow.
  [[nodiscard]] stop_reason reason(const partial_plan& x) const {
    if (is_at_end(x) || remaining_iterations_ <= 0) {
      return is_at_end(x) ? stop_reason::reached : stop_reason::iteration_limit;
    }
    const waypoint& current = x.back();
    for (double step = options_.smallest_step; step < 1; step *= 2) {
      const double u = std::min(current.u + step * length_, stops_.back());
      const auto result = solver_.approach(current.state, target_(u), vector::Zero());
      if (result.is_within(solver_.tolerance)) {
        continue;
      }
      const bool is_near_singularity = result.smallest_singular_value < 10 * damping_threshold;
      return result.is_blocked || result.margin_violation > solver_.tolerance.translation
                 ? stop_reason::obstacle
             : (result.is_bounded || is_near_singularity) && is_stopped_by_limits(x, u)
                 ? stop_reason::joint_limit
             : is_near_singularity ? stop_reason::singular
                                   : stop_reason::no_progress;
    }
    return stop_reason::no_progress;
  }

private:
  [[nodiscard]] bool is_at_end(const partial_plan& x) const { return x.back().u == stops_.back(); }

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
        pose_error_between(solver_.model.at(between).tip, target_((1 - part) * a.u + part * b.u));
    return std::max(deviation_.ratio(off),
                    solver_.model.margin_violation(between) / deviation_.translation);
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
    const pose_solver<Capacity> damped = solver_;
    solver_.without_damping();
    x.step = options_.smallest_step;
    advance(x);
    solver_.damped_below = damped.damped_below;
    solver_.tolerance = damped.tolerance;
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
  [[nodiscard]] bool track(partial_plan& x, double end, double part, const null_space_task& task) {
    const double begin = x.back().u;
    double progress = 0; // fraction of the path up to `end`
    while (progress < 1) {
      const waypoint& current = x.back();
      const double next_progress =
          progress + x.step / part > 1 - 1e-9 ? 1 : progress + x.step / part;
      const double u = next_progress == 1 ? end : begin + (end - begin) * next_progress;
      const vector& theta = current.state.theta;
      vector desired_step = vector::Zero();
      if (task.aim != nullptr) {
        desired_step = (next_progress - progress) / (1 - progress) * (*task.aim - theta);
      } else if (task.lowers_objective) {
        desired_step = descent_step(theta, (next_progress - progress) * part);
      }
      auto result = solver_.approach(current.state, target_(u), desired_step);
      remaining_iterations_ -= result.iterations;
      if (task.lowers_objective && result.smallest_singular_value < damping_threshold) {
        // The objective may move the joints to where the path has no continuation.
        result = solver_.approach(current.state, target_(u), vector::Zero());
        remaining_iterations_ -= result.iterations;
      }
      double change = .25;
      if (result.is_within(solver_.tolerance)) {
        const waypoint on{result.state, u, result.residual, result.smallest_singular_value};
        const double error_ratio = error_ratio_between(current, on);
        // The deviation between waypoints grows with the square of the step.
        change = std::clamp(.85 / std::sqrt(std::max(error_ratio, 1e-12)), .2, 2.0);
        if (x.step < options_.smallest_step &&
            (result.state.theta - theta).norm() < min_reorientation) {
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
      x.step = std::min(options_.largest_step, x.step * change);
      if (progress < 1 && (remaining_iterations_ <= 0 || (x.step < options_.smallest_step &&
                                                          !is_reorienting(x.back(), x.step)))) {
        return false;
      }
    }
    return true;
  }

  /// Continues as far as possible without stopping.
  void advance(partial_plan& x) {
    for (const double stop : stops_) {
      if (stop > x.back().u &&
          !track(x, stop, (stop - x.back().u) / length_, {.lowers_objective = true})) {
        return;
      }
    }
  }

  /// Descent step of the objectives.
  [[nodiscard]] vector descent_step(const vector& theta, double step) const {
    const vector centre = joint_centring_step(theta, solver_.model.lower, solver_.model.upper,
                                              options_.centring * step);
    return objective_gradient_ ? vector(centre - step * objective_gradient_(theta)) : centre;
  }

  /// True if the joints move far in a short step along the path.
  [[nodiscard]] bool is_reorienting(const waypoint& at, double step) const {
    constexpr double min_step = 1e-12;
    if (solver_.damped_below != undamped_threshold_near_singularity || !(step > min_step)) {
      return false;
    }
    const auto& [theta, tip, jacobian] = at.state;
    const small_twist e = error_twist(tip, target_(std::min(at.u + step * length_, stops_.back())));
    return bounded_step(jacobian, e, solver_.lower - theta, solver_.upper - theta,
                        {undamped_threshold_near_singularity})
               .step.norm() > min_reorientation;
  }

  /// True if joint limits end the plan: without limits it continues beyond the parameter u, from
  /// its end or from before the singularity there, if necessary by a self-motion; or, if the arm is
  /// not redundant, its continuation through the singularity leaves the limits.
  [[nodiscard]] bool is_stopped_by_limits(const partial_plan& x, double u) const {
    path_planner free = *this;
    free.remaining_iterations_ = 100000;
    free.solver_.upper.head(solver_.model.size).fill(std::numeric_limits<double>::infinity());
    free.solver_.lower = -free.solver_.upper;
    const double beyond = std::min(u + 4 * (u - x.back().u), stops_.back());
    free.stops_ = {stops_.front(), beyond};
    partial_plan end = free.undamped(partial_plan(x.back()));
    if (!free.is_at_end(end) && x.back().smallest_singular_value < damping_threshold) {
      end = free.undamped(before_singularity(x));
    }
    const waypoint& from = end.back();
    const auto continues_after_self_motion = [&] {
      free.solver_.without_damping();
      self_motion_search search(free.solver_, target_, options_.self_motion_step, damping_threshold,
                                beyond - from.u, free.remaining_iterations_);
      return search.run(from.state, {from.u, beyond}).front().back().u == beyond;
    };
    return free.is_at_end(end) || (options_.search_step > 0 && continues_after_self_motion()) ||
           (solver_.model.size <= 6 && ((from.state.theta.array() < solver_.lower.array()).any() ||
                                        (from.state.theta.array() > solver_.upper.array()).any()));
  }

  /// Better plan with self-motions from a waypoint of `before`, or `before` itself.
  [[nodiscard]] partial_plan with_search(const partial_plan& before, std::size_t first) {
    partial_plan begin(before.waypoints.front());
    begin.waypoints.assign(before.waypoints.begin(),
                           before.waypoints.begin() + std::ptrdiff_t(first) + 1);
    partial_plan best = before;
    // Parameter distance from its end to which a continuation is followed.
    const double enough = 100 * options_.smallest_step * length_;
    const double full_step = options_.search_step;
    // A continuation near a singularity may cross it where the tip cannot follow; the second search
    // therefore avoids such crossings. Or it passes so near that joints get to the other side; the
    // further searches therefore use shorter steps.
    for (const auto& [singular, step] :
         {std::pair(damping_threshold, full_step), std::pair(singularity_threshold, full_step),
          std::pair(damping_threshold, full_step / 4),
          std::pair(damping_threshold, full_step / 16)}) {
      self_motion_search search(solver_, target_, options_.self_motion_step, singular, enough,
                                remaining_iterations_);
      const auto continuations =
          search.run(begin.back().state, search_parameters(begin.back(), step));
      remaining_iterations_ = search.remaining_iterations();
      for (const auto& continuation : continuations) {
        if (!is_at_end(best)) {
          keep_furthest(best, along(begin, continuation));
        }
      }
      if (best.back().u + enough >= continuations.front().back().u) {
        break;
      }
    }
    return best;
  }

  /// Plan along a continuation from the search, and beyond.
  [[nodiscard]] partial_plan
  along(partial_plan x, const typename self_motion_search<Capacity>::configurations& continuation) {
    for (std::size_t i = 1; i < continuation.size(); ++i) {
      const std::size_t count = x.waypoints.size();
      const auto track_to = [&](bool is_back) {
        x.step = options_.search_step;
        return is_back ? track_backwards(x, continuation[i])
                       : track(x, continuation[i].u, options_.search_step,
                               {&continuation[i].state.theta});
      };
      if (!track_to(continuation[i].escapes_singularity)) {
        x.waypoints.erase(x.waypoints.begin() + std::ptrdiff_t(count), x.waypoints.end());
        if (!track_to(!continuation[i].escapes_singularity)) {
          return x;
        }
      }
    }
    return continued(std::move(x));
  }

  /// Parameters of the search from a waypoint on, a step apart: nearer to the waypoint if it is
  /// singular, as escapes may be short.
  [[nodiscard]] std::vector<double> search_parameters(const waypoint& from, double step) const {
    std::vector<double> result = {from.u};
    if (smallest_singular_value_of(from.state.jacobian) < damping_threshold) {
      for (const double part : {1. / 256, 1. / 16}) {
        result.push_back(std::min(from.u + part * step * length_, stops_.back()));
      }
    }
    for (const double stop : stops_) {
      const double begin = result.back();
      if (stop > begin) {
        const int count = int(std::ceil((stop - begin) / (step * length_)));
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
    back.step = options_.search_step;
    const double u = x.back().u;
    if (!track(back, u, options_.search_step, {})) {
      return false;
    }
    for (int round = 0; round < 5 && error_ratio_between(x.back(), back.back()) > 1; ++round) {
      move_to(x, back.back().state.theta);
      move_to(back, x.back().state.theta);
    }
    if (error_ratio_between(x.back(), back.back()) > 1) {
      return false;
    }
    x.waypoints.insert(x.waypoints.end(), back.waypoints.rbegin(), back.waypoints.rend());
    x.step = options_.search_step;
    return true;
  }

  /// Self-motion to a configuration, or as near to it as possible.
  void move_to(partial_plan& x, const vector& aim) {
    for (double before = std::numeric_limits<double>::infinity();;) {
      const double remaining = (aim - x.back().state.theta).norm();
      if (remaining < 1e-9 || !(remaining < .9 * before) ||
          !track(x, x.back().u, options_.search_step, {&aim})) {
        return;
      }
      before = remaining;
    }
  }

  static constexpr double min_reorientation = 1e-3;

  pose_solver<Capacity> solver_;
  const tip_path& target_;
  std::vector<double> stops_;
  plan_options options_;
  double length_; ///< length of the path's parameter interval
  int remaining_iterations_;
  pose_tolerance deviation_;
  const gradient_function& objective_gradient_;
};

void require_options(const plan_options& o, const char* caller) {
  require_positive(caller, "tolerance", o.tolerance);
  require_positive(caller, "deviation", o.deviation);
  require_positive(caller, "largest_step", o.largest_step);
  require_positive(caller, "smallest_step", o.smallest_step);
  require_positive(caller, "self_motion_step", o.self_motion_step);
  require_option(caller, "centring", o.centring, o.centring >= 0, "a non-negative number");
  require_option(caller, "search_step", o.search_step,
                 o.search_step == 0 || (o.search_step >= 1e-6 && o.search_step <= 1),
                 "0 or a number from 1e-6 to 1");
}

/// `body 3 (wrist)`
[[nodiscard]] std::string name_of_body(const scene& around, std::size_t i) {
  const std::string& name = around.bodies[i].name;
  return "body " + std::to_string(i) + (name.empty() ? "" : " (" + name + ")");
}

/// \throws invalid_input if obstacles are closer than their margin
void require_clearance(const chain_clearance<double>& closest, const scene& around,
                       double tolerance) {
  if (!(closest.distance >= around.margin - tolerance)) {
    raise(invalid_input(
        printable(message("duet: follow_path: at the start ", name_of_body(around, closest.body),
                          " is ", closest.distance, " from ",
                          closest.is_self ? name_of_body(around, closest.other)
                                          : "obstacle " + std::to_string(closest.other),
                          ", closer than the margin of ", around.margin))));
  }
}

/// Plan along a path; if its end is certainly out of reach and `may_be_out_of_reach`, the start
/// alone.
template <int Capacity>
[[nodiscard]] motion_plan
planned(const planning_model<Capacity>& model, const Eigen::VectorXd& start,
        const path_function& target, const std::vector<double>& stops, const plan_options& options,
        const solution_preferences& preferences, bool may_be_out_of_reach) {
  using vector = small_vector<Capacity>;
  const objective_view& objective = preferences.objective;
  const scene* const around = preferences.around;
  const vector theta = model.joints(start);
  const tip_path scaled_path = [&](double u) { return model.scaled_pose(target(u)); };
  const auto start_error =
      model.unscaled_error(pose_error_between(model.at(theta).tip, scaled_path(stops.front())));
  require(options.tolerance.ratio(start_error) <= 1, "duet: follow_path: the path begins ",
          start_error.translation, " units of length and ", start_error.rotation,
          " rad away from the tip at the start");
  if (around != nullptr) {
    require_clearance(model.nearest_obstacle(theta), *around, options.tolerance.translation);
  }
  if (objective && std::isnan(objective(start))) {
    fail_not_a_number("duet: follow_path: the objective is nan at the start,", start);
  }
  std::function<vector(const vector&)> objective_gradient;
  if (objective) {
    objective_gradient = [&](const vector& x) {
      // Gradient with respect to coordinates in the planner's units.
      vector result = vector::Zero();
      result.head(model.size) = objective.gradient(model.chain_joints(x));
      return vector(result.cwiseProduct(model.unit));
    };
  }
  const bool is_out_of_reach =
      may_be_out_of_reach &&
      model.reach.is_beyond(scaled_path(stops.back()), model.tolerance(options.tolerance));
  path_planner<Capacity> planner(model, scaled_path, stops, options, objective_gradient);
  const auto joint_path = is_out_of_reach ? planner.stay(theta) : planner.plan(theta);
  motion_plan plan;
  for (const auto& w : joint_path.waypoints) {
    const Eigen::VectorXd joints =
        plan.joints.empty() ? start : Eigen::VectorXd(model.joints_within_limits(w.state.theta));
    add_waypoint(plan, model.chain(), joints, model.unscaled_pose(w.state.tip), w.u,
                 model.unscaled_error(w.residual));
    plan.smallest_clearance =
        std::min(plan.smallest_clearance, model.length * model.clearance(w.state.theta));
  }
  // The steps recorded, in the planner's units, where the singular value is smallest: at one end of
  // a step.
  const auto most_singular = std::min_element(
      joint_path.waypoints.begin(), joint_path.waypoints.end(), [](const auto& a, const auto& b) {
        return a.smallest_singular_value < b.smallest_singular_value;
      });
  for (auto w = most_singular - (most_singular != joint_path.waypoints.begin()); w <= most_singular;
       ++w) {
    plan.smallest_singular_value =
        std::min(plan.smallest_singular_value,
                 smallest_singular_value_of(model.unscaled_jacobian(w->state.jacobian)));
  }
  plan.iterations = planner.iterations();
  plan.reason = is_out_of_reach ? stop_reason::out_of_reach : planner.reason(joint_path);
  return plan;
}

/// Shorter screw motion between two poses (N19), as a function of τ.
[[nodiscard]] path_function screw_path(const dual_quaternion<double>& first,
                                       const dual_quaternion<double>& last) {
  dual_quaternion<double> between = conj(first) * normalized(last);
  if (innermost(between.w()) < 0) {
    between = -between;
  }
  return [first, half = log_vector(between, "plan_screw_motion")](double tau) {
    return dual_quaternion<double>(first *
                                   exp(dual_vector<double>(half * screw_dual<double>(tau))));
  };
}

} // namespace

DUET_ABI_BEGIN

path_function checked(path_function path) {
  return [path = std::move(path)](double u) {
    const dual_quaternion<double> a = path(u);
    require_pose(a, "follow_path", "the pose at " + to_text(u));
    return normalized(a);
  };
}

motion_plan follow(const chain_view& chain, const Eigen::Ref<const Eigen::VectorXd>& start,
                   const path_function& target, const std::vector<double>& stops,
                   const plan_options& options, const solution_preferences& preferences) {
  require_start(chain, start, "follow_path");
  require_options(options, "follow_path");
  return with_capacity(chain.size(), [&]<int Capacity>(std::integral_constant<int, Capacity>) {
    return planned(planning_model<Capacity>(chain, preferences.around), start, target, stops,
                   options, preferences, false);
  });
}

motion_plan follow_poses(const chain_view& chain, const Eigen::Ref<const Eigen::VectorXd>& start,
                         std::span<const dual_quaternion<double>> poses,
                         const plan_options& options, const solution_preferences& preferences) {
  require(!poses.empty(), "duet: follow_path: the list of poses is empty");
  std::vector<dual_quaternion<double>> all;
  std::vector<double> stops;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    require_pose(poses[i], "follow_path", "pose " + std::to_string(i));
    all.push_back(normalized(poses[i]));
    stops.push_back(double(i));
  }
  const auto target = [&](double u) {
    const std::size_t i = std::min(std::size_t(u), all.size() - 1);
    return sclerp(all[i], all[std::min(i + 1, all.size() - 1)], u - double(i));
  };
  return follow(chain, start, target, stops, options, preferences);
}

motion_plan plan_screw_motion(const chain_view& chain,
                              const Eigen::Ref<const Eigen::VectorXd>& start,
                              const dual_quaternion<double>& goal, const plan_options& options,
                              const solution_preferences& preferences) {
  require_start(chain, start, "plan_screw_motion");
  require_pose(goal, "plan_screw_motion", "the goal");
  require_options(options, "plan_screw_motion");
  return with_capacity(chain.size(), [&]<int Capacity>(std::integral_constant<int, Capacity>) {
    const planning_model<Capacity> model(chain, preferences.around);
    const auto first = model.unscaled_pose(model.at(model.joints(start)).tip);
    return planned(model, start, screw_path(first, goal), {0, 1}, options, preferences, true);
  });
}

DUET_ABI_END
} // namespace duet::detail
