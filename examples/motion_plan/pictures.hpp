// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "scene_drawing.hpp"

#include "../support/curves.hpp"
#include "../support/joint_curves.hpp"

#include <duet/duet.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

/// \file
/// Scripts for gnuplot.

namespace motion_plan_example {

/// 19.98 for 0.019983.
inline std::string millimetres(double length) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g mm", 1000 * length);
  return text;
}

/// The first text if there are obstacles, otherwise the second.
inline const char* obstacles_of(const problem& p, const char* obstacles, const char* links) {
  return p.scene.obstacles.empty() ? links : obstacles;
}

/// Top and middle: the joints that move most in colours, the others grey. Bottom: the largest
/// velocity and acceleration relative to their limits.
/// \param rows  of trajectory.csv
inline std::string joints_script(const problem& p, const plan_type& plan,
                                 const Eigen::VectorXd& velocities, std::size_t rows) {
  const int joints = p.arm.size();
  const example::joint_curves curves(plan.joints);
  const auto panel = [&](int group) { return curves.plot("trajectory.csv", 2 + group * joints); };
  const auto fraction_of_limit = [&](int group, const auto& limit) {
    std::string largest = "0";
    for (int i = 0; i < joints; ++i) {
      largest = "max(" + largest + ", abs($" + std::to_string(2 + group * joints + i) + ")/" +
                duet::to_text(limit(i)) + ")";
    }
    return "1:(100*" + largest + ")";
  };
  bool is_all_rotational = true;
  for (int i = 0; i < joints; ++i) {
    is_all_rotational = is_all_rotational && p.arm.kind(i) != duet::joint_kind::prismatic;
  }
  const std::string unit = is_all_rotational ? "rad" : "(rad or m)";
  using enum example::label_position;
  return "max(a, b) = a > b ? a : b\nset multiplot layout 3,1 title " +
         example::title("At nearly every moment one joint is at a limit") +
         "\nset lmargin 11\nset rmargin 12\nset xrange [*:*] noextend\n"
         "set format x ''\nset ylabel 'coordinate / " +
         unit + "'\n" + curves.names() + panel(0) + "unset label\nset ylabel 'rate / (" + unit +
         "/s)'\n" + panel(1) +
         "set format x '%g'\nset xlabel 'time / s'\nset ylabel 'share of a limit / %'\n"
         "set yrange [0:109]\n" +
         example::plot_command("trajectory.csv",
                               {{fraction_of_limit(1, [&](int i) { return velocities[i]; }),
                                 "vermillion", "rate", rows - 1, right},
                                {fraction_of_limit(2, [&](int) { return p.acceleration; }), "blue",
                                 "acceleration", rows - 1, right}}) +
         "unset multiplot\n";
}

/// The largest velocity, acceleration and jerk relative to their limits: top without jerk limits,
/// where the jerk exceeds the frame, bottom with them.
/// \param duration  duration with jerk limits
/// \param rows  of both tables
inline std::string jerk_script(double duration, std::size_t rows) {
  using enum example::label_position;
  const auto panel = [&](const std::string& file) {
    return example::plot_command(file, {{"1:4", "purple", "jerk", rows - 1, right},
                                        {"1:2", "vermillion", "rate", rows / 2, above},
                                        {"1:3", "blue", "acceleration", rows / 12, above}});
  };
  return "set multiplot layout 2,1 title " +
         example::title("With limits of jerk accelerations rise and fall with them") +
         "\nset lmargin 9\nset rmargin 9\nset xrange [0:" + duet::to_text(duration) +
         "]\nset yrange [0:120]\nset ytics 50\nset format x ''\n"
         "set ylabel 'without / % of limits'\n" +
         panel("shares_without.csv") +
         "unset label\nset format x '%g'\nset xlabel 'time / s'\nset ylabel 'with / % of "
         "limits'\n" +
         panel("shares.csv") + "unset multiplot\n";
}

/// \param rows  of deviations.csv, eleven between two waypoints
inline std::string deviation_script(const problem& p, std::size_t rows) {
  using enum example::label_position;
  const std::string both =
      "set ylabel 'off the screw / (µm, µrad)'\nset xrange [0:1]\nset yrange [0:12]\n" +
      example::plot_command("deviations.csv",
                            {{"1:(1e6*$2)", "blue", "position", rows - 6, right},
                             {"1:(1e6*$3)", "vermillion", "orientation", rows - 6, right},
                             {"1:(10)", "ink", "allowed", rows - 1, right, "lines lw 2 dt 2"}});
  const std::string x_axis = "set xlabel 'fraction of the path'\n";
  return "set lmargin 9\nset rmargin 12\n" +
         (p.has_margins()
              ? "set multiplot layout 2,1 title " +
                    example::title(
                        std::string("The tip keeps to its screw motion, ") +
                        obstacles_of(p, "the arm off the obstacles", "links off each other")) +
                    "\n" + both + x_axis + "set ylabel 'distance / mm'\nset yrange [0:*]\n" +
                    example::plot_command(
                        "deviations.csv",
                        {{"1:(1000*$4)", "blue",
                          obstacles_of(p, "from the nearest obstacle", "from link to link"),
                          rows / 6, above_right},
                         {"1:(" + duet::to_text(1000 * p.scene.margin) + ")", "ink", "margin",
                          rows - 1, right, "lines lw 2 dt 2"}}) +
                    "unset multiplot\n"
              : x_axis + both);
}

/// The drawing, and the clearance of the arm along the path.
/// \param rows  of deviations.csv
inline std::string arm_script(const example::drawing& d, const problem& p, const plan_type& plan,
                              const std::vector<point>& tip,
                              const std::optional<closest_approach>& nearest, std::size_t rows) {
  const auto label = [](const std::string& text, const std::string& at, const std::string& style) {
    return "set label " + example::in_quotes(text) + " at " + at + " front tc rgb ink " + style +
           "\n";
  };
  const std::string ends = label("start", d.at(tip.front()), "left offset 1,0") +
                           label("goal", d.at(tip.back()), "center offset 0,.8");
  if (!nearest) {
    return ends + d.script("arm_shapes.csv");
  }
  const auto& gap = nearest->clearance.points;
  using enum example::label_position;
  return "set multiplot title " +
         example::title(obstacles_of(p, "The arm keeps ", "Links keep ") +
                        millimetres(plan.smallest_clearance) + " or more from " +
                        obstacles_of(p, "obstacles", "each other") + "; the margin is " +
                        millimetres(p.scene.margin)) +
         "\nset lmargin at screen .62\nset rmargin at screen .96\nset tmargin at screen .8\n"
         "set bmargin at screen .2\nset xrange [0:1]\nset yrange [0:*]\n"
         "set xlabel 'fraction of the path'\nset ylabel 'distance " +
         obstacles_of(p, "to obstacles", "from link to link") + " / mm'\n" +
         example::plot_command("deviations.csv",
                               {{"1:(1000*$4)", "blue", obstacles_of(p, "arm", "links"), rows / 5,
                                 above_right, "lines lw 3"},
                                {"1:(" + duet::to_text(1000 * p.scene.margin) + ")", "ink",
                                 "margin", rows / 20, above_right, "lines lw 2 dt 2"}}) +
         "unset xlabel\nunset ylabel\nset lmargin at screen .02\nset rmargin at screen .5\n"
         "set tmargin at screen .9\nset bmargin at screen .03\n" +
         ends + "set arrow from " + d.at(gap.on_body) + " to " + d.at(gap.on_obstacle) +
         " heads size screen .004,25 filled lc rgb ink front\n" + d.script("arm_shapes.csv") +
         "unset multiplot\n";
}

} // namespace motion_plan_example
