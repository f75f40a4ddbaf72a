// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/refused.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/robotics/clearance.hpp>
#include <duet/robotics/follow_path.hpp>
#include <duet/robotics/objective.hpp>
#include <duet/robotics/path_step.hpp>
#include <duet/robotics/planning_model.hpp>
#include <duet/robotics/start_problem.hpp>
#include <duet/robotics/start_search.hpp>

#include <algorithm>
#include <concepts>
#include <limits>
#include <utility>

/// \file
/// Start configurations from which a chain can follow a whole path, or the pose of the path that
/// has no solution.

namespace duet {

namespace detail {

/// \throws invalid_input
inline void require_options(const start_options& o) {
  require_positive("find_start_configuration", "max_starts", o.max_starts);
  const auto require_part = [](const char* name, double value) {
    require_option("find_start_configuration", name, value, value > 0 && value <= 1,
                   "within (0, 1]");
  };
  require_part("resolution", o.resolution);
  require_part("sampling", o.sampling);
}

/// Plan with its joint coordinates in vectors of another type.
template <int N, int M>
[[nodiscard]] motion_plan<N> with_vectors_of(motion_plan<M> plan) {
  if constexpr (N == M) {
    return plan;
  } else {
    return {{plan.joints.begin(), plan.joints.end()},
            std::move(plan.poses),
            std::move(plan.tau),
            std::move(plan.deviations),
            plan.smallest_singular_value,
            plan.smallest_limit_margin,
            plan.smallest_clearance,
            plan.iterations,
            plan.reason};
  }
}

template <class C, class Objective, class Scene, class Follow>
[[nodiscard]] start_search_result<C::joints>
find_start(const C& chain, const path_function& path, double first, double last,
           const start_options& options, const Objective& objective, const Scene& around,
           const Follow& follow) {
  static_assert(planning_types<Objective, Scene>::are_good);
  require_options(options);
  require_objective(objective, chain.size());
  constexpr int capacity = std::max(16, joint_capacity(C::joints)); // 16 is compiled once
  using joints = typename start_problem<capacity>::joints;
  start_problem<capacity> problem{chain, nullptr, path, first, last, options, {}, {}};
  if constexpr (std::same_as<Scene, scene>) {
    require_scene(chain, around);
    problem.around = &around;
  }
  problem.follow = [&](const joints& start, const plan_options& how) {
    return with_vectors_of<-capacity>(follow(to_chain_joints(chain, start), how));
  };
  if constexpr (!std::same_as<Objective, no_objective>) {
    problem.objective = [&](const joints& x) {
      return double(objective(to_chain_joints(chain, x)));
    };
  }
  auto result = find_start(problem);
  return {with_vectors_of<C::joints>(std::move(result.plan)), result.starts, result.unsolved,
          result.reason, result.is_certain};
}

} // namespace detail

/// Start configuration from which the tip of a chain follows a whole path, and the plan from there;
/// if none is found, the first pose of the path that has no solution, and the reason.
///
/// Candidates are all solutions for the first pose within the limits: for six joints those of
/// `all_inverse_kinematics`, for seven points of their `self_motion_curves`, for others those found
/// from random initial guesses. They are tried as by `follow_path` in the order of the objective
/// there, or else of the distances of the joints from the middles of their limits; of each curve
/// the best one first. If a joint stops at a limit, it is tried again a full turn earlier. Then
/// redundant joints may also make self-motions. If no start leads to the end, poses along the path
/// are checked one by one.
///
/// Example: `find_start_configuration(arm, path, 0, 1).plan.joints.front()`
///
/// \param path       poses as a function of a parameter, which increases from `first` to `last`
/// \param objective  as in `follow_path`
/// \param around     `scene` of bodies and obstacles
/// \return `start_search_result`
/// \throws invalid_input as `follow_path`, and for an objective that is nan at all starts; starts
/// at which it is nan are left out
template <SerialChain C, PosePath Path, class Objective = no_objective, class Scene = no_scene>
[[nodiscard]] start_search_result<C::joints>
find_start_configuration(const C& chain, const Path& path, double first, double last,
                         const start_options& options = {}, const Objective& objective = {},
                         const Scene& around = {}) {
  detail::require(first < last && last - first < std::numeric_limits<double>::infinity(),
                  "duet: find_start_configuration: the parameter of the path goes from ", first,
                  " to ", last, " (expected an increasing, finite interval)");
  return detail::find_start(chain, detail::checked(path), first, last, options, objective, around,
                            [&](const auto& start, const plan_options& how) {
                              return follow_path(chain, start, path, first, last, how, objective,
                                                 around);
                            });
}

/// Start configuration from which the tip of a chain follows a spline of poses over its whole
/// domain.
template <SerialChain C, PosePath Spline, class Objective = no_objective, class Scene = no_scene>
  requires requires(const Spline& s) { s.breaks().front(); }
[[nodiscard]] start_search_result<C::joints>
find_start_configuration(const C& chain, const Spline& spline, const start_options& options = {},
                         const Objective& objective = {}, const Scene& around = {}) {
  return detail::find_start(chain, detail::checked(spline), spline.breaks().front(),
                            spline.breaks().back(), options, objective, around,
                            [&](const auto& start, const plan_options& how) {
                              return follow_path(chain, start, spline, how, objective, around);
                            });
}

template <SerialChain C, VectorLike Start, PosePath Path, class... More>
DUET_REFUSED(
    "find_start_configuration takes no start: find_start_configuration(chain, path, first, last)")
start_search_result<C::joints> find_start_configuration(const C&, const Start&, const Path&,
                                                        const More&...);

} // namespace duet
