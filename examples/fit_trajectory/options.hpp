// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "../support/command_line.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

/// \file
/// The command line.

namespace fit_trajectory {

struct options {
  std::optional<std::string> file;
  std::string times; ///< a file of them, empty if none
  int rows_per_knot = 10;
  std::optional<double> rate;
  double length = 1;
  double outlier = 0; ///< 0: from the data
  std::string out = "fit_trajectory_out";
};

/// Nothing where only help was asked for.
/// \throws std::exception with a one-line message
inline std::optional<options> parse_options(int argc, char** argv) {
  example::option_list description(
      "A smooth curve near recorded motion, by least squares over a cumulative cubic B-spline of\n"
      "poses, with velocities and accelerations (trajectory.csv), residuals (rows.csv) and "
      "pictures.\n\n  fit_trajectory [FILE] [options]\n\n"
      "FILE has rows `timestamp tx ty tz qx qy qz qw` (seconds, metres, # starts a comment), or a "
      "header, a\nfirst line or a comment, that names the columns in another order; files of the "
      "EuRoC and KITTI data sets\nare known. Without FILE, a made-up recording is taken. Rows that "
      "are no poses or repeat a timestamp are\nnamed and left out. Velocities and accelerations "
      "are in fixed "
      "axes, those of the origin and angular ones.\nOptions");
  description.flag("help", "print this and stop")
      .value<std::string>("file", "FILE", "the recording")
      .value<std::string>("times", "FILE",
                          "times of a recording of KITTI, in seconds (default: a row a second)")
      .value<int>("rows-per-knot", "N",
                  "rows from one knot to the next; more are smoother (default: 10)")
      .value<double>(
          "rate", "HZ",
          "poses per second of trajectory.csv (default: 100, fewer where that made more than a "
          "million)")
      .value<double>("length", "M",
                     "metres that count as much as a turn by one radian (default: 1)")
      .value<double>(
          "outlier", "R",
          "residual beyond which a row counts less (default: three times the median of a plain "
          "fit)")
      .value<std::string>("out", "DIR",
                          "folder for tables and pictures (default: fit_trajectory_out)");
  const auto given = example::command_line::parse(argc, argv, description, "file");
  if (!given) {
    return std::nullopt;
  }
  options result;
  result.file = given->text("file");
  result.times = given->text("times").value_or(result.times);
  result.rows_per_knot = given->get<int>("rows-per-knot").value_or(result.rows_per_knot);
  result.out = given->text("out").value_or(result.out);
  if (!result.file && !result.times.empty()) {
    throw std::runtime_error("--times: a FILE with the poses expected, too");
  }
  if (result.rows_per_knot < 1) {
    throw std::runtime_error("--rows-per-knot: 1 or more");
  }
  const auto positive = [&](const char* name, auto& value) {
    if (const auto number = given->get<double>(name)) {
      if (!(*number > 0) || !std::isfinite(*number)) {
        throw std::runtime_error(std::string("--") + name + ": a positive number expected");
      }
      value = *number;
    }
  };
  positive("rate", result.rate);
  positive("length", result.length);
  positive("outlier", result.outlier);
  return result;
}

} // namespace fit_trajectory
