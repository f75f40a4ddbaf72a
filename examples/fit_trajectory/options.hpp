// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "../support/command_line.hpp"

#include <duet/core/text/number_text.hpp>

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
  int samples_per_knot = 10;
  std::optional<double> rate;
  double characteristic_length = 1;
  double outlier_threshold = 0; ///< 0: from the data
  std::string out = "fit_trajectory_out";
};

/// Returns nothing if only help was requested.
/// \throws std::exception with a one-line message
inline std::optional<options> parse_options(int argc, char** argv) {
  example::option_list description(
      "Fits a smooth curve to recorded motion: robust least squares with a cumulative cubic "
      "B-spline of\n"
      "poses, with velocities, accelerations and their standard deviations (trajectory.csv), "
      "residuals\n(rows.csv) and "
      "pictures.\n\n  fit_trajectory [FILE] [options]\n\n"
      "FILE has rows `timestamp tx ty tz qx qy qz qw` (seconds, metres, # starts a comment), or a "
      "header, a\nfirst line or a comment, that names the columns in any order; files of the "
      "EuRoC and KITTI data sets\nare recognised. Without FILE, a synthetic recording is fitted. "
      "Rows that "
      "are not poses or repeat a timestamp are\nreported and skipped. Velocities and accelerations "
      "are in fixed "
      "axes, those of the origin and angular ones.\nOptions");
  description.flag("help", "print this and stop")
      .value<std::string>("file", "FILE", "the recording")
      .value<std::string>("times", "FILE",
                          "times of a KITTI recording, in seconds (default: one row a second)")
      .value<int>("samples-per-knot", "N",
                  "samples from one knot to the next; more give a smoother curve (default: 10)")
      .value<double>(
          "rate", "HZ",
          "poses per second of trajectory.csv (default: 100, or less for at most a million "
          "poses)")
      .value<double>("characteristic-length", "M",
                     "translation that counts as much as a rotation by one radian (default: 1)")
      .value<double>(
          "outlier-threshold", "R",
          "residual beyond which a sample has less weight (default: three times the median of a "
          "least-squares fit)")
      .value<std::string>("out", "DIR",
                          "folder for tables and pictures (default: fit_trajectory_out)");
  const auto arguments = example::command_line::parse(argc, argv, description, "file");
  if (!arguments) {
    return std::nullopt;
  }
  options result;
  result.file = arguments->text("file");
  result.times = arguments->text("times").value_or(result.times);
  result.samples_per_knot =
      arguments->get<int>("samples-per-knot").value_or(result.samples_per_knot);
  result.out = arguments->text("out").value_or(result.out);
  if (!result.file && !result.times.empty()) {
    throw std::runtime_error("--times requires FILE, the poses");
  }
  if (result.samples_per_knot < 1) {
    throw std::runtime_error("--samples-per-knot is " + std::to_string(result.samples_per_knot) +
                             " (expected at least 1)");
  }
  const auto positive = [&](const char* name, auto& value) {
    if (const auto number = arguments->get<double>(name)) {
      if (!(*number > 0) || !std::isfinite(*number)) {
        throw std::runtime_error(std::string("--") + name + " is " + duet::to_text(*number) +
                                 " (expected a positive number)");
      }
      value = *number;
    }
  };
  positive("rate", result.rate);
  positive("characteristic-length", result.characteristic_length);
  positive("outlier-threshold", result.outlier_threshold);
  return result;
}

} // namespace fit_trajectory
