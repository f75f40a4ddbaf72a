// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "options.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/planning/motion_plan.hpp>

#include <cstddef>
#include <string>
#include <vector>

/// \file
/// Tables of a plan, and the picture that is made of them.

namespace path_following {

template <int N>
std::string path_csv(const duet::motion_plan<N>& plan) {
  std::string text = "turns,x,y,z,qw,qx,qy,qz,deviation_m,deviation_rad";
  for (Eigen::Index i = 0; i < plan.joints.front().size(); ++i) {
    text += ",joint_" + std::to_string(i);
  }
  text += "\n";
  for (std::size_t k = 0; k < plan.tau.size(); ++k) {
    const auto gamma = duet::pose_coordinates(plan.poses[k]);
    std::vector<double> row = {plan.tau[k]};
    row.insert(row.end(), gamma.begin(), gamma.end());
    row.insert(row.end(), {plan.deviations[k].length, plan.deviations[k].angle});
    row.insert(row.end(), plan.joints[k].begin(), plan.joints[k].end());
    text += duet::csv_line(row);
  }
  return text;
}

/// The joints and the tip from the base on, at a few waypoints; empty lines between.
template <class Arm, int N>
std::string arm_csv(const Arm& arm, const duet::motion_plan<N>& plan) {
  std::string text = "x,y,z\n";
  constexpr std::size_t pictures = 5;
  for (std::size_t p = 0; p < pictures; ++p) {
    const auto& theta = plan.joints[p * (plan.joints.size() - 1) / (pictures - 1)];
    text += duet::csv_line({0, 0, 0});
    for (int i = 1; i <= arm.size(); ++i) {
      const Eigen::Vector3d x = duet::translation(arm.pose(theta, i));
      text += duet::csv_line({x[0], x[1], x[2]});
    }
    const Eigen::Vector3d tip = duet::translation(arm.pose(theta));
    text += duet::csv_line({tip[0], tip[1], tip[2]}) + "\n";
  }
  return text;
}

template <class Helix>
std::string helix_csv(const Helix& helix, double turns) {
  std::string text = "x,y,z\n";
  const int steps = int(60 * turns) + 1;
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector3d x = duet::translation(helix(turns * i / steps));
    text += duet::csv_line({x[0], x[1], x[2]});
  }
  return text;
}

inline std::string picture_script(int joints) {
  return "reset\nset datafile separator ','\nset multiplot\n"
         "set size .56,1\nset origin 0,0\nset view equal xyz\nset view 65,35\nset xyplane at 0\n"
         "set xlabel 'x in m'\nset ylabel 'y in m'\nset zlabel 'z in m' rotate\n"
         "set xtics .2\nset ytics .2\nset ztics .2\nset key at screen .3,.98 center\n"
         "splot 'arm.csv' using 1:2:3 skip 1 with linespoints lw 2 pt 7 ps .6 lc rgb '#9aa5b1' "
         "title 'arm', "
         "'helix.csv' using 1:2:3 skip 1 with lines lw 5 lc rgb '#f6c85f' title 'helix', "
         "'path.csv' using 2:3:4 skip 1 with lines lw 1.5 lc rgb '#20639b' title 'tip'\n"
         "unset xtics\nunset ytics\nset xtics\nset ytics\nset grid\n"
         "set size .44,.5\nset origin .56,.5\nset key outside bottom center horizontal\n"
         "set xlabel 'turns'\nset ylabel 'joints'\nset ytics 1\n"
         "plot for [i=0:" +
         std::to_string(joints - 1) +
         "] 'path.csv' using 1:(column(11+i)) skip 1 with lines lw 2 title sprintf('%d', i)\n"
         "set origin .56,0\nset ytics autofreq\nset ylabel 'deviation of waypoints'\nset logscale "
         "y\n"
         "set format y '%.0e'\n"
         "plot 'path.csv' using 1:($9 > 1e-13 ? $9 : 1e-13) skip 1 with lines lw 2 title 'm', "
         "'' using 1:($10 > 1e-13 ? $10 : 1e-13) skip 1 with lines lw 2 title 'rad'\n"
         "unset multiplot\n";
}

} // namespace path_following
