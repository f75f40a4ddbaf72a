// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "goal_equations.hpp"
#include "inverse_kinematics_search.hpp"
#include "planning_model.hpp"
#include "solution_search.hpp"
#include "solutions_within_limits.hpp"

#include <duet/core/errors.hpp>
#include <duet/core/parallel_for.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <type_traits>

namespace duet::detail {
namespace {

template <int Capacity, class Attempt>
[[nodiscard]] inverse_kinematics_result result_of(const planning_model<Capacity>& model,
                                                  const Attempt& x) {
  return {model.joints_within_limits(x.joints), model.unscaled_error(x.residual), x.iterations,
          x.restarts, x.reason};
}

/// Search for the preferred solutions of one goal after the other.
template <int Capacity>
class preferred_solutions {
  using known_solutions = typename solution_search<Capacity>::known_solutions;

public:
  preferred_solutions(const planning_model<Capacity>& model, const small_vector<Capacity>& start,
                      const inverse_kinematics_options& options,
                      const solution_preferences& preferences)
      : model_(model), options_(options), preferences_(preferences), any_(model, start, options),
        search_(model, start, options) {}

  /// \param name  callable that returns the name of the goal for messages
  /// \throws invalid_input if the goal or the objective is nan at every configuration evaluated
  template <class Name>
  [[nodiscard]] inverse_kinematics_result solve(const goal_view& goal, const Name& name,
                                                const known_solutions& known = {}) const {
    const auto x = search_(scaled_goal{goal, model_.length}, preferences_.objective,
                           !preferences_.is_empty(), known);
    require_numbers(x, name);
    return result_of(model_, x);
  }
  template <class Name>
  [[nodiscard]] inverse_kinematics_result solve(const dual_quaternion<double>& goal,
                                                const Name& name) const {
    const tip_pose scaled = model_.scaled_pose(normalized(goal));
    if (model_.reach.is_beyond(scaled, model_.tolerance(options_.tolerance))) {
      return result_of(model_, any_(scaled));
    }
    const full_pose_goal full{to_tip_pose(normalized(goal))};
    return solve(goal_view(full), name, all_solutions(goal));
  }

private:
  /// All solutions of a six-joint chain, as candidates for an objective.
  [[nodiscard]] known_solutions all_solutions(const dual_quaternion<double>& goal) const {
    known_solutions known;
    if (preferences_.objective && is_algebraic(model_.chain(), 6)) {
      const auto all = solutions_within_limits(model_.chain(), goal, options_.tolerance);
      known.is_complete = all.is_complete;
      for (const auto& theta : all.joints) {
        known.joints.push_back(model_.joints(theta));
      }
    }
    return known;
  }

  /// Rejects nan: the best candidate is nan only if all candidates are.
  template <class Name>
  void require_numbers(const typename solution_search<Capacity>::attempt& x,
                       const Name& name) const {
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

  const planning_model<Capacity>& model_;
  const inverse_kinematics_options& options_;
  const solution_preferences& preferences_;
  inverse_kinematics_search<Capacity> any_;
  solution_search<Capacity> search_;
};

void require_same_size(std::size_t goals, std::size_t results) {
  require(goals == results, "duet: inverse_kinematics: ", goals, " goals, but room for ", results,
          " results");
}

template <class Check>
void check_goals(std::size_t count, bool is_one, const char* name_of_one, const Check& check) {
  for (std::size_t i = 0; i < count; ++i) {
    check(i, is_one ? name_of_one : "goal " + std::to_string(i));
  }
}

template <class Goal>
void solve_preferred(const chain_view& chain, std::span<const Goal> goals,
                     const Eigen::Ref<const Eigen::VectorXd>& start,
                     std::span<inverse_kinematics_result> out,
                     const inverse_kinematics_options& options, const execution& how,
                     const solution_preferences& preferences, bool is_one) {
  with_capacity(chain.size(), [&]<int Capacity>(std::integral_constant<int, Capacity>) {
    const planning_model<Capacity> model(chain, preferences.around);
    const preferred_solutions<Capacity> solutions(model, model.joints(start), options, preferences);
    check_goals(goals.size(), is_one, std::is_same_v<Goal, goal_view> ? "the region" : "the goal",
                [&](std::size_t i, const std::string& name) {
                  if constexpr (std::is_same_v<Goal, goal_view>) {
                    goals[i].check(name);
                  } else {
                    require_pose(goals[i], "inverse_kinematics", name);
                  }
                });
    parallel_for(
        goals.size(),
        [&](std::size_t i) {
          out[i] = solutions.solve(goals[i], [&] {
            return is_one ? std::string("the goal") : "goal " + std::to_string(i);
          });
        },
        how);
  });
}

} // namespace

DUET_ABI_BEGIN

void solve_poses(const chain_view& chain, std::span<const dual_quaternion<double>> goals,
                 const Eigen::Ref<const Eigen::VectorXd>& start,
                 std::span<inverse_kinematics_result> out,
                 const inverse_kinematics_options& options, const execution& how,
                 const solution_preferences& preferences, bool is_one) {
  require_same_size(goals.size(), out.size());
  if (!preferences.is_empty()) {
    solve_preferred(chain, goals, start, out, options, how, preferences, is_one);
    return;
  }
  with_capacity(chain.size(), [&]<int Capacity>(std::integral_constant<int, Capacity>) {
    const planning_model<Capacity> model(chain);
    const inverse_kinematics_search<Capacity> search(model, model.joints(start), options);
    check_goals(goals.size(), is_one, "the goal", [&](std::size_t i, const std::string& name) {
      require_pose(goals[i], "inverse_kinematics", name);
    });
    parallel_for(
        goals.size(),
        [&](std::size_t i) {
          out[i] = result_of(model, search(model.scaled_pose(normalized(goals[i]))));
        },
        how);
  });
}

void solve_goals(const chain_view& chain, std::span<const goal_view> goals,
                 const Eigen::Ref<const Eigen::VectorXd>& start,
                 std::span<inverse_kinematics_result> out,
                 const inverse_kinematics_options& options, const execution& how,
                 const solution_preferences& preferences, bool is_one) {
  require_same_size(goals.size(), out.size());
  solve_preferred(chain, goals, start, out, options, how, preferences, is_one);
}

DUET_ABI_END
} // namespace duet::detail
