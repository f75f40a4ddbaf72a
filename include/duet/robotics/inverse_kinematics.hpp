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
#include <duet/robotics/inverse_kinematics_search.hpp>
#include <duet/robotics/planning_model.hpp>

#include <cstddef>
#include <span>
#include <string>

/// \file
/// Inverse kinematics by damped least squares (Levenberg–Marquardt): joint coordinates for poses of
/// the tip frame (end-effector frame).

namespace duet {

namespace detail {

/// Inverse kinematics search on a chain; results have the vector type of the chain.
template <class C>
class search_on_chain {
public:
  /// \throws invalid_input for a start whose size is not the number of joints
  template <class Start>
  search_on_chain(const C& chain, const Start& start, const inverse_kinematics_options& options)
      : model_((require_size(chain, start), chain)),
        search_(model_, model_.joints(start), options) {}
  search_on_chain(const search_on_chain&) = delete;

  /// \param goal  a pose
  [[nodiscard]] inverse_kinematics_result<C::joints>
  operator()(const dual_quaternion<double>& goal) const {
    const auto x = search_(model_.scaled_pose(normalized(goal)));
    return {to_chain_joints(model_.chain(), model_.unscaled_joints_within_limits(x.joints)),
            model_.unscaled_error(x.residual), x.iterations, x.restarts, x.reason};
  }

private:
  chain_model<C> model_;
  inverse_kinematics_search<joint_capacity(C::joints)> search_;
};

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
/// \param start  initial guess, a nearby solution for a warm start; moved to within the limits,
/// revolute joints whose range contains a full turn by full turns
/// \return the joints; unless `reason` is `reached`, the configuration nearest to the goal that was
/// found. `out_of_reach` is certain; the joints are then those of the nearest pose and `deviation`
/// is its error: the minimum of (translation / L)² + rotation², L the sum of the chain's lengths,
/// by Newton's method from the start and `max_restarts` random configurations. The other reasons do
/// not prove that there is no solution: `joint_limit`, `singular` and `no_progress` state what
/// blocks the search there, `iteration_limit` that nothing does
/// \throws invalid_input for a start that is not finite or of another size, for a goal that is not
/// a pose, and for invalid options
template <SerialChain C, VectorLike Start>
[[nodiscard]] inverse_kinematics_result<C::joints>
inverse_kinematics(const C& chain, const dual_quaternion<double>& goal, const Start& start,
                   const inverse_kinematics_options& options = {}) {
  const detail::search_on_chain<C> search(chain, start, options);
  detail::require_pose(goal, "inverse_kinematics", "the goal");
  return search(goal);
}

/// Inverse kinematics of many goals: out[i] = inverse_kinematics(chain, goals[i], start, options),
/// with identical results for any number of threads.
///
/// \throws invalid_input if the sizes differ, for the first goal that is not a pose, and as above
/// \throws cancelled if `how.report` requests it, see `parallel_for_blocks`
template <SerialChain C, VectorLike Start>
void inverse_kinematics(const C& chain, std::span<const dual_quaternion<double>> goals,
                        const Start& start, std::span<inverse_kinematics_result<C::joints>> out,
                        const inverse_kinematics_options& options = {}, execution how = one_core) {
  detail::require(goals.size() == out.size(), "duet: inverse_kinematics: ", goals.size(),
                  " goals, but room for ", out.size(), " results");
  const detail::search_on_chain<C> search(chain, start, options);
  for (std::size_t i = 0; i < goals.size(); ++i) {
    detail::require_pose(goals[i], "inverse_kinematics", "goal " + std::to_string(i));
  }
  parallel_for(
      goals.size(), [&](std::size_t i) { out[i] = search(goals[i]); }, how);
}

DUET_ASKS_FOR_ONE_CONFIGURATION(inverse_kinematics, inverse_kinematics_result<C::joints>)

template <SerialChain C>
DUET_REFUSED("the start is missing: inverse_kinematics(chain, goal, start)")
inverse_kinematics_result<C::joints> inverse_kinematics(const C&, const dual_quaternion<double>&);
template <SerialChain C, VectorLike Start, class... More>
DUET_REFUSED("the goal precedes the start: inverse_kinematics(chain, goal, start)")
inverse_kinematics_result<C::joints> inverse_kinematics(const C&, const Start&,
                                                        const dual_quaternion<double>&,
                                                        const More&...);
template <SerialChain C, VectorLike Position, VectorLike Start, class... More>
DUET_REFUSED("for a position as the goal, pass position_goal(p) of duet/robotics/goals.hpp")
inverse_kinematics_result<C::joints> inverse_kinematics(const C&, const Position&, const Start&,
                                                        const More&...);
template <SerialChain C, Real T, VectorLike Start, class... More>
DUET_REFUSED("the goal is a rotation without a position: pass pose(q, t)")
inverse_kinematics_result<C::joints> inverse_kinematics(const C&, const quaternion<T>&,
                                                        const Start&, const More&...);

} // namespace duet
