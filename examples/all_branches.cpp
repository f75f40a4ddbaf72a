// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// All inverse kinematics solutions of a six-joint arm for a pose, as a table and drawn over each
// other: of a UR5e, and of the arm with which Manseur and Doty showed that there can be sixteen.

#include "support/command_line.hpp"
#include "support/drawing.hpp"
#include "support/folder.hpp"
#include "support/gnuplot.hpp"
#include "support/program.hpp"

#include <duet/core/text/file.hpp>
#include <duet/duet.hpp>
#include <duet/robotics/all_inverse_kinematics.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace duet;
using arm_chain = serial_chain<6>;
using branches = all_inverse_kinematics_result;

/// R. Manseur and K. L. Doty, A robot manipulator with 16 real inverse kinematic solution sets,
/// 1989.
[[nodiscard]] arm_chain manseur_doty() {
  const double degree = std::numbers::pi / 180;
  const std::array<dh_row<>, 6> rows{{{.a = .3, .alpha = 90 * degree},
                                      {.a = 1, .alpha = degree},
                                      {.d = .2, .alpha = 90 * degree},
                                      {.a = 1.5, .alpha = degree},
                                      {.alpha = 90 * degree},
                                      {.alpha = degree}}};
  return from_dh(rows);
}

void print(const std::string& name, const branches& result) {
  std::printf("%s: %zu real solutions, %d complex solutions (%s%s)\n", name.c_str(),
              result.solutions.size(), result.complex_solutions, to_text(result.method),
              result.is_complete ? "" : ", not certified complete");
  std::printf("  joints, degrees                                        smallest singular value\n");
  for (const auto& s : result.solutions) {
    for (const double x : s.joints) {
      std::printf(" %8.2f", 180 / std::numbers::pi * x);
    }
    std::printf("   %.4f%s\n", s.smallest_singular_value,
                s.within_limits ? "" : " (beyond limits)");
  }
}

/// Origins of the link frames, from the base to the tip.
[[nodiscard]] std::vector<example::point> bones(const arm_chain& arm,
                                                const Eigen::Matrix<double, 6, 1>& theta) {
  std::vector<example::point> result{example::point::Zero()};
  for (int i = 1; i <= arm.size(); ++i) {
    result.push_back(translation(arm.pose(theta, i)));
  }
  result.push_back(translation(arm.pose(theta)));
  return result;
}

void draw(const std::string& folder, const std::string& name, const arm_chain& arm,
          const dual_quaternion<double>& goal, const branches& result) {
  constexpr std::array colours{"#0072b2", "#d55e00", "#00805d", "#a8497c",
                               "#b37700", "#6e7781", "#56b4e9", "#24292f"};
  example::drawing picture({3, -4, 2});
  double size = 0;
  for (std::size_t k = 0; k < result.solutions.size(); ++k) {
    const auto points = bones(arm, result.solutions[k].joints);
    for (const auto& p : points) {
      size = std::max(size, p.norm());
    }
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      picture.capsule(points[i], points[i + 1], .012 * size, colours[k % colours.size()]);
    }
  }
  const Eigen::Matrix3d axes = rotation_matrix(rotation(goal));
  const example::point origin = translation(goal);
  for (int i = 0; i < 3; ++i) {
    picture.arrow(origin, origin + .2 * size * axes.col(i), "#24292f", "lw 1.5");
  }
  write_file(folder + "/" + name + ".csv", picture.csv());
  if (!example::draw(folder, name, 640, picture.script(name + ".csv"))) {
    std::printf("No picture: gnuplot is not installed\n");
  }
}

void show(const std::string& folder, const std::string& file, const std::string& name,
          const arm_chain& arm, const dual_quaternion<double>& goal) {
  const branches result = all_inverse_kinematics(arm, goal);
  print(name, result);
  draw(folder, file, arm, goal, result);
}

} // namespace

int main(int argc, char** argv) {
  return example::run_program("all_branches", [&] {
    example::option_list description(
        "All inverse kinematics solutions of two six-joint arms for a pose. Options");
    description.value<std::string>(
        "out", "FOLDER", "output folder for tables and pictures (default: all_branches_out)");
    description.flag("help", "print this and stop");
    if (const auto line = example::command_line::parse(argc, argv, description)) {
      const std::string folder = line->text("out").value_or("all_branches_out");
      example::require_folder(folder);
      std::filesystem::create_directories(folder);
      const arm_chain ur5e = robots::ur5e().table();
      Eigen::Matrix<double, 6, 1> theta;
      theta << .3, -1.1, 1.4, -.5, .9, .2;
      show(folder, "ur5e", "UR5e", ur5e, ur5e.pose(theta));
      Eigen::Matrix3d axes_of_goal;
      axes_of_goal << -.760117, -.641689, .102262, .133333, 0, .991071, -.635959, .766965, .085558;
      show(folder, "sixteen", "Manseur and Doty", manseur_doty(),
           normalized(pose(from_rotation_matrix(axes_of_goal), Eigen::Vector3d(-1.140175, 0, 0))));
    }
    return 0;
  });
}
