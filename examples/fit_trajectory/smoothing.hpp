// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "trajectory.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/fit.hpp>
#include <duet/spline/knots.hpp>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// \file
/// The curve near recorded rows, and the tables made of it.

namespace fit_trajectory {

using curve = duet::cumulative_bspline<duet::dual<double, 1, duet::screw_tag>, 4>;
using fitted = duet::fit_result<curve>;

/// A knot at every n-th row, so that gaps have few and dense parts many.
inline std::vector<double> knots_at_rows(const std::vector<double>& times, std::size_t n) {
  std::vector<double> breaks;
  for (std::size_t i = 0; i + n <= times.size() - 1; i += n) {
    breaks.push_back(times[i]);
  }
  breaks.push_back(times.back());
  return duet::clamped_knots(breaks, 4);
}

inline double median(std::vector<double> x) {
  const auto middle = x.begin() + std::ptrdiff_t(x.size() / 2);
  std::nth_element(x.begin(), middle, x.end());
  return *middle;
}

struct smoothed {
  fitted fit;
  double outlier; ///< residuals beyond this count as outliers
};

/// A robust fit, with three times the median of the residuals as the limit of outliers unless one
/// is given.
inline smoothed smooth(const recording& r, std::size_t rows_per_knot, double length,
                       double outlier) {
  const duet::fit_options options{.length = length, .outlier = std::max(outlier, 0.0)};
  fitted result = duet::fit<curve>(r.table.parameters, r.table.elements,
                                   knots_at_rows(r.table.parameters, rows_per_knot), options);
  const double limit = result.outlier;
  return {std::move(result), limit};
}

inline std::size_t outliers(const smoothed& s) {
  const auto is_far = [&](double residual) { return residual > s.outlier; };
  return std::size_t(std::count_if(s.fit.residuals.begin(), s.fit.residuals.end(), is_far));
}

/// Poses per second of the table: those asked for, else 100 or as many as make a million.
/// \throws std::runtime_error where those asked for would be too many
inline double rate_for(double duration, const std::optional<double>& asked) {
  constexpr double usual = 100, usual_poses = 1e6, most_poses = 1e7;
  if (!asked) {
    return std::min(usual, usual_poses / duration);
  }
  if (!(duration * *asked <= most_poses)) {
    throw std::runtime_error("--rate: " + duet::to_text(*asked) + " Hz over " +
                             duet::to_text(duration) + " s would make more than 10000000 poses");
  }
  return *asked;
}

/// Poses and their rates at even times, in fixed axes: velocity and acceleration of the origin,
/// angular velocity and acceleration.
inline std::string trajectory_csv(const recording& r, const curve& s, double rate) {
  std::string text = "timestamp,tx,ty,tz,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz,ax,ay,az,"
                     "alphax,alphay,alphaz\n";
  const double end = s.basis().back();
  duet::span_hint hint;
  for (std::size_t i = 0; double(i) / rate <= end; ++i) {
    const double t = double(i) / rate;
    const auto m = s.motion(t, duet::frame::hybrid, hint);
    const auto x = duet::pose_coordinates(m.value);
    std::vector<double> numbers{r.start + t, x[0], x[1], x[2], x[4], x[5], x[6], x[3]};
    numbers.insert(numbers.end(), m.velocity.begin(), m.velocity.end());
    numbers.insert(numbers.end(), m.acceleration.begin(), m.acceleration.end());
    text += duet::csv_line(numbers);
  }
  return text;
}

/// Row by row what was measured and how far the curve is from it.
inline std::string rows_csv(const recording& r, const smoothed& s) {
  std::string text = "line,timestamp,tx,ty,tz,residual,is_outlier\n";
  for (std::size_t i = 0; i < r.lines.size(); ++i) {
    const vector3<double> t = duet::translation(r.table.elements[i]);
    const double residual = s.fit.residuals[i];
    text += duet::csv_line({double(r.lines[i]), r.start + r.table.parameters[i], t[0], t[1], t[2],
                            residual, residual > s.outlier ? 1.0 : 0.0});
  }
  return text;
}

/// What gnuplot reads of a table with so many lines: some thousand, evenly, kept for both pictures.
inline std::string picture_data(const std::string& name, std::size_t lines,
                                const std::string& columns) {
  constexpr std::size_t most = 5000;
  return "set table $" + name + "\nplot '" + name + ".csv' skip 1 every " +
         std::to_string(lines / most + 1) + " using " + columns + " with table\nunset table\n";
}

/// \param rows, poses  their numbers: more rows than some thousand would hide the curve, so they
/// are
///                     left out
inline std::string picture_script(double start, double duration, double outlier, std::size_t rows,
                                  std::size_t poses) {
  const std::string first = "-(" + duet::to_text(start) + ")";
  std::string text = "if (!exists('is_read')) {\nset datafile separator ','\n" +
                     picture_data("trajectory", poses, "($1" + first + "):2:3:4:9:10:11:12:13:14") +
                     picture_data("rows", rows, "($2" + first + "):3:4:5:6") +
                     "set datafile separator whitespace\nis_read = 1\n}\n"
                     "set grid\nunset logscale\nset format y\nunset xlabel\n"
                     "set multiplot layout 4,1\n"
                     "set lmargin 11\nset rmargin 14\nset key outside right\nset xrange [0:" +
                     duet::to_text(duration) + "]\nset ylabel 'position / m'\nplot ";
  const char* const colours[] = {"#d62728", "#2ca02c", "#1f77b4"};
  const char* const axes[] = {"x", "y", "z"};
  if (rows <= 5000) {
    for (int k = 0; k < 3; ++k) {
      text += "$rows using 1:" + std::to_string(2 + k) +
              " with points pt 7 ps 0.5 lc rgb '#888888' " +
              (k < 2 ? "notitle, \\\n" : "title 'rows', \\\n");
    }
  }
  const auto curves = [&](int column) {
    for (int k = 0; k < 3; ++k) {
      text += "$trajectory using 1:" + std::to_string(column + k) + " with lines lw 1.5 lc rgb '" +
              colours[k] + "' title '" + axes[k] + "'" + (k < 2 ? ", \\\n" : "\n");
    }
  };
  curves(2);
  const auto panel = [&](const char* label, int column) {
    text += std::string("set ylabel '") + label + "'\nplot ";
    curves(column);
  };
  panel("velocity / (m/s)", 5);
  panel("angular velocity / (rad/s)", 8);
  text += "set ylabel 'residual'\nset xlabel 'time / s'\nset logscale y\nset format y '10^{%T}'\n"
          "plot $rows using 1:5 with points pt 7 ps 0.25 lc rgb '#444444' title 'rows', \\\n" +
          duet::to_text(outlier) +
          " with lines lw 1.5 lc rgb '#d62728' title 'outliers'\nunset multiplot\n";
  return text;
}

} // namespace fit_trajectory
