// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "../support/command_line.hpp"
#include "../support/poses.hpp"

#include <duet/core/errors.hpp>
#include <duet/core/text/csv.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/rotation.hpp>

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// \file
/// The command line.

namespace screw_motion {

using pose_type = duet::dual_quaternion<double>;

struct options {
  std::optional<std::string> from, to, file;
  int steps = 60;
  bool is_longer_arc = false;
  std::string out = "screw_motion_out";
};

/// The two poses of the command line, of the file, or of an example.
inline std::pair<pose_type, pose_type> poses(const options& settings) {
  if (settings.file) {
    const auto rows = example::read_poses(*settings.file);
    if (rows.size() != 2) {
      throw duet::file_error(*settings.file,
                             "two poses are needed, not " + std::to_string(rows.size()));
    }
    return {rows[0].pose, rows[1].pose};
  }
  if (settings.from && settings.to) {
    return {example::parse_pose("--from", *settings.from),
            example::parse_pose("--to", *settings.to)};
  }
  const auto rotation = [](double x, double y, double z, double angle) {
    return duet::from_axis_angle(duet::vector3<double>(x, y, z), angle);
  };
  return {duet::pose(rotation(1, 0, 0, 0.3), duet::vector3<double>(0.6, 0, 0)),
          duet::pose(rotation(0.2, -0.1, 1, 2.6), duet::vector3<double>(-0.5, 0.3, 0.9))};
}

/// Returns nothing if only help was requested.
/// \throws std::exception with a one-line message
inline std::optional<options> parse_options(int argc, char** argv) {
  example::option_list description(
      "The screw motion from one pose to another, with its axis, angle and pitch in words, poses "
      "and\nvelocities along it (path.csv) and a picture of frames along it.\n"
      "A pose is x,y,z,qw,qx,qy,qz (scalar first), or a matrix [R t; 0 1] row by row, 12 or 16 "
      "numbers.\nAngles in radians, axes fixed. Options");
  description.flag("help", "print this and stop")
      .value<std::string>("from", "POSE", "first pose, comma-separated")
      .value<std::string>("to", "POSE", "second pose")
      .value<std::string>("file", "FILE",
                          "CSV file with both poses, a line each, instead of --from and --to")
      .value<int>("steps", "N", "intervals of the table, which has N + 1 rows (default: 60)")
      .flag("longer-arc", "rotate along the longer arc")
      .value<std::string>("out", "DIR",
                          "folder for the table and the picture (default: screw_motion_out)");
  const auto arguments = example::command_line::parse(argc, argv, description);
  if (!arguments) {
    return std::nullopt;
  }
  options result;
  result.from = arguments->text("from");
  result.to = arguments->text("to");
  result.file = arguments->text("file");
  result.out = arguments->text("out").value_or(result.out);
  result.is_longer_arc = arguments->has("longer-arc");
  result.steps = arguments->get<int>("steps").value_or(result.steps);
  if (result.from.has_value() != result.to.has_value()) {
    throw std::runtime_error(
        std::string(result.from ? "--from requires --to" : "--to requires --from"));
  }
  if (result.file && result.from) {
    throw std::runtime_error("--file and --from exclude each other");
  }
  if (result.steps < 1) {
    throw std::runtime_error("--steps is " + std::to_string(result.steps) +
                             " (expected at least 1)");
  }
  return result;
}

} // namespace screw_motion
