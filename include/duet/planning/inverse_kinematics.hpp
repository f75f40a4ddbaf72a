// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/refused.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/parallel_for.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/mechanism/serial_chain.hpp>
#include <duet/planning/inverse_kinematics_search.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/planning_model.hpp>
#include <duet/quaternion/norm.hpp>

#include <cstddef>
#include <span>
#include <string>

/// \file
/// Joint coordinates for poses of the tip.

namespace duet {

namespace detail {

/// A search on a chain, which gives results in the chain's own type.
template <class C>
class search_on_chain {
public:
  /// \throws invalid_input for another number of coordinates than of joints
  template <class Start>
  search_on_chain(const C& chain, const Start& start, const inverse_kinematics_options& options)
      : model_((require_size(chain, start), chain)),
        search_(model_, model_.joints(start), options) {}
  search_on_chain(const search_on_chain&) = delete;

  /// \param goal  a pose
  [[nodiscard]] inverse_kinematics_result<C::joints>
  operator()(const dual_quaternion<double>& goal) const {
    const auto x = search_(model_.place(normalized(goal)));
    return {own_joints(model_.chain(), model_.given_joints_within_limits(x.joints)),
            model_.given_deviation(x.left), x.iterations, x.restarts, x.reason};
  }

private:
  chain_model<C> model_;
  inverse_kinematics_search<joint_room(C::joints)> search_;
};

} // namespace detail

/// Joint coordinates within the limits of a chain that take its tip to the pose `goal`, either sign
/// of it.
///
/// Levenberg and Marquardt's method on the exact twist e = 2 log(A_goal A*) in `frame::hybrid`,
/// Δ = Jᵀ(J Jᵀ + λ)⁻¹ e with λ growing with |e|² after Sugihara, joints that would leave their
/// limits being held there; from the given start and, once the error stops falling, from random
/// configurations. These are the same in every call with the same seed.
///
/// \param start  put within the limits; joints whose range holds a whole turn by turning them back
/// \return the joints; where `reason` is not `reached`, the nearest to the goal that were met with.
/// `out_of_reach` is certain; the joints are then those of the nearest pose, `deviation` by how
/// much it misses the goal: by Newton's method from the start and `restarts` random configurations,
/// that of the least (length / L)² + angle², L the sum of the chain's lengths. That the others mean
/// there is no solution is not: `joint_limit`, `singular` and `no_progress` say what is in the way
/// there, `iteration_limit` that nothing is \throws invalid_input for a start that is not finite or
/// of another size, for a goal that is no pose, and for bad options
template <SerialChain C, VectorLike Start>
[[nodiscard]] inverse_kinematics_result<C::joints>
inverse_kinematics(const C& chain, const dual_quaternion<double>& goal, const Start& start,
                   const inverse_kinematics_options& options = {}) {
  const detail::search_on_chain<C> search(chain, start, options);
  detail::require_pose(goal, "inverse_kinematics", "the goal");
  return search(goal);
}

/// out[i] = inverse_kinematics(chain, goals[i], start, options), with the same results on any
/// number of cores.
/// \throws invalid_input where the sizes differ, for the first goal that is no pose, and as above
/// \throws cancelled where `how.report` asks for that, see `parallel_for_blocks`
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
DUET_REFUSED("from which joints on? inverse_kinematics(chain, goal, start)")
inverse_kinematics_result<C::joints> inverse_kinematics(const C&, const dual_quaternion<double>&);
template <SerialChain C, VectorLike Start, class... More>
DUET_REFUSED("first the goal: inverse_kinematics(chain, goal, start)")
inverse_kinematics_result<C::joints> inverse_kinematics(const C&, const Start&,
                                                        const dual_quaternion<double>&,
                                                        const More&...);
template <SerialChain C, VectorLike Position, VectorLike Start, class... More>
DUET_REFUSED("a position as a goal is position_goal(p), in duet/planning/goals.hpp")
inverse_kinematics_result<C::joints> inverse_kinematics(const C&, const Position&, const Start&,
                                                        const More&...);
template <SerialChain C, Real T, VectorLike Start, class... More>
DUET_REFUSED("the goal is a rotation, which says nothing of where: pose(q, t)")
inverse_kinematics_result<C::joints> inverse_kinematics(const C&, const quaternion<T>&,
                                                        const Start&, const More&...);

} // namespace duet
