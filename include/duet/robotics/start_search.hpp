// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/limits.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/robotics/all_inverse_kinematics.hpp>
#include <duet/robotics/inverse_kinematics.hpp>
#include <duet/robotics/objective.hpp>
#include <duet/robotics/path_step.hpp>
#include <duet/robotics/start_candidates.hpp>
#include <duet/robotics/start_problem.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

/// \file
/// Search for a start configuration from which a chain can follow a path.

namespace duet::detail {

/// Search for a start configuration.
///
/// \tparam Capacity  capacity for joints
template <int Capacity>
class start_search {
  using joints = joint_vector<double, -Capacity>;
  using choice = start_search_result<-Capacity>;
  struct candidate {
    joints start;
    std::size_t rank; ///< rank in its family
    double cost;
  };

public:
  explicit start_search(const start_problem<Capacity>& problem)
      : problem_(problem), chain_(problem.chain), options_(problem.options),
        solutions_(chain_, problem.around, options_.plan.tolerance) {}

  [[nodiscard]] choice choose() const {
    choice result;
    std::vector<candidate> candidates = candidates_at(problem_.path(problem_.first));
    plan_options quick = options_.plan;
    quick.search_step = 0;
    for (std::size_t k = 0; k < candidates.size() && result.starts < options_.max_starts; ++k) {
      const joints start = candidates[k].start;
      auto plan = problem_.follow(start, quick);
      // If a joint stops at a limit, also try the start with this joint a full turn earlier.
      const joints other = moved_by_full_turns(start, plan);
      const bool is_known = std::any_of(candidates.begin(), candidates.end(),
                                        [&](const candidate& each) { return each.start == other; });
      if (!is_known && !std::isnan(cost(other))) {
        candidates.push_back({other, 1, 0});
      }
      if (keep(result, std::move(plan))) {
        return result;
      }
    }
    // Then try plans with self-motions, from one start of each family.
    for (const candidate& each : candidates) {
      const bool is_tried = options_.plan.search_step > 0 && chain_.size() > 6 && each.rank == 0;
      if (is_tried && keep(result, problem_.follow(each.start, options_.plan))) {
        return result;
      }
    }
    find_unsolved(result);
    return result;
  }

private:
  /// Keeps the better plan; true if it is the last one needed.
  static bool keep(choice& of, motion_plan<-Capacity> plan) {
    ++of.starts;
    if (of.plan.tau.empty() || plan.tau.back() > of.plan.tau.back() ||
        plan.reason == stop_reason::reached) {
      of.plan = std::move(plan);
      of.reason = of.plan.reason;
    }
    return of.reason == stop_reason::reached;
  }

  /// Candidates: the best of each family, then the second best and so on; without those near
  /// another one, and without those at which the objective is nan.
  ///
  /// \throws invalid_input if it is nan at all of them
  [[nodiscard]] std::vector<candidate> candidates_at(const dual_quaternion<double>& pose) const {
    std::vector<candidate> result;
    std::vector<joints> unknown;
    const auto is_before = [](const candidate& a, const candidate& b) {
      return a.rank != b.rank ? a.rank < b.rank : a.cost < b.cost;
    };
    for (const auto& family : solutions_.at(pose, options_.resolution)) {
      std::vector<candidate> all;
      for (const joints& x : family) {
        const double value = cost(x);
        if (std::isnan(value)) {
          unknown.push_back(x);
        } else {
          all.push_back({x, 0, value});
        }
      }
      std::sort(all.begin(), all.end(), is_before);
      std::vector<candidate> chosen;
      for (candidate& each : all) {
        const bool is_near = std::any_of(chosen.begin(), chosen.end(), [&](const candidate& other) {
          return (other.start - each.start).norm() < 2 * options_.resolution;
        });
        if (!is_near) {
          each.rank = chosen.size();
          chosen.push_back(each);
        }
      }
      result.insert(result.end(), chosen.begin(), chosen.end());
    }
    if (result.empty() && !unknown.empty()) {
      fail_not_a_number(
          "duet: find_start_configuration: the objective is nan at all starts, for example at the",
          unknown[0]);
    }
    std::sort(result.begin(), result.end(), is_before);
    return result;
  }

  [[nodiscard]] double cost(const joints& theta) const {
    return problem_.objective ? problem_.objective(theta) : distance_from_centre(theta);
  }

  /// Sum of squared distances of joints from the centre of their limits, relative to the range; of
  /// those without limits, from 0.
  [[nodiscard]] double distance_from_centre(const joints& theta) const {
    double sum = 0;
    for (int i = 0; i < chain_.size(); ++i) {
      const auto& limits = chain_.limits(i);
      const double range = limits.upper - limits.lower;
      const double x = range - range == 0 && range > 0 ? (theta[i] - limits.lower) / range - .5
                                                       : theta[i] / (4 * std::numbers::pi);
      sum += x * x;
    }
    return sum;
  }

  /// Start in which the joints that end at a limit in `plan` are moved a full turn away from it.
  [[nodiscard]] joints moved_by_full_turns(joints start, const motion_plan<-Capacity>& plan) const {
    constexpr double full_turn = 2 * std::numbers::pi, close = 1e-2;
    const joints& end = plan.joints.back();
    for (int i = 0; i < chain_.size() && plan.reason == stop_reason::joint_limit; ++i) {
      const auto& step = chain_.steps()[std::size_t(i)];
      const auto& limits = chain_.limits(i);
      if (!step.is_rotational || step.is_translational) {
        continue;
      }
      if (end[i] > limits.upper - close && start[i] - full_turn >= limits.lower) {
        start[i] -= full_turn;
      } else if (end[i] < limits.lower + close && start[i] + full_turn <= limits.upper) {
        start[i] += full_turn;
      }
    }
    return start;
  }

  void find_unsolved(choice& result) const {
    const double first = problem_.first, last = problem_.last;
    const path_function& path = problem_.path;
    joints nearby = result.plan.joints.empty() ? centre() : result.plan.joints.front();
    const auto is_solved = [&](double u) {
      const auto solution = solutions_.from(nearby, path(u), 100);
      if (solution.reason == stop_reason::reached) {
        nearby = solution.joints;
        return true;
      }
      return is_solved_otherwise(path(u));
    };
    const int count = int(std::ceil(1 / options_.sampling));
    const auto at = [&](int i) { return i == count ? last : first + (last - first) * i / count; };
    for (int i = 0; i <= count; ++i) {
      if (is_solved(at(i))) {
        continue;
      }
      double unsolved = at(i);
      for (double solved = at(std::max(0, i - 1)); unsolved - solved > 1e-6 * (last - first);) {
        const double u = (solved + unsolved) / 2;
        (is_solved(u) ? solved : unsolved) = u;
      }
      result.unsolved = unsolved;
      explain(result, path(unsolved));
      return;
    }
  }

  /// True if the complete solution set of six joints contains a solution that the iterative search
  /// missed.
  [[nodiscard]] bool is_solved_otherwise(const dual_quaternion<double>& pose) const {
    return is_algebraic(chain_, 6) && !solutions_.at(pose, options_.resolution).empty();
  }

  void explain(choice& result, const dual_quaternion<double>& pose) const {
    const auto solution = solutions_.from(centre(), pose, 100);
    result.is_certain = solution.reason == stop_reason::out_of_reach;
    result.reason = solution.reason;
    if (result.reason == stop_reason::out_of_reach || result.reason == stop_reason::obstacle) {
      return;
    }
    if (is_algebraic(chain_, 6)) {
      const auto all = all_inverse_kinematics(chain_, pose);
      result.is_certain = all.is_complete;
      result.reason = all.solutions.empty() ? stop_reason::no_solution : stop_reason::joint_limit;
      return;
    }
    const auto infinity = joints::Constant(chain_.size(), std::numeric_limits<double>::infinity());
    const auto without_limits = with_limits(chain_, joints(-infinity), joints(infinity));
    const auto beyond =
        inverse_kinematics(without_limits, pose, centre(), {.tolerance = options_.plan.tolerance});
    result.reason =
        beyond.reason == stop_reason::reached ? stop_reason::joint_limit : stop_reason::no_solution;
  }

  [[nodiscard]] joints centre() const {
    joints result(chain_.size());
    for (int i = 0; i < chain_.size(); ++i) {
      const double x = (chain_.limits(i).lower + chain_.limits(i).upper) / 2;
      result[i] = x - x == 0 ? x : std::clamp(0., chain_.limits(i).lower, chain_.limits(i).upper);
    }
    return result;
  }

  const start_problem<Capacity>& problem_;
  const serial_chain<-Capacity>& chain_;
  const start_options& options_;
  pose_solutions<Capacity> solutions_;
};

template <int Capacity>
[[nodiscard]] start_search_result<-Capacity> find_start(const start_problem<Capacity>& problem) {
  return start_search<Capacity>(problem).choose();
}

#ifdef DUET_COMPILED
DUET_COMPILED_TEMPLATE start_search_result<-16> find_start(const start_problem<16>&);
#endif

} // namespace duet::detail
