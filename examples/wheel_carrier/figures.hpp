// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "carrier.hpp"
#include "comparison.hpp"
#include "csv.hpp"
#include "table.hpp"

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

/// \file
/// What a run leaves in its folder: tables as CSV, pictures by gnuplot.

namespace wheel_carrier {

/// u, W, q, and toe-in and camber of the left wheel, degrees.
inline std::string path_csv(const std::vector<state>& states) {
  std::string text = "u,x,y,z,qw,qx,qy,qz,toe_in_deg,camber_deg\n";
  constexpr double degrees = 180 / std::numbers::pi;
  for (const state& s : states) {
    const vector3 heading = rotate(s.q, vector3(1, 0, 0));
    const vector3 up = rotate(s.q, vector3(0, 0, 1));
    text += csv_line({s.u, s.centre[0], s.centre[1], s.centre[2], s.q.w(), s.q.x(), s.q.y(),
                      s.q.z(), -std::atan2(heading[1], heading[0]) * degrees,
                      std::atan2(up[1], up[2]) * degrees});
  }
  return text;
}

inline std::string table_csv(const table& t) {
  std::string text = "u,qw,qx,qy,qz\n";
  for (std::size_t i = 0; i < t.u.size(); ++i) {
    text += csv_line({t.u[i], t.q[i].w(), t.q[i].x(), t.q[i].y(), t.q[i].z()});
  }
  return text;
}

/// u, then δ and ∂δ/∂u of the spline.
inline std::string rates_csv(const spline& s, const std::vector<double>& samples) {
  std::string text = "u,delta_x,delta_y,delta_z,ddelta_x,ddelta_y,ddelta_z\n";
  for (const double u : samples) {
    const rates r = closed_form(s, u);
    text += csv_line({u, r.delta[0], r.delta[1], r.delta[2], r.delta_first[0], r.delta_first[1],
                      r.delta_first[2]});
  }
  return text;
}

using named_curve = std::pair<std::string, error_curve>;

/// u, then δ_E and dδ_E in percent for every curve.
inline std::string errors_csv(const std::vector<double>& samples,
                              const std::vector<named_curve>& curves) {
  std::string text = "u";
  for (const auto& [name, curve] : curves) {
    text += ",delta_E " + name + ",ddelta_E " + name;
  }
  text += "\n";
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::vector<double> row{samples[i]};
    for (const auto& [name, curve] : curves) {
      row.push_back(curve.delta[i]);
      row.push_back(curve.delta_first[i]);
    }
    text += csv_line(row);
  }
  return text;
}

/// Figure 1 of the paper: both errors over u, every curve, logarithmic.
inline std::string errors_script(const std::vector<named_curve>& curves) {
  std::string text = "set datafile separator ','\nset logscale y\nset format y '10^{%T}'\n"
                     "set xlabel 'wheel height u [m]'\nset grid\nset key below\n"
                     "set xrange [:] noextend\nset multiplot layout 1,2\n";
  const std::pair<const char*, std::size_t> panels[] = {{"{/Symbol d}_E [%]", 2},
                                                        {"d{/Symbol d}_E [%]", 3}};
  for (const auto& [label, first_column] : panels) {
    text += std::string("set ylabel '") + label + "'\nplot ";
    for (std::size_t i = 0; i < curves.size(); ++i) {
      text += (i == 0 ? "" : ", \\\n     ") + std::string("'errors.csv' using 1:") +
              std::to_string(first_column + 2 * i) + " skip 1 with lines lw 1.5 title '" +
              curves[i].first + "'";
    }
    text += "\n";
  }
  return text + "unset multiplot\n";
}

inline const char* path_script() {
  return "set datafile separator ','\nset grid\nset key top left\nset multiplot layout 1,2\n"
         "set xlabel 'displacement of the wheel centre [mm]'\nset ylabel 'wheel height u [mm]'\n"
         "plot 'path.csv' using (1000*$2):(1000*$1) skip 1 with lines lw 2 title 'x, forward', \\\n"
         "     'path.csv' using (1000*($3-0.95)):(1000*$1) skip 1 with lines lw 2 title 'y - 0.95 "
         "m, "
         "left'\n"
         "set xlabel 'angle [degrees]'\n"
         "plot 'path.csv' using 9:(1000*$1) skip 1 with lines lw 2 title 'toe-in', \\\n"
         "     'path.csv' using 10:(1000*$1) skip 1 with lines lw 2 title 'camber'\n"
         "unset multiplot\n";
}

/// Draws folder/name.svg and folder/name.png; false where gnuplot is absent or fails.
inline bool draw(const std::string& folder, const std::string& name, const std::string& script) {
  write_file(folder + "/" + name + ".gnuplot",
             "set terminal svg size 1100,480 background rgb 'white'\nset output '" + name +
                 ".svg'\n" + script +
                 "set output\nset terminal pngcairo size 1100,480\nset output '" + name +
                 ".png'\n" + script);
  std::string quoted = "'";
  for (const char c : folder) {
    quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  const std::string command =
      "cd " + quoted + "' && gnuplot '" + name + ".gnuplot' >/dev/null 2>&1";
  return std::system(command.c_str()) == 0;
}

} // namespace wheel_carrier
