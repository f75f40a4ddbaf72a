// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "joint_paths.hpp"
#include "path_velocity_constraints.hpp"

#include <duet/kinematics/joint_trajectory.hpp>

#include <cstddef>
#include <vector>

/// \file
/// Time parametrisation of joint curves.

namespace duet::detail {
DUET_ABI_BEGIN

/// Timed segments of a path in order, and their total duration.
struct timed_path {
  std::vector<timed_piece> pieces;
  double duration = 0;
};

/// Minimum-time motion along a curve with constant s̈ in each segment. If segments are
/// so short that round-off takes accelerations beyond their limits, it is computed
/// again with smaller limits.
///
/// \throws invalid_input for velocities at ends that are too fast
[[nodiscard]] timed_path timed_by_accelerations(const time_parametrisation_input& problem,
                                                const std::vector<joint_cubic>& curve);

/// Motion with approximately the given velocities at its ends that needs the smallest fraction of
/// the acceleration limits for them, as an initial guess for jerk limits. (Near the minimum-time
/// motion, path velocities near the ends would have to change, and searches that start there stall
/// in a corner of the feasible set.)
[[nodiscard]] timed_path min_acceleration_motion(const time_parametrisation_input& problem,
                                                 const std::vector<joint_cubic>& curve);

/// Path arguments s of a motion at n + 1 equidistant times; the last one is the length of the path.
[[nodiscard]] std::vector<double> arc_lengths_of(const timed_path& path, std::size_t n,
                                                 double length);

/// Trajectory along a curve with a squared path velocity τ̇²(τ) over n intervals of τ, given by its
/// B-spline coefficients.
[[nodiscard]] timed_path trajectory_from_path_velocity(const std::vector<joint_cubic>& curve,
                                                       const std::vector<reference_piece>& path,
                                                       std::size_t n,
                                                       const std::vector<double>& squared_velocity);

/// Near-minimum-time motion along a curve within velocity, acceleration and jerk limits.
///
/// \throws invalid_input for velocities at ends with which no motion is found
[[nodiscard]] timed_path timed_within_jerks(const time_parametrisation_input& problem,
                                            const std::vector<joint_cubic>& curve);

/// Minimum-time motion along a curve, as `joint_trajectory`.
[[nodiscard]] joint_trajectory timed(const time_parametrisation_input& problem,
                                     const std::vector<joint_cubic>& curve);

DUET_ABI_END
} // namespace duet::detail
