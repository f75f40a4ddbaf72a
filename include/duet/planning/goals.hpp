// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/refused.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/mechanism/serial_chain.hpp>
#include <duet/planning/clearance.hpp>
#include <duet/planning/inverse_kinematics.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/objective.hpp>
#include <duet/planning/obstacle_steps.hpp>
#include <duet/planning/planning_model.hpp>
#include <duet/planning/pose_region.hpp>
#include <duet/planning/solution_search.hpp>
#include <duet/planning/tip_goal.hpp>
#include <duet/quaternion/norm.hpp>

#include <concepts>
#include <type_traits>
#include <vector>

/// \file
/// The solution of inverse kinematics that one wants: goals in part, preferred postures,
/// objectives, obstacles.

namespace duet {

namespace detail {

/// Wishes for the joints of a chain.
/// \tparam Model  of the chain, among obstacles or not
template <class C, class Model, class Objective>
class wishes_of final : public solution_wishes<joint_room(C::joints)> {
  static constexpr int room = joint_room(C::joints);

public:
  using typename solution_wishes<room>::vector;
  wishes_of(const Model& model, const Objective& objective)
      : model_(model), objective_(objective) {}

  [[nodiscard]] bool has_objective() const override {
    return !std::same_as<Objective, no_objective>;
  }
  [[nodiscard]] double objective(const small_vector<room>& theta) const override {
    if constexpr (std::same_as<Objective, no_objective>) {
      return 0;
    } else {
      return objective_(given(theta));
    }
  }
  [[nodiscard]] vector slope(const small_vector<room>& theta) const override {
    if constexpr (std::same_as<Objective, no_objective>) {
      return vector::Zero(model_.size);
    } else {
      vector result = slope_of(objective_, given(theta));
      for (int i = 0; i < model_.size; ++i) {
        result[i] *= model_.unit[i];
      }
      return result;
    }
  }
  [[nodiscard]] std::vector<inequality<vector>>
  clear_of_obstacles(const small_vector<room>& theta) const override {
    std::vector<inequality<vector>> result;
    if constexpr (requires { model_.margins(theta); }) {
      for (const auto& each : model_.margins(theta)) {
        result.push_back({each.normal, each.bound});
      }
    }
    return result;
  }

private:
  [[nodiscard]] auto given(const small_vector<room>& theta) const {
    return own_joints(model_.chain(), model_.given_joints(theta));
  }

  const Model& model_;
  const Objective& objective_;
};

template <class C, TipGoal G, class Start, class Objective, class Scene>
[[nodiscard]] inverse_kinematics_result<C::joints>
wanted_solution(const C& chain, const G& goal, const Start& start,
                const inverse_kinematics_options& options, const Objective& objective,
                const Scene& around) {
  constexpr int room = joint_room(C::joints);
  require_size(chain, start);
  require_objective(objective, chain.size());
  using model_of_chain =
      std::conditional_t<std::same_as<Scene, scene>, chain_among_obstacles<C>, chain_model<C>>;
  const model_of_chain model(chain, around);
  const wishes_of<C, model_of_chain, Objective> wishes(model, objective);
  const solution_search<room> search(model, model.joints(start), options);
  constexpr bool has_wishes = !std::same_as<Objective, no_objective> || std::same_as<Scene, scene>;
  const auto x = search(tip_goal_of<G>(goal, model.length), has_wishes ? &wishes : nullptr);
  return {own_joints(chain, model.given_joints_within_limits(x.joints)),
          model.given_deviation(x.left), x.iterations, x.restarts, x.reason};
}

} // namespace detail

/// Joint coordinates within the limits of a chain that take its tip to a goal in part: a
/// `pose_region`, as `position_goal`, `pointing_goal` and others make it, or any `TipGoal`.
///
/// As for poses, with the rows M of what is wanted, M J Δ = e. With an objective, from the first
/// `options.candidates` solutions that are met with it is lowered within all solutions nearby, and
/// the joints where it is least are returned. With a `scene` solutions nearby are looked for that
/// keep its margin, to `options.tolerance.length`.
///
/// \param objective  a function of θ, generic over scalars, or something with a member
///                   `gradient(theta)` too, as `preferred_posture`
/// \param around     a `scene`
/// \return the joints, as of poses; `deviation` is what rows of lengths and of angles miss.
/// `obstacle`: the goal was reached, but too close to obstacles; the joints are such ones
/// \throws invalid_input as for poses, for a region that holds no pose, a preferred posture of
/// another size or not finite and a `scene` that is none
template <SerialChain C, TipGoal G, VectorLike Start, class Objective = no_objective,
          class Scene = no_scene>
[[nodiscard]] inverse_kinematics_result<C::joints>
inverse_kinematics(const C& chain, const G& goal, const Start& start,
                   const inverse_kinematics_options& options = {}, const Objective& objective = {},
                   const Scene& around = {}) {
  if constexpr (requires { detail::require_goal(goal); }) {
    detail::require_goal(goal);
  }
  return detail::wanted_solution(chain, goal, start, options, objective, around);
}

/// Joint coordinates that take the tip of a chain to a pose, with an objective or among obstacles
/// as for goals in part.
template <SerialChain C, VectorLike Start, class Objective, class Scene = no_scene>
[[nodiscard]] inverse_kinematics_result<C::joints>
inverse_kinematics(const C& chain, const dual_quaternion<double>& goal, const Start& start,
                   const inverse_kinematics_options& options, const Objective& objective,
                   const Scene& around = {}) {
  detail::require_pose(goal, "inverse_kinematics", "the goal");
  detail::require_size(chain, start);
  detail::require_objective(objective, chain.size());
  const detail::whole_pose whole{detail::place_of(normalized(goal))};
  const detail::chain_model<C> model(chain);
  if (model.reach.is_beyond(model.place(goal), model.tolerance(options.tolerance))) {
    return inverse_kinematics(chain, goal, start, options);
  }
  return detail::wanted_solution(chain, whole, start, options, objective, around);
}

template <SerialChain C, TipGoal G>
DUET_REFUSED("from which joints on? inverse_kinematics(chain, goal, start)")
inverse_kinematics_result<C::joints> inverse_kinematics(const C&, const G&);

} // namespace duet
