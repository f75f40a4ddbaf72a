// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "command_line.hpp"
#include "numbers.hpp"

#include <duet/io/urdf.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/kinematics/serial_chain.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

/// \file
/// The arms of the examples: the built-in ones, or one from a URDF file.

namespace example {

/// One type for all arms, so that code for it is compiled once.
using arm_chain = duet::bounded_chain<16>;

/// The options --robot, --urdf, --base and --tip.
inline void add_arm_options(example::option_list& description) {
  description.value<std::string>("robot", "NAME",
                                 "panda, iiwa14, ur5e or baxter_left (default: panda)");
  description.value<std::string>("urdf", "FILE",
                                 "robot description (URDF) instead, with --base and --tip");
  description.value<std::string>("base", "LINK", "base link of the chain");
  description.value<std::string>("tip", "LINK", "tip link of the chain");
}

/// The arm that these options name.
[[nodiscard]] inline arm_chain arm_of(const command_line& arguments) {
  namespace robots = duet::robots;
  const auto joints_of = [](const arm_chain& arm) {
    if (arm.size() == 0) {
      throw std::runtime_error("there is no movable joint between base and tip");
    }
    return arm;
  };
  if (const auto file = arguments.text("urdf")) {
    return joints_of(duet::read_urdf(*file, arguments.text("base").value_or(""),
                                     arguments.text("tip").value_or("")));
  }
  const std::string name = arguments.text("robot").value_or("panda");
  if (name == "panda") {
    return robots::panda().table();
  }
  if (name == "iiwa14") {
    return robots::iiwa14().table();
  }
  if (name == "ur5e") {
    return robots::ur5e().table();
  }
  if (name == "baxter_left") {
    return robots::baxter_left().table();
  }
  throw std::runtime_error("--robot is '" + name +
                           "' (expected panda, iiwa14, ur5e or baxter_left)");
}

/// The coordinates from the option of this name; by default the midpoint of the limits, or 0
/// without limits.
[[nodiscard]] inline Eigen::VectorXd
coordinates(const arm_chain& arm, const command_line& arguments, const std::string& name) {
  Eigen::VectorXd theta(arm.size());
  const auto text = arguments.text(name);
  if (!text) {
    for (int i = 0; i < arm.size(); ++i) {
      const double middle = (arm.limits(i).lower + arm.limits(i).upper) / 2;
      theta[i] = middle - middle == 0 ? middle : 0;
    }
    return theta;
  }
  const std::vector<double> numbers = parse_numbers("--" + name, *text);
  if (numbers.size() != std::size_t(arm.size())) {
    throw std::runtime_error("--" + name + ": " + std::to_string(arm.size()) +
                             " numbers expected, got " + std::to_string(numbers.size()));
  }
  for (int i = 0; i < arm.size(); ++i) {
    theta[i] = numbers[std::size_t(i)];
  }
  return theta;
}

} // namespace example
