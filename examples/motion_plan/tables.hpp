// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "options.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/duet.hpp>
#include <duet/io/save_plan.hpp>
#include <duet/kinematics/motion_plan.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

/// \file
/// Tables of a plan as CSV.

namespace motion_plan_example {

using plan_type = duet::motion_plan;

struct worst_case {
  duet::pose_error deviation;
  double clearance = std::numeric_limits<double>::infinity();
};

/// Deviation of the tip from the screw motion and clearance of the arm at ten points between any
/// two waypoints; returns the largest deviation and the smallest clearance.
inline worst_case deviations_csv(const problem& p, const plan_type& plan, std::string& text) {
  worst_case worst;
  text = "tau,deviation [m],deviation [rad],clearance [m]\n";
  for (std::size_t k = 1; k < plan.joints.size(); ++k) {
    for (int step = 0; step <= 10; ++step) {
      const double x = step / 10.0;
      const Eigen::VectorXd theta = (1 - x) * plan.joints[k - 1] + x * plan.joints[k];
      const double tau = (1 - x) * plan.tau[k - 1] + x * plan.tau[k];
      const auto d = duet::pose_error_between(p.arm.pose(theta),
                                              duet::sclerp(plan.poses.front(), p.goal, tau));
      const double clearance = duet::clearance(p.arm, theta, p.scene).distance;
      worst.deviation.translation = std::max(worst.deviation.translation, d.translation);
      worst.deviation.rotation = std::max(worst.deviation.rotation, d.rotation);
      worst.clearance = std::min(worst.clearance, clearance);
      text += duet::csv_line({tau, d.translation, d.rotation, std::min(clearance, 1e9)});
    }
  }
  return worst;
}

/// Largest velocity, acceleration and jerk relative to their limits, in per cent, at `rows` times.
inline std::string shares_csv(const problem& p, const Eigen::VectorXd& velocities,
                              const duet::joint_trajectory& trajectory, int rows) {
  std::string text = "t [s],rate [%],acceleration [%],jerk [%]\n";
  for (int k = 0; k < rows; ++k) {
    const double t = trajectory.duration() * k / (rows - 1);
    const auto now = trajectory(t);
    text += duet::csv_line({t, 100 * now.velocity.cwiseAbs().cwiseQuotient(velocities).maxCoeff(),
                            100 * now.acceleration.cwiseAbs().maxCoeff() / p.acceleration,
                            100 * trajectory.jerk(t).cwiseAbs().maxCoeff() / p.jerk.value_or(1)});
  }
  return text;
}

} // namespace motion_plan_example
