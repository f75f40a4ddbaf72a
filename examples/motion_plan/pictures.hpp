// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <string>

/// \file
/// Scripts for gnuplot.

namespace motion_plan_example {

inline std::string series(const std::string& file, int joints, int first, const std::string& name) {
  std::string text = "plot ";
  for (int i = 0; i < joints; ++i) {
    text += (i == 0 ? "'" : ", '") + file + "' using 1:" + std::to_string(first + i) +
            " skip 1 with lines lw 1.6 lt " + std::to_string(i + 1) + " title '" + name + " " +
            std::to_string(i) + "'";
  }
  return text + "\n";
}

inline std::string joints_script(int joints) {
  const auto column = [&](int group) { return 2 + group * joints; };
  return "set datafile separator ','\nset grid\nset multiplot layout 3,1\nset lmargin 12\n"
         "set rmargin 16\nset key outside right\nset ylabel 'coordinate / rad or m'\n" +
         series("trajectory.csv", joints, column(0), "joint") + "set ylabel 'rate / (1/s)'\n" +
         series("trajectory.csv", joints, column(1), "joint") +
         "set xlabel 'time / s'\nset ylabel 'acceleration / (1/s^2)'\n" +
         series("trajectory.csv", joints, column(2), "joint") + "unset multiplot\n";
}

inline std::string deviation_script(bool has_obstacles) {
  const std::string both =
      "set format y '10^{%T}'\nset logscale y\nset ylabel 'deviation from the screw'\n"
      "plot [0:1][1e-9:1e-4] 'deviations.csv' using 1:2 skip 1 with lines lw 1.6 lc rgb '#1f77b4' "
      "title 'metres', 'deviations.csv' using 1:3 skip 1 with lines lw 1.6 lc rgb '#d62728' title "
      "'radians', 1e-5 with lines lw 1.2 dt 2 lc rgb 'black' title 'allowed'\n";
  return "set datafile separator ','\nset grid\nset lmargin 12\nset rmargin 16\n"
         "set key outside right\nset xlabel 'tau'\n" +
         (has_obstacles
              ? "set multiplot layout 2,1\n" + both +
                    "unset logscale y\nset format y '%g'\nset ylabel 'clearance / m'\n"
                    "plot [0:1][0:*] 'deviations.csv' using 1:4 skip 1 with lines lw 1.6 lc rgb "
                    "'#2ca02c' title 'clearance'\nunset multiplot\n"
              : both);
}

inline std::string arm_script(bool has_obstacles) {
  return "set datafile separator ','\nset grid\nset view equal xyz\nset view 66,128,1.15\n"
         "set xyplane relative 0\nset xtics .2\nset ytics .2\nset ztics .2\nset xlabel 'x / "
         "m'\nset ylabel 'y / m'\nset zlabel 'z / m'\n"
         "set palette defined (0 '#9ecae1', 1 '#08306b')\nset cbrange [0:1]\n"
         "set colorbox user origin 0.9,0.25 size 0.02,0.5\nset cblabel 'from start to goal'\nset "
         "key at screen 0.3,0.97\nsplot " +
         std::string(has_obstacles ? "'obstacles.csv' using 1:2:3 skip 1 with lines lw 1 lc rgb "
                                     "'#e0a060' title 'obstacles', "
                                   : "") +
         "'arms.csv' using 1:2:3:4 skip 1 with linespoints lw 3 pt 7 ps 0.6 lc palette title "
         "'arm', 'tip.csv' using 1:2:3 skip 1 with lines lw 3 lc rgb '#d62728' title 'tip'\n";
}

} // namespace motion_plan_example
