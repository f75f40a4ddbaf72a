// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "bounded_step.hpp"
#include "branches/loop_equation.hpp"
#include "constrained_step.hpp"
#include "planning_model.hpp"
#include "splitmix64.hpp"

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/parallel_for.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace duet::detail {
namespace {

/// \throws invalid_input
void require_options(const inverse_kinematics_options& options) {
  constexpr const char* caller = "inverse_kinematics";
  require_positive(caller, "tolerance", options.tolerance);
  require_positive(caller, "max_iterations", options.max_iterations);
  require_option(caller, "max_restarts", options.max_restarts, options.max_restarts >= 0,
                 "a non-negative number");
  require_positive(caller, "candidates", options.candidates);
}

/// Comparison a < b with nan greater than any number.
[[nodiscard]] bool is_less(double a, double b) {
  return a < b || (std::isnan(b) && !std::isnan(a));
}

/// Equations J Δ = e of a goal at some θ.
template <int Capacity>
struct goal_equations {
  chain_state<Capacity> at;
  small_twist e = {};
  pose_error residual = {};
  std::array<bool, 6> is_free{}; ///< true for each of the six rows without an equation
};

/// Goal with lengths in the planner's unit: a pose, or a goal with a constraint of its own.
struct scaled_goal {
  double length;                  ///< the planner's unit of length
  std::optional<tip_pose> target; ///< pose, in the planner's unit
  const goal_view& other;         ///< if there is no pose, in the user's unit

  [[nodiscard]] twist_constraint constraint(const tip_pose& tip) const {
    if (target) {
      const small_twist e = error_twist(tip, *target);
      return {gram_matrix::Identity(), e, e};
    }
    twist_constraint x =
        other.constraint(to_dual_quaternion({tip.rotation, length * tip.translation}));
    x.lower.head<3>() /= length;
    x.upper.head<3>() /= length;
    x.matrix.topRightCorner<3, 3>() /= length;
    x.matrix.bottomLeftCorner<3, 3>() *= length;
    return x;
  }
  /// True if certainly out of reach: the tip is never farther from the first joint than the lengths
  /// of links, prismatic joints and tool together.
  [[nodiscard]] bool is_beyond(const chain_reach& reach, const pose_tolerance& tolerance) const {
    if (target) {
      return reach.is_beyond(*target, tolerance);
    }
    const three_vector<double> first = length * reach.first;
    const double max_distance = (reach.links + reach.travel + reach.tool) * (1 + 1e-12);
    return reach.has_joints && other.distance_from &&
           other.distance_from(first.eigen()) / length > max_distance + tolerance.translation;
  }
  /// Sets the equations: all six components of the twist to a pose; of other goals M J Δ = e, where
  /// rows within their bounds impose no equation.
  template <int Capacity>
  void set_equations(goal_equations<Capacity>& x) const {
    if (target) {
      x.e = error_twist(x.at.tip, *target);
      x.residual = {length_of(target->translation - x.at.tip.translation),
                    x.e.template tail<3>().norm()};
      return;
    }
    const twist_constraint limits = constraint(x.at.tip);
    x.e = unsatisfied(limits);
    x.residual = deviation_of(x.e);
    x.at.jacobian = (limits.matrix * x.at.jacobian).eval();
    for (Eigen::Index i = 0; i < 6; ++i) {
      const bool is_equation =
          limits.lower[i] == limits.upper[i] && !limits.matrix.row(i).isZero(0);
      x.is_free[std::size_t(i)] = x.e[i] == 0 && !is_equation;
      if (x.is_free[std::size_t(i)]) {
        x.at.jacobian.row(i).setZero();
      }
    }
  }
  /// Part of a constraint that is not satisfied yet.
  [[nodiscard]] static small_twist unsatisfied(const twist_constraint& limits) {
    return limits.lower.cwiseMax(limits.upper.cwiseMin(0));
  }
};

/// Equality and inequality constraints of a step.
struct step_conditions {
  std::vector<inequality<Eigen::VectorXd>> equations;    ///< normal·x = bound
  std::vector<inequality<Eigen::VectorXd>> inequalities; ///< normal·x ≥ bound
};

/// Minimiser x of gradient·x + ½ xᵀ B x under the constraints, B = `curvature` positive definite;
/// nothing if no x satisfies them. With B = L Lᵀ and y = Lᵀx + L⁻¹ gradient the objective is ½|y|²
/// up to a constant: a least-norm problem for y.
[[nodiscard]] std::optional<Eigen::VectorXd> quadratic_step(const Eigen::VectorXd& gradient,
                                                            const Eigen::MatrixXd& curvature,
                                                            const step_conditions& conditions) {
  using V = Eigen::VectorXd;
  const Eigen::LLT<Eigen::MatrixXd> factors(curvature);
  const auto root = factors.matrixL();
  orthonormal_rows<V> equality_rows;
  V aim = V::Zero(gradient.size()); // the least-norm y that satisfies the equations
  for (const inequality<V>& each : conditions.equations) {
    const V row = root.solve(each.normal);
    const double residual = each.bound - row.dot(aim), length = equality_rows.add(row);
    if (length > 0) {
      aim +=
          residual * length / (length * length + 1e-14 * row.squaredNorm()) * equality_rows.back();
    }
  }
  aim -= equality_rows(root.solve(gradient));
  std::vector<inequality<V>> reduced;
  reduced.reserve(conditions.inequalities.size());
  for (const inequality<V>& each : conditions.inequalities) {
    const V row = root.solve(each.normal);
    reduced.push_back({equality_rows(row), each.bound - row.dot(aim)});
  }
  const std::optional<V> correction = least_distance(reduced, gradient.size());
  return correction ? std::optional<V>(factors.matrixU().solve(aim + *correction)) : std::nullopt;
}

/// Sequential quadratic programming within the solutions of a goal: each step keeps goal, limits
/// and margins to first order, and Newton's method leads back to them. The curvature is that of the
/// function on the set of solutions, after Broyden, Fletcher, Goldfarb and Shanno (BFGS) with
/// Powell's damping, from the change of the projected gradient.
template <int Capacity>
class solution_refinement {
public:
  using joints = small_vector<Capacity>;
  using vector = Eigen::VectorXd; // of one size for all chains: compiled once
  using matrix = Eigen::MatrixXd;

  struct point {
    joints theta;
    pose_error residual;
    double error_ratio = 0; ///< largest deviation or margin violation, relative to the tolerance
    step_conditions conditions;
    double value = 0; ///< value of the objective
    vector gradient;
  };

  solution_refinement(const planning_model<Capacity>& model, const scaled_goal& goal,
                      const objective_view& objective, const pose_tolerance& tolerance)
      : model_(model), goal_(goal), objective_(objective), tolerance_(tolerance) {}

  /// Solution near a given configuration that keeps the margins too and, if there is an objective,
  /// minimises it locally. Nothing if that fails.
  [[nodiscard]] std::optional<point> operator()(const joints& theta, int iterations) const {
    auto best = solution(theta);
    if (!best || !objective_) {
      return best;
    }
    matrix curvature;
    bool is_first = true;
    for (int iteration = 0; iteration < iterations; ++iteration) {
      if (is_first) { // a first step of a fifth of a radian
        const double steepness = projected_gradient(*best).gradient.norm();
        if (!(steepness > 0)) {
          break;
        }
        curvature = 5 * steepness * matrix::Identity(model_.size, model_.size);
      }
      const auto step = quadratic_step(best->gradient, curvature, best->conditions);
      const double gain = step ? -best->gradient.dot(*step) : 0;
      std::optional<point> next;
      for (double part = 1; gain > 0 && part > 1e-4; part /= 3) {
        next = solution(moved(best->theta, *step, part));
        if (next && next->value < best->value - 1e-4 * part * gain) {
          break;
        }
        next.reset();
      }
      if (next) {
        curvature = learned(curvature, is_first, *best, *next);
        const bool is_end = best->value - next->value <= 1e-14 * std::abs(best->value);
        best = std::move(next);
        if (is_end) {
          break;
        }
      } else if (is_first) {
        break;
      }
      is_first = !next; // restart if the learned curvature does not help
    }
    return best;
  }

private:
  /// Maximum step in one direction, beyond which the first order is inaccurate.
  static constexpr double trusted = .5;

  [[nodiscard]] point at(const joints& theta) const {
    point x;
    x.theta = theta;
    const auto state = model_.at(theta);
    const twist_constraint constraint = goal_.constraint(state.tip);
    x.residual = deviation_of(scaled_goal::unsatisfied(constraint));
    x.error_ratio = std::max(tolerance_.ratio(x.residual),
                             model_.margin_violation(theta) / tolerance_.translation);
    auto& more = x.conditions.inequalities;
    for (Eigen::Index i = 0; i < 6; ++i) {
      if (constraint.matrix.row(i).isZero(0)) {
        continue;
      }
      const vector normal = (constraint.matrix.row(i) * state.jacobian).transpose();
      const double lower = constraint.lower[i], upper = constraint.upper[i];
      if (lower == upper) {
        x.conditions.equations.push_back({normal, lower});
      } else {
        add(more, normal, lower);
        add(more, -normal, -upper);
      }
    }
    for (int i = 0; i < model_.size; ++i) {
      const vector normal = vector::Unit(model_.size, i);
      add(more, normal, std::max(model_.lower[i] - theta[i], -trusted));
      add(more, -normal, std::max(theta[i] - model_.upper[i], -trusted));
    }
    for (const auto& each : model_.template margin_inequalities<vector>(theta)) {
      add(more, each.normal, std::min(each.bound, .1));
    }
    return x;
  }
  static void add(std::vector<inequality<vector>>& to, const vector& normal, double bound) {
    if (bound > -std::numeric_limits<double>::infinity()) {
      to.push_back({normal, bound});
    }
  }
  [[nodiscard]] joints moved(joints theta, const vector& step, double part) const {
    theta.head(model_.size) += part * step;
    return theta.cwiseMax(model_.lower).cwiseMin(model_.upper);
  }

  /// Point at which all constraints hold again, by least-norm steps.
  [[nodiscard]] std::optional<point> restored(joints theta) const {
    constexpr double close = 1e-7; // well within the tolerance, so that objectives are comparable
    const vector none = vector::Zero(model_.size);
    const matrix one = matrix::Identity(model_.size, model_.size);
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0;; ++k) {
      point x = at(theta);
      const bool is_end =
          x.error_ratio <= close || k == 20 || (x.error_ratio <= 1 && x.error_ratio > before / 2);
      const auto step = is_end ? std::nullopt : quadratic_step(none, one, x.conditions);
      if (!step) {
        return x.error_ratio <= 1 ? std::optional<point>(std::move(x)) : std::nullopt;
      }
      before = x.error_ratio;
      theta = moved(theta, *step, 1);
    }
  }
  [[nodiscard]] std::optional<point> solution(const joints& theta) const {
    auto x = restored(theta);
    if (x && objective_) {
      const auto chain_joints = model_.chain_joints(x->theta);
      x->value = objective_(chain_joints);
      x->gradient = objective_.gradient(chain_joints);
      // With respect to the planner's coordinates.
      x->gradient = x->gradient.cwiseProduct(model_.unit.head(model_.size)).eval();
    }
    return x;
  }

  /// Projection of the gradient onto the directions that the active constraints leave free.
  struct projected_gradient {
    orthonormal_rows<vector> active_rows;
    std::size_t count = 0;
    vector gradient;

    explicit projected_gradient(const point& x) {
      for (const auto& each : x.conditions.equations) {
        active_rows.add(each.normal);
      }
      for (const auto& each : x.conditions.inequalities) {
        if (each.bound > -1e-7) {
          active_rows.add(each.normal);
          ++count;
        }
      }
      gradient = active_rows(x.gradient);
    }
  };

  /// Curvature after the update by a step (damped BFGS).
  [[nodiscard]] matrix learned(matrix curvature, bool is_first, const point& before,
                               const point& after) const {
    const projected_gradient gradient_before(before), gradient_after(after);
    const vector s = gradient_after.active_rows((after.theta - before.theta).head(model_.size));
    vector y = gradient_after.gradient - gradient_before.gradient;
    if (is_first && s.dot(y) > 0) {
      curvature *= y.squaredNorm() / s.dot(y) / curvature(0, 0);
    }
    const vector bs = curvature * s;
    const double sbs = s.dot(bs);
    if (gradient_before.count != gradient_after.count || !(sbs > 0)) {
      return curvature; // another active set
    }
    if (s.dot(y) < .2 * sbs) {
      const double part = .8 * sbs / (sbs - s.dot(y));
      y = part * y + (1 - part) * bs;
    }
    const double sy = s.dot(y);
    curvature += y * y.transpose() / sy - bs * bs.transpose() / sbs;
    return curvature;
  }

  const planning_model<Capacity>& model_;
  const scaled_goal& goal_;
  const objective_view& objective_;
  pose_tolerance tolerance_;
};

/// Search for solutions from the start and from random configurations, of which each is refined by
/// `solution_refinement` if there are preferences.
template <int Capacity>
class inverse_kinematics_search {
  using vector = small_vector<Capacity>;
  using equations = goal_equations<Capacity>;

public:
  inverse_kinematics_search(const planning_model<Capacity>& model, const vector& start,
                            const inverse_kinematics_options& options,
                            const solution_preferences& preferences)
      : model_(model), options_(options), preferences_(preferences),
        tolerance_(model.tolerance(options.tolerance)), period_(vector::Zero()),
        beyond_(vector::Zero()), spread_(vector::Zero()), start_(start) {
    require_options(options);
    for (int i = 0; i < model.size; ++i) {
      require(start[i] - start[i] == 0, "duet: inverse_kinematics: joint ", i, " of the start is ",
              model.unit[i] * start[i], " (expected a finite number)");
      const bool is_rotational = model.is_rotational[std::size_t(i)];
      constexpr double full_turn = 2 * std::numbers::pi;
      const bool has_full_turn = is_rotational && !model.is_translational[std::size_t(i)] &&
                                 model.upper[i] - model.lower[i] >= full_turn;
      period_[i] = has_full_turn ? full_turn : 0;
      beyond_[i] = has_full_turn ? std::numeric_limits<double>::infinity() : 0;
      spread_[i] = is_rotational ? std::numbers::pi : 1;
    }
    start_ = within_limits(start_);
  }

  /// \param name  callable that returns the name of the goal for messages
  /// \throws invalid_input if the goal or the objective is nan at every configuration evaluated
  [[nodiscard]] inverse_kinematics_result operator()(const goal_view& of, const auto& name) const {
    scaled_goal goal{model_.length, {}, of};
    solution_list known;
    if (of.pose != nullptr) {
      goal.target = model_.scaled_pose(normalized(*of.pose));
      if (preferences_.objective && is_algebraic(model_.chain(), 6)) {
        known = solutions_within_limits(model_.chain(), *of.pose, options_.tolerance);
      }
    }
    const bool is_choosy = (preferences_.objective || preferences_.around != nullptr) &&
                           !goal.is_beyond(model_.reach, tolerance_);
    const attempt x = is_choosy ? preferred(goal, known) : nearest_attempt(goal);
    if (is_choosy || of.pose == nullptr) {
      require_numbers(x, name);
    }
    return {model_.joints_within_limits(x.joints), model_.unscaled_error(x.residual), x.iterations,
            x.restarts, x.reason};
  }

private:
  struct attempt {
    vector joints;
    pose_error residual;
    double error; ///< |e|²
    int iterations = 0;
    int restarts = 0;
    stop_reason reason = stop_reason::no_progress;
  };

  /// The attempt that comes nearest to a goal, without preferences.
  [[nodiscard]] attempt nearest_attempt(const scaled_goal& goal) const {
    const bool is_out_of_reach = goal.is_beyond(model_.reach, tolerance_);
    const auto search = [&](const vector& from) {
      return is_out_of_reach && goal.target ? nearest(from, goal) : approach(from, goal);
    };
    attempt best = search(start_);
    int iterations = best.iterations, restarts = 0;
    splitmix64 random(options_.seed);
    while (best.reason != stop_reason::reached && restarts < options_.max_restarts) {
      const attempt next = search(configuration(random));
      iterations += next.iterations;
      ++restarts;
      if (is_less(next.error, best.error)) {
        best = next;
      }
    }
    if (is_out_of_reach && best.reason != stop_reason::reached) {
      best.reason = stop_reason::out_of_reach;
    } else if (best.reason == stop_reason::no_progress) {
      best.reason = reason_without_progress(best.joints, goal);
    }
    best.iterations = iterations;
    best.restarts = restarts;
    return best;
  }

  /// Damped least squares from one initial guess, without random restarts.
  [[nodiscard]] attempt approach(vector theta, const scaled_goal& goal) const {
    attempt best{theta, {}, std::numeric_limits<double>::infinity()};
    double before = best.error;
    int since = 0; // iterations since the error last fell by a tenth
    for (int iteration = 0;; ++iteration) {
      const equations current = equations_at(theta, goal);
      const double error = current.e.squaredNorm();
      const bool is_reached = tolerance_.ratio(current.residual) <= 1;
      if (iteration == 0 || error < best.error || is_reached) {
        best = {theta, current.residual, error};
      }
      if (error < .9 * before) {
        before = error;
        since = 0;
      }
      best.iterations = iteration;
      if (is_reached || since == 4 || iteration == options_.max_iterations) {
        best.reason = is_reached   ? stop_reason::reached
                      : since == 4 ? stop_reason::no_progress
                                   : stop_reason::iteration_limit;
        return best;
      }
      ++since;
      theta = within_limits(theta + step(current).step);
    }
  }

  /// Reason why the search cannot continue from a configuration.
  [[nodiscard]] stop_reason reason_without_progress(const vector& theta,
                                                    const scaled_goal& goal) const {
    const equations current = equations_at(theta, goal);
    if (step(current).is_bounded) {
      return stop_reason::joint_limit;
    }
    gram_matrix gram = gram_of(current.at.jacobian);
    int count = 6;
    for (Eigen::Index i = 0; i < 6; ++i) {
      if (current.is_free[std::size_t(i)]) {
        gram(i, i) = 1;
        --count;
      }
    }
    const bool is_singular =
        model_.size >= count && damped_gram(gram).smallest() < 10 * damping_threshold;
    return is_singular ? stop_reason::singular : stop_reason::no_progress;
  }

  /// Random configuration, uniform within the limits; without them, about the start.
  [[nodiscard]] vector configuration(splitmix64& random) const {
    vector theta = vector::Zero();
    for (Eigen::Index i = 0; i < model_.size; ++i) {
      double lower = model_.lower[i], upper = model_.upper[i];
      if (!(upper - lower < std::numeric_limits<double>::infinity())) {
        lower = std::max(lower, start_[i] - spread_[i]);
        upper = std::min(upper, start_[i] + spread_[i]);
      }
      theta[i] = lower + (upper - lower) * random();
    }
    return theta;
  }

  [[nodiscard]] attempt preferred(const scaled_goal& goal, const solution_list& known) const {
    const objective_view& objective = preferences_.objective;
    const solution_refinement<Capacity> refine(model_, goal, objective, tolerance_);
    attempt best{start_, {}, std::numeric_limits<double>::infinity()};
    double min_value = std::numeric_limits<double>::infinity(); // of the objective
    int iterations = 0, candidates = 0, restarts = 0;
    const auto consider = [&](vector theta) {
      constexpr int rounds = 4; // after self-motions other full turns may be better
      std::optional<typename solution_refinement<Capacity>::point> refined;
      for (int k = 0; k < rounds; ++k) {
        const auto other = objective ? improved_by_full_turns(theta, objective) : theta;
        if (refined && other == theta) {
          break;
        }
        refined = refine(other, options_.max_iterations);
        if (!refined || !objective) {
          break;
        }
        theta = refined->theta;
      }
      if (refined && (best.reason != stop_reason::reached || is_less(refined->value, min_value))) {
        best = {refined->theta, refined->residual, 0, 0, 0, stop_reason::reached};
        min_value = refined->value;
      }
      return refined.has_value();
    };
    for (const Eigen::VectorXd& theta : known.joints) {
      consider(model_.joints(theta));
    }
    if (known.is_complete && best.reason == stop_reason::reached) {
      return best;
    }
    splitmix64 random(options_.seed);
    for (;; ++restarts) {
      attempt next = approach(restarts == 0 ? start_ : configuration(random), goal);
      iterations += next.iterations;
      if (next.reason == stop_reason::reached) {
        candidates += consider(next.joints);
        next.reason = stop_reason::obstacle;
      }
      if (best.reason != stop_reason::reached &&
          (restarts == 0 || is_less(next.error, best.error))) {
        best = next;
      }
      if (restarts == options_.max_restarts || candidates == options_.candidates ||
          (candidates == 1 && !objective)) {
        break;
      }
    }
    if (best.reason == stop_reason::no_progress) {
      best.reason = reason_without_progress(best.joints, goal);
    }
    best.iterations = iterations;
    best.restarts = restarts;
    return best;
  }

  /// Joints moved by full turns within the limits as long as that lowers the objective.
  [[nodiscard]] vector improved_by_full_turns(vector theta, const objective_view& objective) const {
    constexpr double max_change = 0x1p20;
    double min_value = objective(model_.chain_joints(theta));
    const auto is_lower_by = [&](int i, double change) {
      vector other = theta;
      other[i] += change;
      const bool is_within = other[i] >= model_.lower[i] && other[i] <= model_.upper[i];
      const double value = is_within ? objective(model_.chain_joints(other)) : min_value;
      const bool result = is_within && is_less(value, min_value);
      if (result) {
        theta = other;
        min_value = value;
      }
      return result;
    };
    for (int i = 0; i < model_.size; ++i) {
      const double period = period_[i];
      bool is_lower = period > 0;
      while (is_lower) { // by 1, 2, 4 … full turns, and back
        is_lower = false;
        for (const double side : {-period, period}) {
          for (double change = side; std::abs(change) < max_change && is_lower_by(i, change);
               change *= 2) {
            is_lower = true;
          }
        }
      }
    }
    return theta;
  }

  /// Rejects nan: the best candidate is nan only if all candidates are.
  void require_numbers(const attempt& x, const auto& name) const {
    const auto fail = [&](const std::string& what) {
      fail_not_a_number("duet: inverse_kinematics: " + what, model_.chain_joints(x.joints));
    };
    if ((std::isnan(x.residual.translation) || std::isnan(x.residual.rotation)) &&
        std::isfinite(length_of(model_.at(x.joints).tip.translation))) { // not by overflow
      fail(name() + " is nan at every configuration evaluated, for example at the");
    }
    if (x.reason == stop_reason::reached &&
        std::isnan(preferences_.objective(model_.chain_joints(x.joints)))) {
      fail("the objective is nan at all solutions found, for example at the");
    }
  }

  [[nodiscard]] equations equations_at(const vector& theta, const scaled_goal& goal) const {
    equations result{model_.at(theta)};
    goal.set_equations(result);
    return result;
  }

  /// Levenberg–Marquardt (damped least squares) step, with a damping that grows with the error.
  [[nodiscard]] bounded_step_result<Capacity> step(const equations& x) const {
    const double lambda = std::min(.02 * x.e.squaredNorm(), .08) + 1e-9;
    return bounded_step(x.at.jacobian, x.e, model_.lower - x.at.theta - beyond_,
                        model_.upper - x.at.theta + beyond_, {0, lambda});
  }

  /// Nearest pose from a start on: minimum of the squared distance of the origins plus |ω|², by
  /// Newton's method with a damping that lets no step increase it. Joints at limits that block them
  /// are fixed there.
  [[nodiscard]] attempt nearest(const vector& start, const scaled_goal& goal) const {
    point current = point_at(start, goal);
    double lambda = 0;
    int iterations = 0;
    for (bool is_lower = true; is_lower && iterations < options_.max_iterations &&
                               current.max_gradient > 1e-12 * (1 + current.error);
         ++iterations) {
      is_lower = false;
      for (; !is_lower && lambda < 1e6 * (1 + current.error); lambda = std::max(4 * lambda, 1e-3)) {
        const auto step =
            newton_step(current.to_second_order, current.is_fixed, model_.size, lambda);
        if (!step) {
          continue;
        }
        const point next = point_at(within_limits(current.theta + *step), goal);
        // Near the minimum round-off hides a decrease of the error, but not of its gradient.
        const bool is_even = next.error <= current.error * (1 + 1e-14);
        is_lower = next.error < current.error * (1 - 1e-14) ||
                   (is_even && next.max_gradient < current.max_gradient);
        if (is_lower) {
          current = next;
        }
      }
      lambda = lambda < 1e-2 ? 0 : lambda / 16;
    }
    return {
        current.theta, current.residual, current.error, iterations, 0, stop_reason::out_of_reach};
  }

  struct point {
    vector theta;
    pose_error residual;
    double error; ///< squared distance of the origins plus |ω|²
    squared_error<Capacity> to_second_order;
    std::array<bool, std::size_t(Capacity)> is_fixed{}; ///< true if fixed at a limit that blocks it
    double max_gradient = 0; ///< largest entry of the gradient of joints that are not fixed
  };
  [[nodiscard]] point point_at(const vector& theta, const scaled_goal& goal) const {
    const equations x = equations_at(theta, goal);
    small_twist e = x.e;
    e.head<3>() = (goal.target->translation - x.at.tip.translation).eigen();
    point result{theta, x.residual, e.squaredNorm(), squared_error_of(x.at.jacobian, e)};
    for (Eigen::Index i = 0; i < Capacity; ++i) {
      const double gradient = result.to_second_order.gradient[i];
      const bool is_at_limit = period_[i] == 0 && (gradient > 0 ? theta[i] <= model_.lower[i]
                                                                : theta[i] >= model_.upper[i]);
      bool& is_fixed = result.is_fixed[std::size_t(i)];
      is_fixed = i >= model_.size || is_at_limit;
      result.max_gradient = std::max(result.max_gradient, is_fixed ? 0 : std::abs(gradient));
    }
    return result;
  }

  /// Revolute joints whose range contains a full turn are wrapped into it, others stop at limits.
  [[nodiscard]] vector within_limits(vector theta) const {
    for (Eigen::Index i = 0; i < model_.size; ++i) {
      const double lower = model_.lower[i], upper = model_.upper[i];
      const double x = period_[i] > 0 ? moved_by_full_turns(theta[i], lower, upper) : theta[i];
      theta[i] = std::clamp(x, lower, upper);
    }
    return theta;
  }

  const planning_model<Capacity>& model_;
  const inverse_kinematics_options& options_;
  const solution_preferences& preferences_;
  pose_tolerance tolerance_;
  vector period_; ///< changes of the coordinates that leave the pose unchanged: 0 or a full turn
  vector beyond_; ///< admissible excess of steps beyond limits: infinite if joints are wrapped
  vector spread_; ///< distance from the start of random coordinates that have no limits
  vector start_;
};

} // namespace

DUET_ABI_BEGIN

void solve_goals(const chain_view& chain, std::span<const goal_view> goals,
                 const Eigen::Ref<const Eigen::VectorXd>& start,
                 std::span<inverse_kinematics_result> out,
                 const inverse_kinematics_options& options, const execution& how,
                 const solution_preferences& preferences, bool is_one) {
  require(goals.size() == out.size(), "duet: inverse_kinematics: ", goals.size(),
          " goals, but room for ", out.size(), " results");
  with_capacity(chain.size(), [&]<int Capacity>(std::integral_constant<int, Capacity>) {
    const planning_model<Capacity> model(chain, preferences.around);
    const inverse_kinematics_search<Capacity> search(model, model.joints(start), options,
                                                     preferences);
    const auto name_of = [&](std::size_t i, const char* one = "the goal") {
      return is_one ? one : "goal " + std::to_string(i);
    };
    for (std::size_t i = 0; i < goals.size(); ++i) {
      if (goals[i].check) {
        goals[i].check(name_of(i, goals[i].pose != nullptr ? "the goal" : "the region"));
      }
    }
    parallel_for(
        goals.size(), [&](std::size_t i) { out[i] = search(goals[i], [&] { return name_of(i); }); },
        how);
  });
}

DUET_ABI_END
} // namespace duet::detail
