// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "carrier.hpp"
#include "comparison.hpp"
#include "configuration.hpp"
#include "splines.hpp"
#include "table.hpp"

#include <duet/core/text/csv.hpp>

#include <array>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

/// \file
/// What a run leaves in its folder: tables as CSV, pictures by gnuplot.

namespace wheel_carrier {

using duet::csv_line;

/// u, W, q, toe-in and camber of the left wheel in degrees, W from its design position.
inline std::string path_csv(const std::vector<state>& states, const vector3& design) {
  std::string text = "u,x,y,z,qw,qx,qy,qz,toe_in_deg,camber_deg,dx,dy\n";
  constexpr double degrees = 180 / std::numbers::pi;
  for (const state& s : states) {
    text += csv_line({s.u, s.centre[0], s.centre[1], s.centre[2], s.q.w(), s.q.x(), s.q.y(),
                      s.q.z(), toe_in(s.q) * degrees, camber(s.q) * degrees,
                      s.centre[0] - design[0], s.centre[1] - design[1]});
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
inline std::string rates_csv(const curve& c, const std::vector<double>& samples) {
  std::string text = "u,delta_x,delta_y,delta_z,ddelta_x,ddelta_y,ddelta_z\n";
  for (const double u : samples) {
    const rates r = c.at(u);
    text += csv_line({u, r.delta[0], r.delta[1], r.delta[2], r.delta_first[0], r.delta_first[1],
                      r.delta_first[2]});
  }
  return text;
}

/// u, then x, y, z, φ, θ, ψ and their first and second derivatives.
inline std::string configuration_csv(const std::vector<double>& samples,
                                     const std::vector<configuration>& values) {
  std::vector<std::string> names{"u"};
  for (const char* const order : {"", "_first", "_second"}) {
    for (const char* const name : {"x", "y", "z", "phi", "theta", "psi"}) {
      names.push_back(std::string(name) + order);
    }
  }
  std::string text = duet::csv_header(names);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::vector<double> row{samples[i]};
    for (std::size_t k = 0; k < 3; ++k) {
      for (const vector3& v : {values[i].place[k], values[i].angles[k]}) {
        row.insert(row.end(), v.data(), v.data() + 3);
      }
    }
    text += csv_line(row);
  }
  return text;
}

inline std::string configuration_errors_csv(const std::vector<double>& samples,
                                            const configuration_errors& off) {
  std::string text = "u,place,angles,place_first,angles_first,place_second,angles_second\n";
  for (std::size_t i = 0; i < samples.size(); ++i) {
    text += csv_line({samples[i], off.place[0][i], off.angles[0][i], off.place[1][i],
                      off.angles[1][i], off.place[2][i], off.angles[2][i]});
  }
  return text;
}

using named_curve = std::pair<std::string, error_curve>;

/// u, then δ_E and dδ_E in percent for every curve.
inline std::string errors_csv(const std::vector<double>& samples,
                              const std::vector<named_curve>& curves) {
  std::vector<std::string> names{"u"};
  for (const auto& [name, curve] : curves) {
    names.push_back("delta_E " + name);
    names.push_back("ddelta_E " + name);
  }
  std::string text = duet::csv_header(names);
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

/// Figure 1 of the paper: both errors over u, every curve, logarithmic. The first curve, the one
/// that counts, is drawn last and so on top.
inline std::string errors_script(const std::vector<named_curve>& curves) {
  std::string text = "set datafile separator ','\nset logscale y\nset format y '10^{%T}'\n"
                     "set xlabel 'wheel height u [m]'\nset grid\nset xrange [:] noextend\n"
                     "set key noenhanced outside right center reverse Left samplen 2\n"
                     "set multiplot layout 2,1\n";
  const char* const colours[] = {"#000000", "#d62728", "#9467bd", "#1f77b4", "#ff7f0e", "#9a9a9a"};
  const std::array<std::string, 2> panels[] = {{"{/Symbol d}_E [%]", "[1e-8:1e3]"},
                                               {"d{/Symbol d}_E [%]", "[1e-5:1e5]"}};
  for (std::size_t panel = 0; panel < 2; ++panel) {
    text += "set ylabel '" + panels[panel][0] + "'\nset yrange " + panels[panel][1] + "\nplot ";
    for (std::size_t i = curves.size(); i-- > 0;) {
      text += "'errors.csv' using 1:" + std::to_string(2 + panel + 2 * i) +
              " skip 1 with lines lw 1.5 lc rgb '" + colours[i % 6] + "' title '" +
              curves[i].first + "'" + (i > 0 ? ", \\\n     " : "\n");
    }
  }
  return text + "unset multiplot\n";
}

/// dδ_E of every spline with every end: over u, and its maximum over the rows of the table.
/// Colours tell the splines apart, dashes the ends.
inline std::string splines_script(const std::vector<named_curve>& curves) {
  const auto style = [](const std::string& name) {
    const auto starts = [&](const char* text) { return name.rfind(text, 0) == 0; };
    const auto ends = [&](const std::string& text) {
      return name.size() > text.size() && name.substr(name.size() - text.size()) == text;
    };
    const std::string colour = starts("Hermite")           ? "#ff7f0e"
                               : starts("cumulative")      ? "#d62728"
                               : starts("rotation-vector") ? "#1f77b4"
                                                           : "#2ca02c";
    const int dash = ends("natural")        ? 3
                     : ends("not-a-knot")   ? 2
                     : ends("clamped")      ? 1
                     : ends("acceleration") ? 4
                                            : 5;
    return " lw 1.5 lc rgb '" + colour + "' dt " + std::to_string(dash);
  };
  std::string text =
      "set datafile separator ','\nset logscale y\nset format y '10^{%T}'\nset grid\n"
      "set key outside right center reverse Left samplen 4\n"
      "set multiplot layout 2,1\nunset logscale x\nset xtics autofreq\n"
      "set ylabel 'd{/Symbol d}_E [%]'\n"
      "set xlabel 'wheel height u [m]'\nset xrange [*:*] noextend\n"
      "set yrange [1e-9:1e3]\nplot ";
  for (std::size_t i = 0; i < curves.size(); ++i) {
    text += (i > 0 ? ", \\\n     '" : "'") + std::string("splines.csv' using 1:") +
            std::to_string(3 + 2 * i) + " skip 1 with lines" + style(curves[i].first) + " title '" +
            curves[i].first + "'";
  }
  text += "\nset ylabel 'maximum of d{/Symbol d}_E [%]'\nset xlabel 'rows of the table'\n"
          "set logscale x\nset xrange [22:450]\nset yrange [1e-8:1e3]\n"
          "set xtics (25, 50, 100, 200, 400)\nplot ";
  for (std::size_t i = 0; i < curves.size(); ++i) {
    text += (i > 0 ? ", \\\n     '" : "'") + std::string("spline_convergence.csv' using 1:") +
            std::to_string(2 + i) + " skip 1 with linespoints pt 7 ps 0.5" +
            style(curves[i].first) + " title '" + curves[i].first + "'";
  }
  return text + "\nunset multiplot\n";
}

/// Where the wheel centre goes from the design position, and how the wheel turns.
inline const char* path_script() {
  return "set datafile separator ','\nset grid\nset key bottom left\nset multiplot layout 1,2\n"
         "set ylabel 'wheel height u [mm]'\nset xlabel 'wheel centre from its design position "
         "[mm]'\n"
         "plot 'path.csv' using (1000*$11):(1000*$1) skip 1 with lines lw 2 title 'x, forward', "
         "\\\n"
         "     'path.csv' using (1000*$12):(1000*$1) skip 1 with lines lw 2 title 'y, left'\n"
         "set xlabel 'angle [degrees]'\n"
         "plot 'path.csv' using 9:(1000*$1) skip 1 with lines lw 2 title 'toe-in', \\\n"
         "     'path.csv' using 10:(1000*$1) skip 1 with lines lw 2 title 'camber'\n"
         "unset multiplot\n";
}

} // namespace wheel_carrier
