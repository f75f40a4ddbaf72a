// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/number_text.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/robotics/objective.hpp>
#include <duet/robotics/obstacle_steps.hpp>
#include <duet/robotics/path_planner.hpp>
#include <duet/robotics/planning_model.hpp>
#include <duet/robotics/singularity.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Joint paths along which the tip of a chain follows a given path (N25, note 1).

namespace duet {

/// Function of a parameter that returns poses.
template <class P>
concept PosePath = std::invocable<const P&, double>;

namespace detail {

/// \throws invalid_input
inline void require_options(const plan_options& o, const char* caller) {
  require_positive(caller, "tolerance", o.tolerance);
  require_positive(caller, "deviation", o.deviation);
  require_positive(caller, "largest_step", o.largest_step);
  require_positive(caller, "smallest_step", o.smallest_step);
  require_positive(caller, "self_motion_step", o.self_motion_step);
  require_option(caller, "centring", o.centring, o.centring >= 0, "a non-negative number");
  require_option(caller, "search_step", o.search_step,
                 o.search_step == 0 || (o.search_step >= 1e-6 && o.search_step <= 1),
                 "0 or a number from 1e-6 to 1");
}

/// Plan along a path whose poses have been validated; the start alone if its end is certainly out
/// of reach.
template <class C, class Start, class Objective, class Scene>
[[nodiscard]] motion_plan<C::joints> follow(const C& chain, const Start& start,
                                            const path_function& target, std::vector<double> stops,
                                            const plan_options& options, const Objective& objective,
                                            const Scene& around, bool may_be_out_of_reach = false) {
  static_assert(planning_types<Objective, Scene>::are_good);
  constexpr int capacity = joint_capacity(C::joints);
  using vector = small_vector<capacity>;
  require_options(options, may_be_out_of_reach ? "plan_screw_motion" : "follow_path");
  require_objective(objective, chain.size());
  const std::conditional_t<std::same_as<Scene, scene>, chain_with_obstacles<C>, chain_model<C>>
      model(chain, around);
  const vector theta = model.joints(start);
  const tip_path scaled_path = [&](double u) { return model.scaled_pose(target(u)); };
  const auto start_error =
      model.unscaled_error(pose_error_between(model.at(theta).tip, scaled_path(stops.front())));
  require(options.tolerance.ratio(start_error) <= 1, "duet: follow_path: the path begins ",
          start_error.translation, " units of length and ", start_error.rotation,
          " rad away from the tip at the start");
  model.require_clearance(theta, options.tolerance.translation);
  if (const auto joints = to_chain_joints(chain, scaled_joints<capacity>(start, chain.size()));
      is_nan_at(objective, joints)) {
    fail_not_a_number("duet: follow_path: the objective is nan at the start,", joints);
  }
  std::function<vector(const vector&)> objective_gradient;
  if constexpr (!std::same_as<Objective, no_objective>) {
    objective_gradient = [&](const vector& x) {
      const auto joints = to_chain_joints(chain, model.unscaled_joints(x));
      // Gradient with respect to coordinates in the planner's units.
      return model.unscaled_joints(
          scaled_joints<capacity>(gradient_of(objective, joints), chain.size()));
    };
  }
  const bool is_out_of_reach =
      may_be_out_of_reach &&
      model.reach.is_beyond(scaled_path(stops.back()), model.tolerance(options.tolerance));
  path_planner<capacity> planner(model, scaled_path, std::move(stops), options, objective_gradient);
  const auto joint_path = is_out_of_reach ? planner.stay(theta) : planner.plan(theta);
  motion_plan<C::joints> plan;
  for (const auto& w : joint_path.waypoints) {
    const vector joints = plan.joints.empty() ? scaled_joints<capacity>(start, chain.size())
                                              : model.unscaled_joints_within_limits(w.state.theta);
    add_waypoint(plan, chain, to_chain_joints(chain, joints), model.unscaled_pose(w.state.tip), w.u,
                 model.unscaled_error(w.residual));
    plan.smallest_clearance =
        std::min(plan.smallest_clearance, model.length * model.clearance(w.state.theta));
  }
  // The steps recorded, in the planner's units, where the singular value is smallest: at one end of
  // a step.
  const auto most_singular = std::min_element(
      joint_path.waypoints.begin(), joint_path.waypoints.end(), [](const auto& a, const auto& b) {
        return a.smallest_singular_value < b.smallest_singular_value;
      });
  for (auto w = most_singular - (most_singular != joint_path.waypoints.begin()); w <= most_singular;
       ++w) {
    plan.smallest_singular_value =
        std::min(plan.smallest_singular_value,
                 smallest_singular_value_of(model.unscaled_jacobian(w->state.jacobian)));
  }
  plan.iterations = planner.iterations();
  plan.reason = is_out_of_reach ? stop_reason::out_of_reach : planner.reason(joint_path);
  return plan;
}

/// Path along screw motions from pose to pose, pose i at the parameter i.
template <class T>
struct path_through {
  std::vector<dual_quaternion<T>> poses;

  [[nodiscard]] dual_quaternion<T> operator()(T u) const {
    const std::size_t i = std::min(std::size_t(u), poses.size() - 1);
    const std::size_t next = std::min(i + 1, poses.size() - 1);
    return sclerp(poses[i], poses[next], u - T(i));
  }
};

template <PosePath Path>
[[nodiscard]] auto checked(const Path& path) {
  return [&path](double u) {
    const dual_quaternion<double> a = path(u);
    require_pose(a, "follow_path", "the pose at " + to_text(u));
    return normalized(a);
  };
}

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
[[nodiscard]] motion_plan<C::joints>
follow_path(const C& chain, const Start& start, const Path& path, double first, double last,
            const plan_options& options = {}, const Objective& objective = {},
            const Scene& around = {}) {
  static_assert(detail::Becomes<std::invoke_result_t<const Path&, double>, dual_quaternion<double>>,
                "duet: follow_path: the path must return a dual_quaternion<double>: pose(q, t), or "
                "from_eigen(...) of an Eigen::Isometry3d");
  detail::require_start(chain, start, "follow_path");
  detail::require(first < last && last - first < std::numeric_limits<double>::infinity(),
                  "duet: follow_path: the parameter of the path goes from ", first, " to ", last,
                  " (expected an increasing, finite interval)");
  return detail::follow(chain, start, detail::checked(path), {first, last}, options, objective,
                        around);
}

/// Plans joint motion that moves the tip along a spline of poses, over its whole domain.
template <SerialChain C, VectorLike Start, PosePath Spline, class Objective = no_objective,
          class Scene = no_scene>
  requires requires(const Spline& s) { s.breaks().front(); }
[[nodiscard]] motion_plan<C::joints> follow_path(const C& chain, const Start& start,
                                                 const Spline& spline,
                                                 const plan_options& options = {},
                                                 const Objective& objective = {},
                                                 const Scene& around = {}) {
  detail::require_start(chain, start, "follow_path");
  const auto& breaks = spline.breaks();
  return detail::follow(chain, start, detail::checked(spline),
                        std::vector<double>(breaks.begin(), breaks.end()), options, objective,
                        around);
}

/// Plans joint motion that moves the tip along screw motions from pose to pose (N19), pose i at the
/// parameter i.
template <SerialChain C, VectorLike Start, class Objective = no_objective, class Scene = no_scene>
[[nodiscard]] motion_plan<C::joints>
follow_path(const C& chain, const Start& start, std::span<const dual_quaternion<double>> poses,
            const plan_options& options = {}, const Objective& objective = {},
            const Scene& around = {}) {
  detail::require_start(chain, start, "follow_path");
  detail::require(!poses.empty(), "duet: follow_path: the list of poses is empty");
  detail::path_through<double> target;
  std::vector<double> stops;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    detail::require_pose(poses[i], "follow_path", "pose " + std::to_string(i));
    target.poses.push_back(normalized(poses[i]));
    stops.push_back(double(i));
  }
  return detail::follow(chain, start, target, std::move(stops), options, objective, around);
}

} // namespace duet
