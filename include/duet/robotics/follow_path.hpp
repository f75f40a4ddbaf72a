// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/chain_view.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/robotics/clearance.hpp>
#include <duet/robotics/objective.hpp>

#include <Eigen/Core>

#include <concepts>
#include <functional>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

/// \file
/// Joint paths along which the tip of a chain follows a given path (N25, note 1).

namespace duet {

/// Function of a parameter that returns poses.
template <class P>
concept PosePath = std::invocable<const P&, double>;

namespace detail {
DUET_ABI_BEGIN

/// Poses as a function of a parameter.
using path_function = std::function<dual_quaternion<double>(double)>;

/// Path whose poses are those of `path`, validated and normalised.
///
/// \throws invalid_input from the returned function, for a value that is not a pose
[[nodiscard]] path_function checked(path_function path);

/// Joint path of a chain along a checked path.
///
/// \param stops  parameters that become waypoints, increasing; the first and the last are the ends
motion_plan follow(const chain_view& chain, const Eigen::Ref<const Eigen::VectorXd>& start,
                   const path_function& target, const std::vector<double>& stops,
                   const plan_options& options, const solution_preferences& preferences);

/// Joint path along screw motions from pose to pose, pose i at the parameter i.
motion_plan follow_poses(const chain_view& chain, const Eigen::Ref<const Eigen::VectorXd>& start,
                         std::span<const dual_quaternion<double>> poses,
                         const plan_options& options, const solution_preferences& preferences);

DUET_ABI_END
} // namespace detail

/// Joint path along which the tip frame (end-effector frame) of a chain follows a path from its
/// pose at `start` (N25, note 1).
///
/// Waypoints are within `tolerance` of the path, the straight joint paths between them within about
/// `deviation`, each in length and angle, at the same parameter. Each waypoint is met by Newton's
/// method on the exact twist 2 log(A_target A*), with least-norm steps that respect the limits and
/// are damped (damped least squares) if the smallest singular value is small. The null space of the
/// Jacobian serves joint-limit avoidance and lowers the objective. If the joints get stuck and the
/// arm is redundant, configurations that a self-motion can reach are searched, too.
///
/// \param path         poses as a function of a parameter, which increases from `first` to `last`
/// \param objective    null-space (secondary) objective: a function of θ, generic over scalars,
/// which is minimised in the null space, with the tip on the path; or an object with a member
/// `gradient(theta)` too
/// \param around       `scene`: bodies of the chain keep its margin from obstacles, at waypoints to
/// `tolerance`, halfway between them to `deviation`
/// \return the plan, its `tau` the parameter; unless `reason` is `reached`, the part up to there
/// \throws invalid_input for a start outside the limits or of another size, a path that does not
/// begin at the tip or whose parameter does not increase, values that are not poses, options out of
/// range, a preferred posture of another size or not finite, an objective that is nan at the start,
/// an invalid `scene` and one that is too close at the start
template <SerialChain C, VectorLike Start, PosePath Path, class Objective = no_objective,
          class Scene = no_scene>
[[nodiscard]] motion_plan follow_path(const C& chain, const Start& start, const Path& path,
                                      double first, double last, const plan_options& options = {},
                                      const Objective& objective = {}, const Scene& around = {}) {
  static_assert(detail::Becomes<std::invoke_result_t<const Path&, double>, dual_quaternion<double>>,
                "duet: follow_path: the path must return a dual_quaternion<double>: pose(q, t), or "
                "from_eigen(...) of an Eigen::Isometry3d");
  detail::require(first < last && last - first < std::numeric_limits<double>::infinity(),
                  "duet: follow_path: the parameter of the path goes from ", first, " to ", last,
                  " (expected an increasing, finite interval)");
  return detail::follow(chain, detail::start_of(chain, start), detail::checked(std::cref(path)),
                        {first, last}, options, detail::preferences_of(chain, objective, around));
}

/// Plans joint motion that moves the tip along a spline of poses, over its whole domain.
template <SerialChain C, VectorLike Start, PosePath Spline, class Objective = no_objective,
          class Scene = no_scene>
  requires requires(const Spline& s) { s.breaks().front(); }
[[nodiscard]] motion_plan follow_path(const C& chain, const Start& start, const Spline& spline,
                                      const plan_options& options = {},
                                      const Objective& objective = {}, const Scene& around = {}) {
  const auto& breaks = spline.breaks();
  return detail::follow(chain, detail::start_of(chain, start), detail::checked(std::cref(spline)),
                        std::vector<double>(breaks.begin(), breaks.end()), options,
                        detail::preferences_of(chain, objective, around));
}

/// Plans joint motion that moves the tip along screw motions from pose to pose (N19), pose i at the
/// parameter i.
template <SerialChain C, VectorLike Start, class Objective = no_objective, class Scene = no_scene>
[[nodiscard]] motion_plan follow_path(const C& chain, const Start& start,
                                      std::span<const dual_quaternion<double>> poses,
                                      const plan_options& options = {},
                                      const Objective& objective = {}, const Scene& around = {}) {
  return detail::follow_poses(chain, detail::start_of(chain, start), poses, options,
                              detail::preferences_of(chain, objective, around));
}

} // namespace duet
