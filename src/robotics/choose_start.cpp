// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "branches/loop_equation.hpp"
#include "planning_model.hpp"
#include "splitmix64.hpp"

#include <duet/core/errors.hpp>
#include <duet/kinematics/adapted.hpp>
#include <duet/robotics/all_inverse_kinematics.hpp>
#include <duet/robotics/choose_start.hpp>
#include <duet/robotics/inverse_kinematics.hpp>
#include <duet/robotics/self_motion_curves.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace duet::detail {
namespace {

/// \throws invalid_input
void require_options(const start_options& o) {
  require_positive("find_start_configuration", "max_starts", o.max_starts);
  const auto require_part = [](const char* name, double value) {
    require_option("find_start_configuration", name, value, value > 0 && value <= 1,
                   "within (0, 1]");
  };
  require_part("resolution", o.resolution);
  require_part("sampling", o.sampling);
}

/// Search for a start configuration.
class start_search {
  using joints = Eigen::VectorXd;
  using choice = start_search_result;
  /// Solutions that are connected by self-motions.
  using family = std::vector<joints>;
  struct candidate {
    joints start;
    std::size_t rank; ///< rank in its family
    double cost;
  };

public:
  start_search(const chain_view& chain, const path_function& path, const std::vector<double>& stops,
               const start_options& options, const solution_preferences& preferences)
      : chain_(chain), path_(path), stops_(stops), options_(options), preferences_(preferences) {}

  [[nodiscard]] choice choose() const {
    choice result;
    std::vector<candidate> candidates = candidates_at(path_(stops_.front()));
    plan_options quick = options_.plan;
    quick.search_step = 0;
    for (std::size_t k = 0; k < candidates.size() && result.starts < options_.max_starts; ++k) {
      const joints start = candidates[k].start;
      auto plan = follow_from(start, quick);
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
      if (is_tried && keep(result, follow_from(each.start, options_.plan))) {
        return result;
      }
    }
    find_unsolved(result);
    return result;
  }

private:
  /// All solutions of six joints; of seven joints points of their self-motion curves, a
  /// `resolution` apart; of others, and where these find none or not all, those that random starts
  /// find.
  [[nodiscard]] std::vector<family> solutions_at(const dual_quaternion<double>& goal) const {
    std::vector<family> result;
    bool is_complete = false;
    if (is_algebraic(chain_, 6)) {
      const auto all = all_inverse_kinematics(chain_, goal);
      is_complete = all.is_complete;
      for (const auto& branch : all.solutions) {
        add(result, {branch.joints});
      }
    } else if (is_algebraic(chain_, 7)) {
      for (const auto& curve :
           self_motion_curves(chain_, goal, {.resolution = options_.resolution})) {
        add(result, curve.joints);
      }
      is_complete = !result.empty();
    }
    splitmix64 random(1);
    for (int i = 0; i < 100 && !is_complete; ++i) {
      const auto solution = solution_from(configuration(random), goal, 0, 1e-3);
      if (solution.reason == stop_reason::reached && is_new(solution.joints, result)) {
        add(result, {solution.joints});
      }
    }
    return result;
  }

  /// One solution, or the reason for its absence.
  ///
  /// \param part  fraction of the tolerance
  [[nodiscard]] inverse_kinematics_result solution_from(const joints& start,
                                                        const dual_quaternion<double>& goal,
                                                        int restarts, double part = 1) const {
    const inverse_kinematics_options options{
        .tolerance = {part * options_.plan.tolerance.translation,
                      part * options_.plan.tolerance.rotation},
        .max_restarts = restarts};
    return preferences_.around == nullptr
               ? inverse_kinematics(chain_, goal, start, options)
               : inverse_kinematics(chain_, goal, start, options, no_objective{},
                                    *preferences_.around);
  }

  /// Adds those of a family that are within their limits, moved into them by full turns, and clear
  /// of obstacles.
  void add(std::vector<family>& to, const family& all) const {
    const scene* const around = preferences_.around;
    family good;
    for (joints theta : all) {
      bool is_good = true;
      for (int i = 0; i < chain_.size(); ++i) {
        const auto& step = chain_.steps()[std::size_t(i)];
        const joint_limits<double> limits = chain_.limits(i);
        if (step.is_rotational && !step.is_translational) {
          theta[i] = wrap_into_limits(theta[i], limits);
        }
        is_good = is_good && limits.lower <= theta[i] && theta[i] <= limits.upper;
      }
      if (is_good &&
          (around == nullptr || clearance(chain_, theta, *around).distance >=
                                    around->margin - options_.plan.tolerance.translation)) {
        good.push_back(theta);
      }
    }
    if (!good.empty()) {
      to.push_back(std::move(good));
    }
  }
  [[nodiscard]] static bool is_new(const joints& theta, const std::vector<family>& others) {
    return std::none_of(others.begin(), others.end(), [&](const family& other) {
      return (other.front() - theta).cwiseAbs().maxCoeff() < 1e-3;
    });
  }
  [[nodiscard]] joints configuration(splitmix64& random) const {
    joints theta(chain_.size());
    for (int i = 0; i < chain_.size(); ++i) {
      const auto& limits = chain_.limits(i);
      const double lower = std::max(limits.lower, std::min(-std::numbers::pi, limits.upper));
      const double upper = std::min(limits.upper, std::max(std::numbers::pi, limits.lower));
      theta[i] = lower + (upper - lower) * random();
    }
    return theta;
  }

  [[nodiscard]] motion_plan follow_from(const joints& start, const plan_options& how) const {
    require_start(chain_, start, "follow_path");
    return follow(chain_, start, path_, stops_, how, preferences_);
  }

  /// Keeps the better plan; true if it is the last one needed.
  static bool keep(choice& of, motion_plan plan) {
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
    for (const family& found : solutions_at(pose)) {
      std::vector<candidate> all;
      for (const joints& x : found) {
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
    return preferences_.objective ? preferences_.objective(theta) : distance_from_centre(theta);
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
  [[nodiscard]] joints moved_by_full_turns(joints start, const motion_plan& plan) const {
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
    const double first = stops_.front(), last = stops_.back();
    joints nearby = result.plan.joints.empty() ? centre() : result.plan.joints.front();
    const auto is_solved = [&](double u) {
      const auto solution = solution_from(nearby, path_(u), 100);
      if (solution.reason == stop_reason::reached) {
        nearby = solution.joints;
        return true;
      }
      // The iterative search may miss solutions that are in the complete set of six joints.
      return is_algebraic(chain_, 6) && !solutions_at(path_(u)).empty();
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
      explain(result, path_(unsolved));
      return;
    }
  }

  void explain(choice& result, const dual_quaternion<double>& pose) const {
    const auto solution = solution_from(centre(), pose, 100);
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
    const joints upper = joints::Constant(chain_.size(), std::numeric_limits<double>::infinity());
    const auto without_limits =
        with_limits(bounded_chain<max_capacity>(chain_), joints(-upper), upper);
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

  const chain_view& chain_;
  const path_function& path_;
  const std::vector<double>& stops_;
  const start_options& options_;
  const solution_preferences& preferences_;
};

} // namespace

DUET_ABI_BEGIN

start_search_result find_start(const chain_view& chain, const path_function& path,
                               const std::vector<double>& stops, const start_options& options,
                               const solution_preferences& preferences) {
  require_options(options);
  if (preferences.around != nullptr) {
    require_scene(chain, *preferences.around);
  }
  return start_search(chain, path, stops, options, preferences).choose();
}

DUET_ABI_END
} // namespace duet::detail
