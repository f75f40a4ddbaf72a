// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "options.hpp"

#include "../support/curves.hpp"
#include "../support/drawing.hpp"
#include "../support/joint_curves.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/kinematics/motion_plan.hpp>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

/// \file
/// Tables of a plan, and the picture that is made of them.

namespace path_following {

inline std::string path_csv(const duet::motion_plan& plan) {
  std::string text = "turns,x,y,z,qw,qx,qy,qz,deviation_m,deviation_rad";
  for (Eigen::Index i = 0; i < plan.joints.front().size(); ++i) {
    text += ",joint_" + std::to_string(i);
  }
  text += "\n";
  for (std::size_t k = 0; k < plan.tau.size(); ++k) {
    const auto gamma = duet::pose_coordinates(plan.poses[k]);
    std::vector<double> row = {plan.tau[k]};
    row.insert(row.end(), gamma.begin(), gamma.end());
    row.insert(row.end(), {plan.deviations[k].translation, plan.deviations[k].rotation});
    row.insert(row.end(), plan.joints[k].begin(), plan.joints[k].end());
    text += duet::csv_line(row);
  }
  return text;
}

/// The arm at the start, pale, and at the end, as thick lines from joint to joint, with the
/// required path and that of the tip.
template <class Arm, class Path>
example::drawing drawing_of(const Arm& arm, const duet::motion_plan& plan, const Path& path,
                            double turns) {
  example::drawing d(example::point(.7, -1, .5));
  const auto add_arm = [&](const auto& theta, const std::string& colour, double shift) {
    example::point from = example::point::Zero();
    for (int i = 1; i <= arm.size() + 1; ++i) {
      const example::point to =
          duet::translation(i <= arm.size() ? arm.pose(theta, i) : arm.pose(theta));
      d.capsule(from, to, .03, i == 1 ? "#9aa5b1" : colour, shift);
      from = to;
    }
  };
  constexpr double behind = -10, before = 10;
  add_arm(plan.joints.front(), "#dfe5ea", behind);
  add_arm(plan.joints.back(), "#0072b2", 0);
  for (int i = -3; i <= 3; ++i) {
    const double x = .1 * i;
    d.line({{x, -.3, 0}, {x, .3, 0}}, "#c4ccd4", "lw 1", 2 * behind);
    d.line({{-.3, x, 0}, {.3, x, 0}}, "#c4ccd4", "lw 1", 2 * behind);
  }
  std::vector<example::point> required_path, tip_path;
  const int steps = int(60 * turns) + 1;
  for (int i = 0; i <= steps; ++i) {
    required_path.push_back(duet::translation(path(turns * i / steps)));
  }
  for (const auto& theta : plan.joints) {
    tip_path.push_back(duet::translation(arm.pose(theta)));
  }
  d.line(required_path, "#f0c060", "lw 6", before);
  d.line(tip_path, "#d55e00", "lw 2", 2 * before);
  return d;
}

/// Left the drawing, right the joints, and how far waypoints are from the path.
inline std::string picture_script(const example::drawing& d, const duet::motion_plan& plan) {
  const example::joint_curves curves(plan.joints);
  const std::size_t last = plan.joints.size() - 1;
  duet::pose_error off;
  for (const duet::pose_error& each : plan.deviations) {
    off = {std::max(off.translation, each.translation), std::max(off.rotation, each.rotation)};
  }
  const auto within = [](const char* left, const char* right, const char* bottom, const char* top) {
    return std::string("set lmargin at screen ") + left + "\nset rmargin at screen " + right +
           "\nset bmargin at screen " + bottom + "\nset tmargin at screen " + top + "\n";
  };
  using enum example::label_position;
  return "set multiplot title " +
         example::title("The tip stays on the helix, within " +
                        example::two_digits(1e9 * off.translation) + " nm and " +
                        example::two_digits(1e9 * off.rotation) + " nrad") +
         "\n" + within(".53", ".9", ".56", ".91") +
         "set xrange [*:*] noextend\nset format x ''\nset xtics .5\nset ytics 1\n"
         "set ylabel 'coordinate / (rad or m)'\n" +
         curves.names() + curves.plot("path.csv", 11) + "unset label\n" +
         within(".53", ".9", ".14", ".49") +
         "set format x '%g'\nset xlabel 'turns'\nset ylabel 'off the helix / (m, rad)'\n"
         "set logscale y\nset format y '10^{%T}'\nset ytics 10\nset yrange [1e-13:*]\n" +
         example::plot_command(
             "path.csv",
             {{"1:($9 > 1e-13 ? $9 : 1e-13)", "blue", "m", 3 * last / 5, below},
              {"1:($10 > 1e-13 ? $10 : 1e-13)", "vermillion", "rad", last / 3, above}}) +
         "unset logscale\nunset xlabel\nunset ylabel\n" + within(".02", ".42", ".03", ".91") +
         d.script("path_shapes.csv") + "unset multiplot\n";
}

} // namespace path_following
