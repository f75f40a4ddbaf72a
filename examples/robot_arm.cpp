// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A robot arm at given joint coordinates: where its tip is, how it moves with each joint, how far
// it is from a singularity, and whether the closed form of its Jacobian agrees with automatic
// differentiation. The arm is one of duet's or read from a URDF file.

#include "support/command_line.hpp"

#include <duet/duet.hpp>

#include <cstdio>
#include <exception>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace duet;
namespace po = example::po;

struct options {
  std::string robot, urdf, base, tip, joints;
};

/// Any of the arms, so that what follows is compiled once.
using chain = serial_chain<-16>;

/// Numbers apart by commas; without any text the middle of the limits, or 0 where there are none.
[[nodiscard]] Eigen::VectorXd coordinates(const chain& arm, const std::string& text) {
  Eigen::VectorXd theta(arm.size());
  if (text.empty()) {
    for (int i = 0; i < arm.size(); ++i) {
      const double middle = (arm.limits(i).lower + arm.limits(i).upper) / 2;
      theta[i] = middle - middle == 0 ? middle : 0;
    }
    return theta;
  }
  std::istringstream cells(text);
  std::string cell;
  int count = 0;
  for (; std::getline(cells, cell, ','); ++count) {
    const auto number = parse_number(cell);
    if (!number || !(*number - *number == 0)) {
      throw std::runtime_error("--joints: '" + cell + "' is not a finite number");
    }
    if (count < arm.size()) {
      theta[count] = *number;
    }
  }
  if (count != arm.size()) {
    throw std::runtime_error("--joints: " + std::to_string(arm.size()) + " numbers expected, got " +
                             std::to_string(count));
  }
  return theta;
}

void report(const chain& arm, const options& given) {
  if (arm.size() == 0) {
    throw std::runtime_error("no joint moves between base and tip");
  }
  const Eigen::VectorXd theta = coordinates(arm, given.joints);
  const auto [tip, J] = pose_and_jacobian(arm, theta, frame::hybrid);
  const auto t = translation(tip);
  const auto q = rotation(tip);
  std::printf("joints  ");
  for (int i = 0; i < arm.size(); ++i) {
    const bool is_inside = arm.limits(i).lower <= theta[i] && theta[i] <= arm.limits(i).upper;
    std::printf(" %9.5f%s", theta[i], is_inside ? "" : " (outside its limits)");
  }
  std::printf("\ntip at   %9.5f %9.5f %9.5f  turned by (%.5f, %.5f, %.5f, %.5f)\n", t[0], t[1],
              t[2], q.w(), q.x(), q.y(), q.z());
  std::printf("velocities with each joint, v of the tip and omega, in the base's axes:\n");
  for (Eigen::Index i = 0; i < 6; ++i) {
    std::printf("  %c_%c    ", i < 3 ? 'v' : 'w', "xyz"[i % 3]);
    for (Eigen::Index k = 0; k < J.cols(); ++k) {
      std::printf(" %9.5f", J(i, k) == 0 ? 0.0 : J(i, k));
    }
    std::printf("\n");
  }
  // ∂γ/∂θ by the closed form and by dual numbers through the pose.
  const auto by_duals =
      jacobian([&](const auto& x) { return pose_coordinates(arm.pose(x)); }, theta).jacobian;
  const double difference =
      (pose_coordinates_jacobian(arm, theta) - by_duals).cwiseAbs().maxCoeff();
  std::printf("robot arm: joints=%d manipulability=%.6g ad_vs_closed_form=%.2g\n", arm.size(),
              manipulability(arm, theta), difference);
}

[[nodiscard]] chain arm_of(const options& given) {
  if (!given.urdf.empty()) {
    return read_urdf(given.urdf, given.base, given.tip);
  }
  if (given.robot == "panda") {
    return robots::panda().table();
  }
  if (given.robot == "iiwa14") {
    return robots::iiwa14().table();
  }
  if (given.robot == "ur5e") {
    return robots::ur5e().table();
  }
  if (given.robot == "baxter_left") {
    return robots::baxter_left().table();
  }
  throw std::runtime_error("--robot: '" + given.robot +
                           "' is none of panda, iiwa14, ur5e and baxter_left");
}

} // namespace

int main(int argc, char** argv) {
  try {
    po::options_description description("A robot arm at given joint coordinates. Options");
    auto add = description.add_options();
    const auto text = [](const char* what) { return po::value<std::string>()->value_name(what); };
    add("help", "print this and stop");
    add("robot", text("NAME"), "panda, iiwa14, ur5e or baxter_left (default: panda)");
    add("urdf", text("FILE"), "a robot description instead, with --base and --tip");
    add("base", text("LINK"), "its link to start from");
    add("tip", text("LINK"), "its link to end with");
    add("joints", text("X,X,..."),
        "coordinates, as 0,0.5,-1: radians or metres (default: the middle of the limits)");
    const auto line = example::command_line::parse(argc, argv, description);
    if (!line) {
      return 0;
    }
    options given;
    given.robot = line->text("robot").value_or("panda");
    given.urdf = line->text("urdf").value_or("");
    given.base = line->text("base").value_or("");
    given.tip = line->text("tip").value_or("");
    given.joints = line->text("joints").value_or("");
    report(arm_of(given), given);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "robot_arm: " << error.what() << "\n";
    return 1;
  }
}
