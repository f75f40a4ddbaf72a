// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/file_error.hpp>
#include <duet/kinematics/motion_plan.hpp>

#include <string>
#include <vector>

/// \file
/// Plans and trajectories as CSV files.

namespace duet {
DUET_ABI_BEGIN

/// Writes the waypoints of a plan as CSV, atomically, with all digits and independently of the
/// locale: τ, joint coordinates, the tip's position and rotation, its deviations. Units in the
/// header are those of robots in metres.
///
/// \param joint_names  names of the columns of the joints, as of `arm.joint_names()`; default:
///                     theta0, theta1, …
/// \throws invalid_input for a plan without waypoints and for another number of names, file_error
void save_plan(const std::string& path, const motion_plan& plan,
               const std::vector<std::string>& joint_names = {});

/// Writes joint coordinates, velocities and accelerations as CSV at times `step` apart and at the
/// end.
///
/// \param joint_names  as of `save_plan`; the columns of velocities are then named "elbow rate"
/// \throws invalid_input for a step that is not positive and for another number of names,
/// file_error
void save_trajectory(const std::string& path, const joint_trajectory& trajectory, double step,
                     const std::vector<std::string>& joint_names = {});

DUET_ABI_END
} // namespace duet
