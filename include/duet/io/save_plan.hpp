// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/file.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/joint_trajectory.hpp>
#include <duet/kinematics/motion_plan.hpp>

#include <Eigen/Core>

#include <array>
#include <functional>
#include <string>
#include <vector>

/// \file
/// Plans and trajectories as CSV files.

namespace duet::detail {
DUET_ABI_BEGIN

/// Writes a plan, given by its parts, of which there are equally many.
void save_waypoints(const std::string& path, const std::vector<double>& tau,
                    const std::vector<Eigen::VectorXd>& joints,
                    const std::vector<dual_quaternion<double>>& poses,
                    const std::vector<pose_error>& deviations);

/// Writes a trajectory, given by its duration and its coordinates, velocities and accelerations at
/// any time.
void save_samples(const std::string& path,
                  const std::function<std::array<Eigen::VectorXd, 3>(double)>& motion,
                  double duration, double step);

DUET_ABI_END
} // namespace duet::detail

namespace duet {
DUET_ABI_BEGIN

/// Writes the waypoints of a plan as CSV, atomically, with all digits and independently of the
/// locale: τ, joint coordinates, the tip's position and rotation, its deviations. Units in the
/// header are those of robots in metres.
///
/// \throws invalid_input for a plan without waypoints, file_error
template <int N>
void save_plan(const std::string& path, const motion_plan<N>& plan) {
  detail::save_waypoints(path, plan.tau, {plan.joints.begin(), plan.joints.end()}, plan.poses,
                         plan.deviations);
}

/// Writes joint coordinates, velocities and accelerations as CSV at times `step` apart and at the
/// end.
///
/// \throws invalid_input for a step that is not positive, file_error
inline void save_trajectory(const std::string& path, const joint_trajectory& trajectory, double step) {
  const auto motion = [&](double t) -> std::array<Eigen::VectorXd, 3> {
    const auto state = trajectory(t);
    return {state.value, state.velocity, state.acceleration};
  };
  detail::save_samples(path, motion, trajectory.duration(), step);
}

DUET_ABI_END
} // namespace duet
