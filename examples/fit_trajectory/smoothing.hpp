// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "trajectory.hpp"

#include "../support/curves.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/fit.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// \file
/// The fitted curve and its tables.

namespace fit_trajectory {

using curve = duet::cumulative_bspline<duet::dual<double, 1, duet::screw_tag>, 4>;
using fitted = duet::fit_result<curve>;

inline double median(std::vector<double> x) {
  const auto midpoint = x.begin() + std::ptrdiff_t(x.size() / 2);
  std::nth_element(x.begin(), midpoint, x.end());
  return *midpoint;
}

struct smoothed {
  fitted fit;
  double outlier; ///< residuals beyond this count as outliers
};

/// A robust fit. The outlier threshold is three times the median residual by default.
inline smoothed smooth(const recording& r, std::size_t samples_per_knot,
                       double characteristic_length, double outlier) {
  const duet::fit_options options{.characteristic_length = characteristic_length,
                                  .outlier_threshold = std::max(outlier, 0.0),
                                  .keeps_covariance = true};
  fitted result =
      duet::fit<curve>(r.table.parameters, r.table.elements,
                       duet::knots_every(r.table.parameters, samples_per_knot), options);
  const double limit = result.outlier_threshold;
  return {std::move(result), limit};
}

inline std::size_t outliers(const smoothed& s) {
  const auto is_far = [&](double residual) { return residual > s.outlier; };
  return std::size_t(std::count_if(s.fit.residuals.begin(), s.fit.residuals.end(), is_far));
}

/// Poses per second of the table: the requested rate; by default 100, or less for at most a million
/// poses.
/// \throws std::runtime_error if the requested rate gives too many
inline double rate_for(double duration, const std::optional<double>& requested) {
  constexpr double default_rate = 100, default_poses = 1e6, max_poses = 1e7;
  if (!requested) {
    return std::min(default_rate, default_poses / duration);
  }
  if (!(duration * *requested <= max_poses)) {
    throw std::runtime_error("--rate: " + duet::to_text(*requested) + " Hz over " +
                             duet::to_text(duration) + " s would make more than 10000000 poses");
  }
  return *requested;
}

/// Poses and their rates at even times, in fixed axes: velocity and acceleration of the origin,
/// angular velocity and acceleration; then standard deviations of the rates.
inline std::string trajectory_csv(const recording& r, const fitted& fit, double rate) {
  std::string text = "timestamp,tx,ty,tz,qx,qy,qz,qw";
  for (const char* const prefix : {",", ",sd_"}) {
    for (const char* const name : {"v", "w", "a", "alpha"}) {
      for (const char* const axis : {"x", "y", "z"}) {
        text += std::string(prefix) + name + axis;
      }
    }
  }
  text += "\n";
  const curve& s = fit.curve;
  const auto covariance = fit.covariance();
  const double end = s.basis().back();
  duet::span_hint hint;
  for (std::size_t i = 0; double(i) / rate <= end; ++i) {
    const double t = double(i) / rate;
    const auto m = s.motion(t, duet::frame::hybrid, hint);
    const auto x = duet::pose_coordinates(m.value);
    std::vector<double> numbers{r.start + t, x[0], x[1], x[2], x[4], x[5], x[6], x[3]};
    numbers.insert(numbers.end(), m.velocity.begin(), m.velocity.end());
    numbers.insert(numbers.end(), m.acceleration.begin(), m.acceleration.end());
    const auto variances = covariance.motion(t, duet::frame::hybrid).joint.diagonal();
    for (Eigen::Index k = 6; k < 18; ++k) {
      numbers.push_back(std::sqrt(variances[k]));
    }
    text += duet::csv_line(numbers);
  }
  return text;
}

/// Measured position and residual of every row.
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

/// Commands that read a few thousand evenly spaced lines of a table, once for both pictures.
inline std::string picture_data(const std::string& name, std::size_t max_lines, std::size_t lines,
                                const std::string& columns) {
  return "set table $" + name + "\nplot '" + name + ".csv' skip 1 every " +
         std::to_string(lines / max_lines + 1) + " using " + columns + " with table\nunset table\n";
}

/// The time at which the three coordinates are best separated, and their values: the position of
/// their names; of the position or the angular velocity.
inline std::pair<double, vector3<double>> best_separated(const curve& s, bool is_position) {
  std::pair<double, vector3<double>> result{};
  double widest = -1;
  for (int i = 4; i <= 96; ++i) {
    const double t = s.basis().back() * i / 100;
    const auto m = s.motion(t, duet::frame::hybrid);
    const vector3<double> x = is_position ? vector3<double>(duet::translation(m.value))
                                          : vector3<double>(m.velocity.template tail<3>());
    const double separation =
        std::min({std::abs(x[0] - x[1]), std::abs(x[1] - x[2]), std::abs(x[2] - x[0])});
    if (separation > widest) {
      widest = separation;
      result = {t, x};
    }
  }
  return result;
}

/// Position with outliers, angular velocity, an angular acceleration with the band that holds the
/// true one with 95 % probability, and residuals.
/// \param rows, poses  their numbers; with more than 5000 rows outliers are not drawn
inline std::string picture_script(double start, double duration, const smoothed& s,
                                  std::size_t rows, std::size_t poses) {
  const std::string first = "-(" + duet::to_text(start) + ")";
  const char* const colours[] = {"vermillion", "green", "blue"};
  const char* const axes[] = {"x", "y", "z"};
  std::string outlier_points;
  if (rows <= 5000) {
    for (int k = 2; k < 5; ++k) {
      outlier_points += "$rows using 1:($6 > 0 ? $" + std::to_string(k) +
                        " : 1/0) with points pt 7 ps .5 lc rgb grey, \\\n     ";
    }
  }
  const auto curves = [&](bool is_position) {
    std::string names, text = "plot " + (is_position ? outlier_points : "");
    const auto [t, values] = best_separated(s.fit.curve, is_position);
    for (std::size_t k = 0; k < 3; ++k) {
      names += std::string("set label '") + axes[k] + "' at " + duet::to_text(t) + "," +
               duet::to_text(values[Eigen::Index(k)]) + " center offset 0,.7 front tc rgb " +
               colours[k] + "\n";
      text += "$trajectory using 1:" + std::to_string((is_position ? 2 : 5) + k) +
              " with lines lw 2 lc rgb " + colours[k] + (k < 2 ? ", \\\n     " : "\n");
    }
    return names + text + "unset label\n";
  };
  double largest = 0; // of the angular acceleration and its band, without the uncertain ends
  const auto covariance = s.fit.covariance();
  for (int i = 4; i <= 96; ++i) {
    const double t = duration * i / 100;
    largest = std::max(
        largest, std::abs(s.fit.curve.motion(t, duet::frame::hybrid).acceleration[3]) +
                     2 * std::sqrt(covariance.motion(t, duet::frame::hybrid).acceleration()(3, 3)));
  }
  const std::string reach = duet::to_text(std::ceil(1.2 * largest));
  std::string text =
      "if (!exists('is_read')) {\n" +
      picture_data("trajectory", 600, poses, "($1" + first + "):2:3:4:12:13:14:18:30") +
      picture_data("rows", 2000, rows, "($2" + first + "):3:4:5:6:7") +
      "is_read = 1\n}\nset datafile separator whitespace\n"
      "set multiplot layout 2,2 title " +
      example::title(std::to_string(outliers(s)) + " of " + std::to_string(rows) +
                     " rows are far off, and do not pull the curve") +
      "\nset lmargin 10\nset rmargin 3\nset offsets 0,0,graph .15,0\nset xrange [0:" +
      duet::to_text(duration) + "]\nset ytics .5\nset ylabel 'position / m'\n" + curves(true) +
      "set ylabel 'angular velocity / (rad/s)'\n" + curves(false) +
      "set xlabel 'time / s'\nset ylabel 'acceleration about x / (rad/s^2)'\nset ytics 2\n"
      "set yrange [-" +
      reach + ":" + reach +
      "]\n"
      "set label 'light: 95 %' at graph .98,.93 right tc rgb vermillion\n"
      "plot $trajectory using 1:($8 - 1.96 * $9):($8 + 1.96 * $9) with filledcurves fs solid .3 "
      "noborder lc rgb vermillion, \\\n     $trajectory using 1:8 with lines lw 2 lc rgb "
      "vermillion\nunset label\nset yrange [*:*]\n";
  const std::string limit = duet::to_text(s.outlier);
  return text +
         "set ylabel 'residual / rad'\nset offsets 0,0,0,0\nset logscale y\nset ytics 10\n"
         "set format y '10^{%T}'\nset label 'far off' at graph .98,.75 right tc rgb ink\n"
         "plot $rows using 1:5 with points pt 5 ps .15 lc rgb grey, \\\n     " +
         limit + " with lines lw 2 dt 2 lc rgb ink\nunset multiplot\n";
}

} // namespace fit_trajectory
