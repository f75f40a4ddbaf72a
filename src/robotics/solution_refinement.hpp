// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "goal_equations.hpp"
#include "planning_model.hpp"
#include "quadratic_step.hpp"
#include "small_vector.hpp"
#include <duet/kinematics/motion_plan.hpp>
#include <duet/robotics/objective.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

/// \file
/// Refinement of a solution of a goal to one nearby that respects obstacle margins and minimises an
/// objective.

namespace duet::detail {
DUET_ABI_BEGIN

/// Sequential quadratic programming within the solutions of a goal: each step keeps goal, limits
/// and margins to first order, and Newton's method leads back to them. The curvature is that of the
/// function on the set of solutions, after Broyden, Fletcher, Goldfarb and Shanno (BFGS) with
/// Powell's damping, from the change of the projected gradient.
template <int Capacity>
class solution_refinement {
public:
  using joints = small_vector<Capacity>;
  using vector = bounded_vector<Capacity>;
  using matrix =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, Capacity, Capacity>;

  struct point {
    joints theta;
    pose_error residual;
    double error_ratio = 0; ///< largest deviation or margin violation, relative to the tolerance
    step_conditions<vector> conditions;
    double value = 0; ///< value of the objective
    vector gradient;
  };

  solution_refinement(const planning_model<Capacity>& model, const scaled_goal& goal,
                      const objective_view& objective, const pose_tolerance& tolerance)
      : model_(model), goal_(goal), objective_(objective), tolerance_(tolerance) {}

  /// Solution near a given configuration that keeps the margins too and, if there is an objective,
  /// minimises it locally. Nothing if that fails.
  [[nodiscard]] std::optional<point> operator()(const joints& theta, int iterations) const;

private:
  /// Maximum step in one direction, beyond which the first order is inaccurate.
  static constexpr double trusted = .5;

  [[nodiscard]] point at(const joints& theta) const {
    point x;
    x.theta = theta;
    const auto state = model_.at(theta);
    const twist_constraint constraint = goal_.constraint(state.tip);
    x.residual = residual_twist(constraint).residual;
    x.error_ratio = std::max(tolerance_.ratio(x.residual),
                             model_.margin_violation(theta) / tolerance_.translation);
    auto& more = x.conditions.inequalities;
    for (std::ptrdiff_t i = 0; i < 6; ++i) {
      if (constraint.matrix.row(i).isZero(0)) {
        continue;
      }
      const joints row = goal_row(constraint, i, state.jacobian);
      vector normal(model_.size);
      std::copy_n(row.values.begin(), model_.size, normal.begin());
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
    for (const auto& each : model_.margin_inequalities(theta)) {
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
    for (int i = 0; i < model_.size; ++i) {
      theta[i] = std::clamp(theta[i] + part * step[i], model_.lower[i], model_.upper[i]);
    }
    return theta;
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
      const Eigen::VectorXd chain_joints = model_.chain_joints(x->theta);
      x->value = objective_(chain_joints);
      x->gradient = objective_.gradient(chain_joints);
      for (int i = 0; i < model_.size; ++i) { // with respect to the planner's coordinates
        x->gradient[i] *= model_.unit[i];
      }
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
    vector s(model_.size);
    for (int i = 0; i < model_.size; ++i) {
      s[i] = after.theta[i] - before.theta[i];
    }
    s = gradient_after.active_rows(s);
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

template <int Capacity>
std::optional<typename solution_refinement<Capacity>::point>
solution_refinement<Capacity>::operator()(const joints& theta, int iterations) const {
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

DUET_ABI_END
} // namespace duet::detail
