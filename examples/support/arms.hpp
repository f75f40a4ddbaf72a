// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "command_line.hpp"

#include <duet/core/number_text.hpp>
#include <duet/mechanism/robots.hpp>
#include <duet/mechanism/urdf.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

/// \file
/// Arms by name or from files, and numbers for them, from command lines.

namespace example {

/// Any of the arms, so that what works on it is compiled once.
using arm = duet::serial_chain<-16>;

/// The options `arm_of` reads.
inline void add_arm_options(po::options_description& description) {
  const auto text = [](const char* what) { return po::value<std::string>()->value_name(what); };
  auto add = description.add_options();
  add("robot", text("NAME"), "panda, iiwa14, ur5e or baxter_left (default: panda)");
  add("urdf", text("FILE"), "a robot description instead, with --base and --tip");
  add("base", text("LINK"), "its link to start from");
  add("tip", text("LINK"), "its link to end with");
}

/// \throws std::exception with a one-line message
[[nodiscard]] inline arm arm_of(const command_line& given) {
  if (const auto file = given.text("urdf")) {
    const arm read =
        duet::read_urdf(*file, given.text("base").value_or(""), given.text("tip").value_or(""));
    if (read.size() == 0) {
      throw std::runtime_error("no joint moves between base and tip");
    }
    return read;
  }
  const std::string name = given.text("robot").value_or("panda");
  if (name == "panda") {
    return duet::robots::panda().table();
  }
  if (name == "iiwa14") {
    return duet::robots::iiwa14().table();
  }
  if (name == "ur5e") {
    return duet::robots::ur5e().table();
  }
  if (name == "baxter_left") {
    return duet::robots::baxter_left().table();
  }
  throw std::runtime_error("--robot: '" + name +
                           "' is none of panda, iiwa14, ur5e and baxter_left");
}

/// `count` numbers with commas between them, or any number of them.
/// \throws std::runtime_error with the option's name
[[nodiscard]] inline std::vector<double> numbers(const std::string& option, const std::string& text,
                                                 std::size_t count = 0) {
  std::vector<double> result;
  std::istringstream cells(text);
  std::string cell;
  while (std::getline(cells, cell, ',')) {
    const auto number = duet::parse_number(cell);
    if (!number || !(*number - *number == 0)) {
      throw std::runtime_error(option + ": '" + cell + "' is not a finite number");
    }
    result.push_back(*number);
  }
  if (count != 0 && result.size() != count) {
    throw std::runtime_error(option + ": " + std::to_string(count) + " numbers expected, got " +
                             std::to_string(result.size()));
  }
  return result;
}

[[nodiscard]] inline Eigen::VectorXd coordinates(const std::string& option, const std::string& text,
                                                 const arm& of) {
  const std::vector<double> x = numbers(option, text, std::size_t(of.size()));
  return Eigen::Map<const Eigen::VectorXd>(x.data(), of.size());
}

/// The middle of the limits, 0 where there are none.
[[nodiscard]] inline Eigen::VectorXd middle(const arm& of) {
  Eigen::VectorXd theta(of.size());
  for (int i = 0; i < of.size(); ++i) {
    const double half_way = (of.limits(i).lower + of.limits(i).upper) / 2;
    theta[i] = half_way - half_way == 0 ? half_way : 0;
  }
  return theta;
}

} // namespace example
