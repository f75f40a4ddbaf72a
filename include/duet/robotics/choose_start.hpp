// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/kinematics/chain_view.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/robotics/clearance.hpp>
#include <duet/robotics/follow_path.hpp>
#include <duet/robotics/objective.hpp>

#include <limits>
#include <optional>
#include <vector>

/// \file
/// Start configurations from which a chain can follow a whole path, or the pose of the path that
/// has no solution.

namespace duet {
DUET_ABI_BEGIN

/// Options of `find_start_configuration`.
struct start_options {
  /// Options of the planner that follows paths.
  plan_options plan = {};
  /// Maximum number of starts that are tried.
  int max_starts = 64;
  /// Maximum distance from one configuration to the next on self-motion curves of seven joints, as
  /// `self_motion_options::resolution`.
  double resolution = .3;
  /// Distance between the poses that are checked for a solution, a fraction of the path.
  double sampling = .01;
};

/// Result of `find_start_configuration`.
struct start_search_result {
  /// Plan from the start configuration that was found, `plan.joints.front()`; if none leads to the
  /// end of the path, the one that comes farthest. Empty if no start has a solution.
  motion_plan plan;
  int starts = 0; ///< number of starts tried
  /// First parameter, to 1e-6 of the path, at which no joint coordinates were found, if no start
  /// leads to the end; nothing if all poses that were checked have some.
  std::optional<double> unsolved;
  /// Termination reason: `reached`; else what blocks the path at `unsolved`, or else that of
  /// `plan`.
  stop_reason reason = stop_reason::no_solution;
  /// True if certainly there is no solution at `unsolved`. Of six joints all are known.
  bool is_certain = false;

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("plan", plan);
    f("starts", starts);
    f("unsolved", unsolved.value_or(std::numeric_limits<double>::quiet_NaN()));
    f("reason", reason);
    f("is_certain", is_certain);
  }
};

DUET_ABI_END
namespace detail {
DUET_ABI_BEGIN

/// `find_start_configuration` for a chain of any type.
///
/// \param stops  parameters that become waypoints, increasing; the first and the last are the ends
start_search_result find_start(const chain_view& chain, const path_function& path,
                               const std::vector<double>& stops, const start_options& options,
                               const solution_preferences& preferences);

DUET_ABI_END
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
[[nodiscard]] start_search_result
find_start_configuration(const C& chain, const Path& path, double first, double last,
                         const start_options& options = {}, const Objective& objective = {},
                         const Scene& around = {}) {
  detail::require(first < last && last - first < std::numeric_limits<double>::infinity(),
                  "duet: find_start_configuration: the parameter of the path goes from ", first,
                  " to ", last, " (expected an increasing, finite interval)");
  return detail::find_start(chain, detail::checked(std::cref(path)), {first, last}, options,
                            detail::preferences_of(chain, objective, around));
}

/// Start configuration from which the tip of a chain follows a spline of poses over its whole
/// domain.
template <SerialChain C, PosePath Spline, class Objective = no_objective, class Scene = no_scene>
  requires requires(const Spline& s) { s.breaks().front(); }
[[nodiscard]] start_search_result find_start_configuration(const C& chain, const Spline& spline,
                                                           const start_options& options = {},
                                                           const Objective& objective = {},
                                                           const Scene& around = {}) {
  const auto& breaks = spline.breaks();
  return detail::find_start(chain, detail::checked(std::cref(spline)),
                            std::vector<double>(breaks.begin(), breaks.end()), options,
                            detail::preferences_of(chain, objective, around));
}

template <SerialChain C, VectorLike Start, PosePath Path, class... More>
DUET_REFUSED(
    "find_start_configuration takes no start: find_start_configuration(chain, path, first, last)")
start_search_result find_start_configuration(const C&, const Start&, const Path&, const More&...);

} // namespace duet
