// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/csv.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/kinematics/joint_trajectory.hpp>
#include <duet/kinematics/motion_plan.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

/// \file
/// Plans and trajectories as CSV files.

namespace duet {

namespace detail {

/// `,name0 [unit],name1 [unit] …`
[[nodiscard]] inline std::string numbered_columns(const std::string& name, const std::string& unit,
                                                  Eigen::Index count) {
  std::string result;
  for (Eigen::Index i = 0; i < count; ++i) {
    result += "," + name + std::to_string(i) + " [" + unit + "]";
  }
  return result;
}

template <class V>
void append_components(std::vector<double>& row, const V& values) {
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    row.push_back(values[i]);
  }
}

} // namespace detail

/// Writes the waypoints of a plan as CSV, atomically, with all digits and independently of the
/// locale: τ, joint coordinates, the tip's position and rotation, its deviations. Units in the
/// header are those of robots in metres.
///
/// \throws invalid_input for a plan without waypoints, file_error
template <int N>
void save_plan(const std::string& path, const motion_plan<N>& plan) {
  detail::require(!plan.joints.empty(), "duet: save_plan: the plan has no waypoints");
  std::string text = "tau" +
                     detail::numbered_columns("theta", "rad or m", plan.joints.front().size()) +
                     ",x [m],y [m],z [m],qw,qx,qy,qz,deviation [m],deviation [rad]\n";
  for (std::size_t k = 0; k < plan.joints.size(); ++k) {
    std::vector<double> row{plan.tau[k]};
    detail::append_components(row, plan.joints[k]);
    detail::append_components(row, pose_coordinates(plan.poses[k]));
    row.push_back(plan.deviations[k].translation);
    row.push_back(plan.deviations[k].rotation);
    text += csv_line(row);
  }
  write_file(path, text);
}

/// Writes joint coordinates, velocities and accelerations as CSV at times `step` apart and at the
/// end.
///
/// \throws invalid_input for a step that is not positive, file_error
template <int N>
void save_trajectory(const std::string& path, const joint_trajectory<N>& trajectory, double step) {
  detail::require(step > 0, "duet: save_trajectory: the step is ", to_text(step),
                  " (expected a positive number)");
  const Eigen::Index n = trajectory(0).value.size();
  std::string text = "t [s]" + detail::numbered_columns("theta", "rad or m", n) +
                     detail::numbered_columns("rate", "rad/s or m/s", n) +
                     detail::numbered_columns("acceleration", "rad/s^2 or m/s^2", n) + "\n";
  const double duration = trajectory.duration();
  for (std::size_t k = 0;; ++k) {
    const double t = double(k) * step;
    const bool is_last = t >= duration;
    const auto motion = trajectory(is_last ? duration : t);
    std::vector<double> row{is_last ? duration : t};
    detail::append_components(row, motion.value);
    detail::append_components(row, motion.velocity);
    detail::append_components(row, motion.acceleration);
    text += csv_line(row);
    if (is_last) {
      break;
    }
  }
  write_file(path, text);
}

} // namespace duet
