// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/progress.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/chain_view.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/robotics/clearance.hpp>
#include <duet/robotics/goals.hpp>
#include <duet/robotics/objective.hpp>

#include <Eigen/Core>

#include <concepts>
#include <cstdint>
#include <ranges>
#include <span>
#include <vector>

/// \file
/// Inverse kinematics by damped least squares (Levenberg–Marquardt): joint coordinates for poses of
/// the tip frame (end-effector frame) and for partial goals, with preferred postures, null-space
/// (secondary) objectives and obstacles.

namespace duet {
DUET_ABI_BEGIN

/// Options of `inverse_kinematics`.
struct inverse_kinematics_options {
  /// Maximum error of the tip pose relative to the goal: units of length, and radians.
  pose_tolerance tolerance = 1e-6;
  /// Maximum number of random restarts if the search does not converge from the given start.
  int max_restarts = 100;
  /// Maximum number of iterations per attempt.
  int max_iterations = 50;
  /// Seed of the random configurations.
  std::uint64_t seed = 1;
  /// Number of solutions from which an objective is minimised; the best result is returned.
  int candidates = 10;
};

/// Result of `inverse_kinematics`; unless `reason` is `reached`, the configuration nearest to the
/// goal that was found.
struct inverse_kinematics_result {
  /// Joint coordinates within the limits: radians, or units of length for prismatic joints.
  Eigen::VectorXd joints = {};
  pose_error deviation; ///< error of the tip pose relative to the goal
  int iterations = 0;   ///< number of iterations of all attempts together
  int restarts = 0;     ///< number of random restarts
  /// Termination reason: `reached` if the tip is at the goal, otherwise what blocks the search.
  stop_reason reason = stop_reason::no_progress;

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("joints", joints);
    f("deviation", deviation);
    f("iterations", iterations);
    f("restarts", restarts);
    f("reason", reason);
  }
};

DUET_ABI_END
namespace detail {
DUET_ABI_BEGIN

/// Solutions, out[i] for goals[i]; messages name the goals by number, if `is_one` the goal.
void solve_goals(const chain_view& chain, std::span<const goal_view> goals,
                 const Eigen::Ref<const Eigen::VectorXd>& start,
                 std::span<inverse_kinematics_result> out,
                 const inverse_kinematics_options& options, const execution& how,
                 const solution_preferences& preferences, bool is_one);

template <class C, class Start, class Objective, class Scene>
void solve_many(const C& chain, std::span<const goal_view> goals, const Start& start,
                std::span<inverse_kinematics_result> out, const inverse_kinematics_options& options,
                const execution& how, const Objective& objective, const Scene& around,
                bool is_one = false) {
  const solution_preferences preferences = preferences_of(chain, objective, around);
  static_assert(
      std::same_as<Objective, no_objective> ||
          requires(const joint_vector<double, C::joints>& x) { double(objective(x)); },
      "duet: inverse_kinematics: the objective is not a function of the joint coordinates "
      "that returns a number");
  solve_goals(chain, goals, start_of(chain, start), out, options, how, preferences, is_one);
}

template <class C, class Start, class Objective, class Scene>
[[nodiscard]] inverse_kinematics_result solve_one(const C& chain, const goal_view& goal,
                                                  const Start& start,
                                                  const inverse_kinematics_options& options,
                                                  const Objective& objective, const Scene& around) {
  inverse_kinematics_result result;
  solve_many(chain, {&goal, 1}, start, {&result, 1}, options, one_core, objective, around, true);
  return result;
}

DUET_ABI_END
} // namespace detail

/// Inverse kinematics: joint coordinates θ within the limits of a chain at which its tip frame
/// (end-effector frame) has the pose `goal`, either sign of it, by damped least squares.
///
/// Damped least squares (Levenberg–Marquardt) on the exact twist e = 2 log(A_goal A*) in
/// `frame::hybrid`: Δ = Jᵀ(J Jᵀ + λI)⁻¹ e, with λ growing with |e|² after Sugihara. Joints that
/// would leave their limits are fixed there. The search starts from the initial guess `start` and,
/// once the error stops falling, from random configurations, which are identical in every call with
/// the same seed.
///
/// Objectives and obstacles act as for partial goals. For six joints, revolute or up to three of
/// them prismatic, an objective is minimised from all solutions of `all_inverse_kinematics` within
/// the limits, with any full turns that limits allow: a `preferred_posture` gives the nearest
/// solution of all if these are complete. At singular poses with a self-motion, the search from
/// random configurations is added.
///
/// \param start  initial guess, a nearby solution for a warm start; moved to within the limits,
/// revolute joints whose range contains a full turn by full turns
/// \return the joints; unless `reason` is `reached`, the configuration nearest to the goal that was
/// found. `out_of_reach` is certain; the joints are then those of the nearest pose and `deviation`
/// is its error: the minimum of (translation / L)² + rotation², L the sum of the chain's lengths,
/// by Newton's method from the start and `max_restarts` random configurations. The other reasons do
/// not prove that there is no solution: `joint_limit`, `singular` and `no_progress` state what
/// blocks the search there, `iteration_limit` that nothing does
/// \throws invalid_input for a start that is not finite or of another size, for a goal that is not
/// a pose, for invalid options, and for more than 100 joints
template <SerialChain C, VectorLike Start, class Objective = no_objective, class Scene = no_scene>
[[nodiscard]] inverse_kinematics_result
inverse_kinematics(const C& chain, const dual_quaternion<double>& goal, const Start& start,
                   const inverse_kinematics_options& options = {}, const Objective& objective = {},
                   const Scene& around = {}) {
  return detail::solve_one(chain, goal, start, options, objective, around);
}

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
[[nodiscard]] inverse_kinematics_result
inverse_kinematics(const C& chain, const G& goal, const Start& start,
                   const inverse_kinematics_options& options = {}, const Objective& objective = {},
                   const Scene& around = {}) {
  return detail::solve_one(chain, goal, start, options, objective, around);
}

/// Inverse kinematics of many goals: out[i] = inverse_kinematics(chain, goals[i], start, options,
/// objective, around), with identical results for any number of threads.
///
/// \param goals      poses, or partial goals of one type, in a vector, an array or a span
/// \param objective  as for one goal; with several threads it, and `constraint` of a user-defined
/// goal, is called concurrently
/// \throws invalid_input if the sizes differ, for the first goal that is not a pose or contains
/// none, and as above
/// \throws cancelled if `how.report` requests it, see `parallel_for_blocks`
template <SerialChain C, std::ranges::contiguous_range Goals, VectorLike Start,
          class Objective = no_objective, class Scene = no_scene>
  requires TipGoal<std::ranges::range_value_t<Goals>> ||
      std::same_as<std::ranges::range_value_t<Goals>, dual_quaternion<double>>
void inverse_kinematics(const C& chain, const Goals& goals, const Start& start,
                        std::span<inverse_kinematics_result> out,
                        const inverse_kinematics_options& options = {}, execution how = one_core,
                        const Objective& objective = {}, const Scene& around = {}) {
  const std::vector<detail::goal_view> views(std::ranges::begin(goals), std::ranges::end(goals));
  detail::solve_many(chain, views, start, out, options, how, objective, around);
}

DUET_ASKS_FOR_ONE_CONFIGURATION(inverse_kinematics, inverse_kinematics_result)

template <SerialChain C>
DUET_REFUSED("the start is missing: inverse_kinematics(chain, goal, start)")
inverse_kinematics_result inverse_kinematics(const C&, const dual_quaternion<double>&);
template <SerialChain C, TipGoal G>
DUET_REFUSED("the start is missing: inverse_kinematics(chain, goal, start)")
inverse_kinematics_result inverse_kinematics(const C&, const G&);
template <SerialChain C, VectorLike Start, class... More>
DUET_REFUSED("the goal precedes the start: inverse_kinematics(chain, goal, start)")
inverse_kinematics_result
    inverse_kinematics(const C&, const Start&, const dual_quaternion<double>&, const More&...);
template <SerialChain C, VectorLike Position, VectorLike Start, class... More>
DUET_REFUSED("for a position as the goal, pass position_goal(p) of duet/robotics/goals.hpp")
inverse_kinematics_result
    inverse_kinematics(const C&, const Position&, const Start&, const More&...);
template <SerialChain C, Real T, VectorLike Start, class... More>
DUET_REFUSED("the goal is a rotation without a position: pass pose(q, t)")
inverse_kinematics_result
    inverse_kinematics(const C&, const quaternion<T>&, const Start&, const More&...);

} // namespace duet
