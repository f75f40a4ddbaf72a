// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "../support/arms.hpp"
#include "../support/command_line.hpp"
#include "../support/numbers.hpp"

#include <duet/core/text/number_text.hpp>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>

/// \file
/// The command line.

namespace path_following {

struct options {
  example::arm_chain arm;
  Eigen::VectorXd start;
  double radius = .08, pitch = .06, turns = 2;
  std::string out = "path_following_out";
};

/// Start configurations of the built-in arms, bent and far from the joint limits.
/// \throws std::runtime_error for a URDF file
inline std::string usual_start(const example::command_line& line) {
  if (line.has("urdf")) {
    throw std::runtime_error("--urdf requires --joints, the start configuration");
  }
  const std::string name = line.text("robot").value_or("panda");
  return name == "iiwa14"        ? "0,0.6,0,-1.2,0,0.9,0"
         : name == "ur5e"        ? "0,-1.2,1.6,-1.2,-1.2,0"
         : name == "baxter_left" ? "0,-0.6,0,1.2,0,0.9,0"
                                 : "0,-0.8,0,-2.4,0,1.6,0.8";
}

/// Nothing where only help was asked for.
/// \throws std::exception with a one-line message
inline std::optional<options> parse_options(int argc, char** argv) {
  example::option_list description(
      "The tip of an arm draws a helix about a vertical axis with constant orientation.\nWrites "
      "the joint "
      "path (path.csv) and a picture of it. Metres and radians. Options");
  description.flag("help", "print this and stop");
  example::add_arm_options(description);
  description.value<std::string>("joints", "X,X,...",
                                 "start configuration (default: a bent one, for built-in arms)");
  description.value<double>("radius", "R", "radius of the helix (default: 0.08)");
  description.value<double>("pitch", "P", "rise per turn, downwards if negative (default: 0.06)");
  description.value<double>("turns", "N", "number of turns (default: 2)");
  description.value<std::string>(
      "out", "DIR", "folder for the table and the picture (default: path_following_out)");
  const auto line = example::command_line::parse(argc, argv, description);
  if (!line) {
    return std::nullopt;
  }
  options result{example::arm_of(*line), {}};
  const std::string usual = line->has("joints") ? "" : usual_start(*line);
  const auto joints = example::parse_numbers("--joints", line->text("joints").value_or(usual));
  if (joints.size() != std::size_t(result.arm.size())) {
    throw std::runtime_error("--joints: " + std::to_string(result.arm.size()) +
                             " numbers expected, got " + std::to_string(joints.size()));
  }
  result.start = Eigen::Map<const Eigen::VectorXd>(joints.data(), result.arm.size());
  result.radius = line->get<double>("radius").value_or(result.radius);
  result.pitch = line->get<double>("pitch").value_or(result.pitch);
  result.turns = line->get<double>("turns").value_or(result.turns);
  result.out = line->text("out").value_or(result.out);
  if (!(result.radius >= 0 && std::isfinite(result.radius))) {
    throw std::runtime_error("--radius is " + duet::to_text(result.radius) +
                             " (expected at least 0)");
  }
  if (!std::isfinite(result.pitch)) {
    throw std::runtime_error("--pitch is " + duet::to_text(result.pitch) +
                             " (expected a finite number)");
  }
  if (!(result.turns > 0 && result.turns <= 1000)) {
    throw std::runtime_error("--turns is " + duet::to_text(result.turns) +
                             " (expected more than 0, at most 1000)");
  }
  return result;
}

} // namespace path_following
