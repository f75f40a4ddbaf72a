// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/mechanism/limits.hpp>
#include <duet/mechanism/serial_chain.hpp>
#include <duet/planning/all_inverse_kinematics.hpp>
#include <duet/planning/inverse_kinematics.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/path_step.hpp>
#include <duet/planning/start_candidates.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

/// \file
/// The search for a start from which a chain can follow a path.

namespace duet {

/// Settings of `choose_start`.
struct start_options {
  /// How paths are followed.
  plan_options plan = {};
  /// How many starts are tried at most.
  int starts = 64;
  /// From one configuration to the next at most, where seven joints move with the tip in place.
  double resolution = .3;
  /// From one pose to the next where poses without a solution are looked for, a fraction of the
  /// path.
  double sampling = .01;
};

/// What `choose_start` found.
///
/// \tparam N  as of `serial_chain`
template <int N>
struct start_choice {
  /// Along the path from the start that was chosen, `plan.joints.front()`; where none leads to its
  /// end, the one that comes farthest. Empty where no start has a solution.
  motion_plan<N> plan;
  int starts = 0; ///< how many were tried
  /// Where no start leads to the end: the first parameter, to 1e-6 of the path, at which no joint
  /// coordinates were found; nothing where all poses that were looked at have some.
  std::optional<double> unsolved;
  /// `reached`; else what is in the way there: at `unsolved`, or else of `plan`.
  stop_reason reason = stop_reason::no_solution;
  /// Is it certain that there is no solution at `unsolved`? Of six joints all are known.
  bool is_certain = false;

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("plan", plan);
    f("starts", starts);
    f("unsolved", unsolved.value_or(std::numeric_limits<double>::quiet_NaN()));
    f("reason", reason);
    f("is_certain", is_certain);
  }
};

namespace detail {

/// How far joints are from the middle of their limits, in parts of the range; of those without
/// limits, from 0.
template <class C, class X>
[[nodiscard]] double distance_from_middle(const C& chain, const X& theta) {
  double sum = 0;
  for (int i = 0; i < chain.size(); ++i) {
    const auto& limits = chain.limits(i);
    const double range = limits.upper - limits.lower;
    const double x = range - range == 0 && range > 0 ? (theta[i] - limits.lower) / range - .5
                                                     : theta[i] / (4 * std::numbers::pi);
    sum += x * x;
  }
  return sum;
}

/// \tparam Follow  start, options ↦ plan
template <class C, class Scene, class Follow>
class start_chooser {
  using solutions = pose_solutions<C, Scene>;
  using joints = typename solutions::joints;
  using choice = start_choice<C::joints>;
  struct candidate {
    joints start;
    std::size_t rank; ///< in its family
    double cost;
  };

public:
  start_chooser(const C& chain, const Scene& around, const start_options& options,
                const Follow& follow, std::function<double(const joints&)> cost)
      : chain_(chain), options_(options), follow_(follow), cost_(std::move(cost)),
        solutions_(chain, around, options.plan.tolerance) {}

  [[nodiscard]] choice operator()(const path_function& path, double first, double last) const {
    choice result;
    std::vector<candidate> candidates = candidates_at(path(first));
    plan_options quick = options_.plan;
    quick.search_step = 0;
    for (std::size_t k = 0; k < candidates.size() && result.starts < options_.starts; ++k) {
      const joints start = candidates[k].start;
      auto plan = follow_(start, quick);
      // Where a limit was in the way that joint begins anew a turn before it.
      const joints other = turned_back(start, plan);
      const bool is_known = std::any_of(candidates.begin(), candidates.end(),
                                        [&](const candidate& each) { return each.start == other; });
      if (!is_known) {
        candidates.push_back({other, 1, 0});
      }
      if (keep(result, std::move(plan))) {
        return result;
      }
    }
    // Then with motions in place, from one start of each family.
    for (const candidate& each : candidates) {
      const bool is_tried = options_.plan.search_step > 0 && chain_.size() > 6 && each.rank == 0;
      if (is_tried && keep(result, follow_(each.start, options_.plan))) {
        return result;
      }
    }
    find_unsolved(result, path, first, last);
    return result;
  }

private:
  /// Is that plan the last one wanted?
  static bool keep(choice& of, motion_plan<C::joints> plan) {
    ++of.starts;
    if (of.plan.tau.empty() || plan.tau.back() > of.plan.tau.back() ||
        plan.reason == stop_reason::reached) {
      of.plan = std::move(plan);
      of.reason = of.plan.reason;
    }
    return of.reason == stop_reason::reached;
  }

  /// The best of each family, then the second best …; what is near another one is left out.
  [[nodiscard]] std::vector<candidate> candidates_at(const dual_quaternion<double>& pose) const {
    std::vector<candidate> result;
    const auto is_before = [](const candidate& a, const candidate& b) {
      return a.rank != b.rank ? a.rank < b.rank : a.cost < b.cost;
    };
    for (const auto& family : solutions_.at(pose, options_.resolution)) {
      std::vector<candidate> all;
      for (const joints& x : family) {
        all.push_back({x, 0, cost_(x)});
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
    std::sort(result.begin(), result.end(), is_before);
    return result;
  }

  /// The start with the joints that a plan ends with at a limit a whole turn away from it.
  [[nodiscard]] joints turned_back(joints start, const motion_plan<C::joints>& plan) const {
    constexpr double turn = 2 * std::numbers::pi, close = 1e-2;
    const joints& end = plan.joints.back();
    for (int i = 0; i < chain_.size() && plan.reason == stop_reason::joint_limit; ++i) {
      const auto& step = chain_.steps()[std::size_t(i)];
      const auto& limits = chain_.limits(i);
      if (!step.turns || step.slides) {
        continue;
      }
      if (end[i] > limits.upper - close && start[i] - turn >= limits.lower) {
        start[i] -= turn;
      } else if (end[i] < limits.lower + close && start[i] + turn <= limits.upper) {
        start[i] += turn;
      }
    }
    return start;
  }

  void find_unsolved(choice& result, const path_function& path, double first, double last) const {
    joints nearby = result.plan.joints.empty() ? middle() : result.plan.joints.front();
    const auto is_solved = [&](double u) {
      const auto found = solutions_.from(nearby, path(u), 100);
      if (found.reason == stop_reason::reached) {
        nearby = found.joints;
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

  /// What a search for one solution did not find all six joints' solutions may have.
  [[nodiscard]] bool is_solved_otherwise(const dual_quaternion<double>& pose) const {
    if constexpr (C::joints == 6 || C::joints < 0) {
      return is_algebraic(chain_, 6) && !solutions_.at(pose, options_.resolution).empty();
    }
    return false;
  }

  void explain(choice& result, const dual_quaternion<double>& pose) const {
    const auto found = solutions_.from(middle(), pose, 100);
    result.is_certain = found.reason == stop_reason::out_of_reach;
    result.reason = found.reason;
    if (result.reason == stop_reason::out_of_reach || result.reason == stop_reason::obstacle) {
      return;
    }
    if constexpr (C::joints == 6 || C::joints < 0) {
      if (is_algebraic(chain_, 6)) {
        const auto all = all_inverse_kinematics(chain_, pose);
        result.is_certain = all.is_complete;
        result.reason = all.solutions.empty() ? stop_reason::no_solution : stop_reason::joint_limit;
        return;
      }
    }
    const auto infinity = joints::Constant(chain_.size(), std::numeric_limits<double>::infinity());
    const auto without_limits = with_limits(chain_, joints(-infinity), joints(infinity));
    const auto beyond =
        inverse_kinematics(without_limits, pose, middle(), {.tolerance = options_.plan.tolerance});
    result.reason =
        beyond.reason == stop_reason::reached ? stop_reason::joint_limit : stop_reason::no_solution;
  }

  [[nodiscard]] joints middle() const {
    joints result(chain_.size());
    for (int i = 0; i < chain_.size(); ++i) {
      const double x = (chain_.limits(i).lower + chain_.limits(i).upper) / 2;
      result[i] = x - x == 0 ? x : std::clamp(0., chain_.limits(i).lower, chain_.limits(i).upper);
    }
    return result;
  }

  const C& chain_;
  const start_options& options_;
  const Follow& follow_;
  std::function<double(const joints&)> cost_;
  solutions solutions_;
};

} // namespace detail
} // namespace duet
