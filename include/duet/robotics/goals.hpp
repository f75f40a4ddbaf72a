// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/refused.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/parallel_for.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/robotics/clearance.hpp>
#include <duet/robotics/inverse_kinematics.hpp>
#include <duet/robotics/objective.hpp>
#include <duet/robotics/obstacle_steps.hpp>
#include <duet/robotics/planning_model.hpp>
#include <duet/robotics/pose_region.hpp>
#include <duet/robotics/solution_search.hpp>
#include <duet/robotics/solutions_within_limits.hpp>
#include <duet/robotics/tip_goal.hpp>

#include <cmath>
#include <concepts>
#include <cstddef>
#include <ranges>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

/// \file
/// Inverse kinematics with preferences: partial goals, preferred postures, null-space (secondary)
/// objectives, obstacles.

namespace duet {

namespace detail {

/// Objective and obstacle constraints for the joints of a chain.
///
/// \tparam Model  model of the chain, with or without obstacles
template <class C, class Model, class Objective>
class preferences_of final : public solution_preferences<joint_capacity(C::joints)> {
  static constexpr int capacity = joint_capacity(C::joints);

public:
  using typename solution_preferences<capacity>::vector;
  preferences_of(const Model& model, const Objective& objective)
      : model_(model), objective_(objective) {}

  [[nodiscard]] bool has_objective() const override {
    return !std::same_as<Objective, no_objective>;
  }
  [[nodiscard]] double objective(const small_vector<capacity>& theta) const override {
    if constexpr (std::same_as<Objective, no_objective>) {
      return 0;
    } else {
      return objective_(chain_joints(theta));
    }
  }
  [[nodiscard]] vector gradient(const small_vector<capacity>& theta) const override {
    if constexpr (std::same_as<Objective, no_objective>) {
      return vector::Zero(model_.size);
    } else {
      vector result = gradient_of(objective_, chain_joints(theta));
      for (int i = 0; i < model_.size; ++i) {
        result[i] *= model_.unit[i];
      }
      return result;
    }
  }
  [[nodiscard]] std::vector<inequality<vector>>
  clear_of_obstacles(const small_vector<capacity>& theta) const override {
    std::vector<inequality<vector>> result;
    if constexpr (requires { model_.margins(theta); }) {
      for (const auto& each : model_.margins(theta)) {
        result.push_back({each.normal, each.bound});
      }
    }
    return result;
  }

private:
  [[nodiscard]] auto chain_joints(const small_vector<capacity>& theta) const {
    return to_chain_joints(model_.chain(), model_.unscaled_joints(theta));
  }

  const Model& model_;
  const Objective& objective_;
};

/// Search for the preferred solutions of one goal after the other.
template <class C, class Start, class Objective, class Scene>
class preferred_solutions {
  static_assert(planning_types<Objective, Scene>::are_good);
  static constexpr int capacity = joint_capacity(C::joints);
  static constexpr bool is_among_obstacles = std::same_as<Scene, scene>;
  using model = std::conditional_t<is_among_obstacles, chain_with_obstacles<C>, chain_model<C>>;
  using result = inverse_kinematics_result<C::joints>;
  using known_solutions = typename solution_search<capacity>::known_solutions;
  static constexpr bool has_objective = !std::same_as<Objective, no_objective>;

public:
  /// \throws invalid_input for a start or a preferred posture of another size, and an invalid scene
  preferred_solutions(const C& chain, const Start& start, const inverse_kinematics_options& options,
                      const Objective& objective, const Scene& around)
      : start_(start), options_(options), model_((require_size(chain, start), chain), around),
        preferences_(model_, objective), search_(model_, model_.joints(start), options) {
    require_objective(objective, chain.size());
  }
  preferred_solutions(const preferred_solutions&) = delete;

  /// \param name  callable that returns the name of the goal for messages
  /// \throws invalid_input if the goal or the objective is nan at every configuration evaluated
  template <TipGoal G, class Name>
  [[nodiscard]] result operator()(const G& goal, const Name& name,
                                  const known_solutions& known = {}) const {
    constexpr bool has_preferences = has_objective || is_among_obstacles;
    const auto x = search_(tip_goal_of<G>(goal, model_.length),
                           has_preferences ? &preferences_ : nullptr, known);
    require_numbers(x, name);
    return {to_chain_joints(model_.chain(), model_.unscaled_joints_within_limits(x.joints)),
            model_.unscaled_error(x.residual), x.iterations, x.restarts, x.reason};
  }
  template <class Name>
  [[nodiscard]] result operator()(const dual_quaternion<double>& goal, const Name& name) const {
    if (model_.reach.is_beyond(model_.scaled_pose(goal), model_.tolerance(options_.tolerance))) {
      return inverse_kinematics(model_.chain(), goal, start_, options_);
    }
    return (*this)(full_pose_goal{to_tip_pose(normalized(goal))}, name, all_solutions(goal));
  }

private:
  /// All solutions of a six-joint chain, as candidates for an objective.
  [[nodiscard]] known_solutions all_solutions(const dual_quaternion<double>& goal) const {
    known_solutions known;
    if constexpr (has_objective) {
      if (is_algebraic(model_.chain(), 6)) {
        const auto all = solutions_within_limits(model_.chain(), goal, options_.tolerance);
        known.is_complete = all.is_complete;
        for (const auto& theta : all.joints) {
          known.joints.push_back(model_.joints(theta));
        }
      }
    }
    return known;
  }

  /// Rejects nan: the best candidate is nan only if all candidates are.
  template <class Name>
  void require_numbers(const typename solution_search<capacity>::attempt& x,
                       const Name& name) const {
    const auto fail = [&](const std::string& what) {
      fail_not_a_number("duet: inverse_kinematics: " + what,
                        to_chain_joints(model_.chain(), model_.unscaled_joints(x.joints)));
    };
    if ((std::isnan(x.residual.translation) || std::isnan(x.residual.rotation)) &&
        std::isfinite(length_of(model_.at(x.joints).tip.translation))) { // not by overflow
      fail(name() + " is nan at every configuration evaluated, for example at the");
    }
    if (x.reason == stop_reason::reached && std::isnan(preferences_.objective(x.joints))) {
      fail("the objective is nan at all solutions found, for example at the");
    }
  }

  const Start& start_;
  const inverse_kinematics_options& options_;
  model model_;
  preferences_of<C, model, Objective> preferences_;
  solution_search<capacity> search_;
};

/// \throws invalid_input for a region that contains no pose, and for a goal that is not a pose
template <class G>
void check_goal(const G& goal, const std::string& name) {
  if constexpr (std::same_as<G, dual_quaternion<double>>) {
    require_pose(goal, "inverse_kinematics", name);
  } else if constexpr (std::convertible_to<const G&, const task_space_region&>) {
    require_goal(goal, name);
  }
}

/// Preferred solutions of many goals: out[i] for goals[i].
template <class G, class C, class Start, class Objective, class Scene>
void find_preferred_solutions(const C& chain, std::span<const G> goals, const Start& start,
                              std::span<inverse_kinematics_result<C::joints>> out,
                              const inverse_kinematics_options& options, const execution& how,
                              const Objective& objective, const Scene& around) {
  require(goals.size() == out.size(), "duet: inverse_kinematics: ", goals.size(),
          " goals, but room for ", out.size(), " results");
  const preferred_solutions<C, Start, Objective, Scene> solve(chain, start, options, objective,
                                                              around);
  for (std::size_t i = 0; i < goals.size(); ++i) {
    check_goal(goals[i], "goal " + std::to_string(i));
  }
  parallel_for(
      goals.size(),
      [&](std::size_t i) { out[i] = solve(goals[i], [&] { return "goal " + std::to_string(i); }); },
      how);
}

} // namespace detail

/// Inverse kinematics for partial goals: joint coordinates within the limits of a chain at which
/// its tip frame satisfies a `task_space_region`, as returned by `position_goal`, `pointing_goal`
/// and others, or any `TipGoal`.
///
/// Damped least squares (Levenberg–Marquardt) as for poses, with the rows M of the constraint:
/// M J Δ = e. An objective (null-space or secondary objective) is minimised within all solutions
/// near each of the first `options.candidates` solutions found, and the joints with the smallest
/// value are returned: it acts on the freedom of a redundant arm or a partial goal. With a `scene`,
/// solutions nearby are sought that keep its margin, to `options.tolerance.translation`.
///
/// \param objective  function of θ, generic over scalars, or an object with a member
/// `gradient(theta)` too, such as `preferred_posture`; nan counts as larger than any number
/// \param around     `scene` of bodies and obstacles
/// \return the joints, as for poses; `deviation` is the error of the rows of lengths and of angles.
/// `obstacle`: the goal was reached, but only too close to obstacles; the joints are such a
/// configuration
/// \throws invalid_input as for poses, for a region that contains no pose, a preferred posture of
/// another size or not finite, an invalid `scene`, and, with the joints in the message, for a goal
/// that is nan at every configuration evaluated and an objective that is nan at all solutions found
template <SerialChain C, TipGoal G, VectorLike Start, class Objective = no_objective,
          class Scene = no_scene>
[[nodiscard]] inverse_kinematics_result<C::joints>
inverse_kinematics(const C& chain, const G& goal, const Start& start,
                   const inverse_kinematics_options& options = {}, const Objective& objective = {},
                   const Scene& around = {}) {
  const detail::preferred_solutions<C, Start, Objective, Scene> solve(chain, start, options,
                                                                      objective, around);
  detail::check_goal(goal, "the region");
  return solve(goal, [] { return std::string("the goal"); });
}

/// Inverse kinematics for a pose with an objective or among obstacles, as for partial goals: joint
/// coordinates within the limits at which the tip of a chain has the pose `goal`.
///
/// For six joints, revolute or up to three of them prismatic, an objective is minimised from all
/// solutions of `all_inverse_kinematics` within the limits, with any full turns that limits allow:
/// a `preferred_posture` gives the nearest solution of all if these are complete. At singular poses
/// with a self-motion, the search from random configurations is added.
template <SerialChain C, VectorLike Start, class Objective = no_objective, class Scene = no_scene>
[[nodiscard]] inverse_kinematics_result<C::joints>
inverse_kinematics(const C& chain, const dual_quaternion<double>& goal, const Start& start,
                   const inverse_kinematics_options& options, const Objective& objective,
                   const Scene& around = {}) {
  const detail::preferred_solutions<C, Start, Objective, Scene> solve(chain, start, options,
                                                                      objective, around);
  detail::check_goal(goal, "the goal");
  return solve(goal, [] { return std::string("the goal"); });
}

/// Inverse kinematics of many partial goals: out[i] = inverse_kinematics(chain, goals[i], start,
/// options, objective, around), with identical results for any number of threads.
///
/// \param goals      all of one type, in a vector, an array or a span
/// \param objective  as for one goal; with several threads it, and `constraint` of a user-defined
/// goal, is called concurrently
/// \throws invalid_input if the sizes differ, for the first goal that contains no pose, and as
/// above
/// \throws cancelled if `how.report` requests it, see `parallel_for_blocks`
template <SerialChain C, std::ranges::contiguous_range Goals, VectorLike Start,
          class Objective = no_objective, class Scene = no_scene>
  requires TipGoal<std::ranges::range_value_t<Goals>>
void inverse_kinematics(const C& chain, const Goals& goals, const Start& start,
                        std::span<inverse_kinematics_result<C::joints>> out,
                        const inverse_kinematics_options& options = {}, execution how = one_core,
                        const Objective& objective = {}, const Scene& around = {}) {
  using goal = std::ranges::range_value_t<Goals>;
  detail::find_preferred_solutions<goal>(chain, goals, start, out, options, how, objective, around);
}

/// Inverse kinematics of many poses: out[i] = inverse_kinematics(chain, goals[i], start, options,
/// objective, around), with identical results for any number of threads.
///
/// \throws invalid_input, cancelled: as for partial goals
template <SerialChain C, VectorLike Start, class Objective = no_objective, class Scene = no_scene>
void inverse_kinematics(const C& chain, std::span<const dual_quaternion<double>> goals,
                        const Start& start, std::span<inverse_kinematics_result<C::joints>> out,
                        const inverse_kinematics_options& options, execution how,
                        const Objective& objective, const Scene& around = {}) {
  detail::find_preferred_solutions(chain, goals, start, out, options, how, objective, around);
}

template <SerialChain C, TipGoal G>
DUET_REFUSED("the start is missing: inverse_kinematics(chain, goal, start)")
inverse_kinematics_result<C::joints> inverse_kinematics(const C&, const G&);

} // namespace duet
