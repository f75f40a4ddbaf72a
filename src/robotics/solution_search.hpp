// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "goal_equations.hpp"
#include "inverse_kinematics_search.hpp"
#include "planning_model.hpp"
#include "small_vector.hpp"
#include "solution_refinement.hpp"
#include "splitmix64.hpp"
#include <duet/kinematics/motion_plan.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

/// \file
/// Search for the preferred solution of a goal.

namespace duet::detail {
DUET_ABI_BEGIN

/// Search for solutions from the start and from random configurations, of which each is refined by
/// `solution_refinement`.
template <int Capacity>
class solution_search {
  using search = inverse_kinematics_search<Capacity, scaled_goal>;

public:
  using attempt = typename search::attempt;

  solution_search(const planning_model<Capacity>& model, const small_vector<Capacity>& start,
                  const inverse_kinematics_options& options)
      : model_(model), options_(options), tolerance_(model.tolerance(options.tolerance)),
        search_(model, start, options) {}

  /// Solutions within the limits, up to full turns, that are known before the search.
  struct known_solutions {
    std::vector<small_vector<Capacity>> joints;
    bool is_complete = false; ///< true if there are no others
  };

  /// \param is_choosy  false if the first solution is as good as any
  [[nodiscard]] attempt operator()(const scaled_goal& goal, const objective_view& objective,
                                   bool is_choosy, const known_solutions& known = {}) const;

private:
  /// Joints moved by full turns within the limits as long as that lowers the objective.
  [[nodiscard]] small_vector<Capacity>
  improved_by_full_turns(small_vector<Capacity> theta, const objective_view& objective) const {
    constexpr double max_change = 0x1p20;
    double min_value = objective(model_.chain_joints(theta));
    const auto is_lower_by = [&](int i, double change) {
      small_vector<Capacity> other = theta;
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
      const double period = search_.period()[i];
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

  const planning_model<Capacity>& model_;
  inverse_kinematics_options options_;
  pose_tolerance tolerance_;
  search search_;
};

template <int Capacity>
typename solution_search<Capacity>::attempt
solution_search<Capacity>::operator()(const scaled_goal& goal, const objective_view& objective,
                                      bool is_choosy, const known_solutions& known) const {
  if (!is_choosy || is_beyond(model_.reach, goal, tolerance_)) {
    return search_(goal);
  }
  const solution_refinement<Capacity> refine(model_, goal, objective, tolerance_);
  attempt best{search_.start(), {}, std::numeric_limits<double>::infinity()};
  double min_value = std::numeric_limits<double>::infinity(); // of the objective
  int iterations = 0, candidates = 0, restarts = 0;
  const auto consider = [&](small_vector<Capacity> theta) {
    constexpr int rounds = 4; // after self-motions other full turns may be better
    std::optional<typename solution_refinement<Capacity>::point> refined;
    for (int k = 0; k < rounds; ++k) {
      const auto other = objective ? improved_by_full_turns(theta, objective) : theta;
      if (refined && norm(other - theta) == 0) {
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
  for (const small_vector<Capacity>& theta : known.joints) {
    consider(theta);
  }
  if (known.is_complete && best.reason == stop_reason::reached) {
    return best;
  }
  splitmix64 random(options_.seed);
  for (;; ++restarts) {
    attempt next =
        search_.approach(restarts == 0 ? search_.start() : search_.configuration(random), goal);
    iterations += next.iterations;
    if (next.reason == stop_reason::reached) {
      candidates += consider(next.joints);
      next.reason = stop_reason::obstacle;
    }
    if (best.reason != stop_reason::reached && (restarts == 0 || is_less(next.error, best.error))) {
      best = next;
    }
    if (restarts == options_.max_restarts || candidates == options_.candidates ||
        (candidates == 1 && !objective)) {
      break;
    }
  }
  if (best.reason == stop_reason::no_progress) {
    best.reason = search_.obstacle(best.joints, goal);
  }
  best.iterations = iterations;
  best.restarts = restarts;
  return best;
}

DUET_ABI_END
} // namespace duet::detail
