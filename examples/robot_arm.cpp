// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A robot arm in a given configuration: forward kinematics, Jacobian, manipulability, and the
// difference between the closed form of the Jacobian and automatic differentiation. The arm is
// built in or read from a URDF file.

#include "support/arms.hpp"
#include "support/command_line.hpp"
#include "support/program.hpp"

#include <duet/duet.hpp>

#include <cstdio>
#include <string>

namespace {

using namespace duet;

void report(const example::arm_chain& arm, const Eigen::VectorXd& theta) {
  const auto [tip, J] = pose_and_jacobian(arm, theta, frame::hybrid);
  const auto t = translation(tip);
  const auto q = rotation(tip);
  std::printf("joints  ");
  for (int i = 0; i < arm.size(); ++i) {
    const bool is_inside = arm.limits(i).lower <= theta[i] && theta[i] <= arm.limits(i).upper;
    std::printf(" %9.5f%s", theta[i], is_inside ? "" : " (outside its limits)");
  }
  std::printf("\ntip at   %9.5f %9.5f %9.5f  rotation (%.5f, %.5f, %.5f, %.5f)\n", t[0], t[1], t[2],
              q.w(), q.x(), q.y(), q.z());
  std::printf("Jacobian, hybrid frame: v of the tip and omega in the axes of the base:\n");
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

} // namespace

int main(int argc, char** argv) {
  return example::run_program("robot_arm", [&] {
    example::option_list description(
        "Forward kinematics and Jacobian of a robot arm in a configuration. Options");
    example::add_arm_options(description);
    description.value<std::string>(
        "joints", "X,X,...",
        "coordinates, as 0,0.5,-1: radians or metres (default: the midpoint of the limits)");
    description.flag("help", "print this and stop");
    const auto line = example::command_line::parse(argc, argv, description);
    if (!line) {
      return 0;
    }
    const example::arm_chain arm = example::arm_of(*line);
    report(arm, example::coordinates(arm, *line, "joints"));
    return 0;
  });
}
