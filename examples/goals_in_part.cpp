// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Partial goals: the tool of a Panda has a given position and points down, and its rotation about
// its own axis is free. Solutions from different initial guesses, the one closest to a preferred
// posture, and one that avoids a ball, as a table and drawn over each other.

#include "support/command_line.hpp"
#include "support/drawing.hpp"
#include "support/folder.hpp"
#include "support/gnuplot.hpp"
#include "support/program.hpp"

#include <duet/core/random_source.hpp>
#include <duet/core/text/file.hpp>
#include <duet/duet.hpp>
#include <duet/robotics/goals.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace {

using namespace duet;
using joints = Eigen::Matrix<double, 7, 1>;
using solution = inverse_kinematics_result;

struct candidate {
  std::string name, colour;
  solution result;
  double thickness;
};

/// Origins of the link frames, from the base to the tip.
[[nodiscard]] std::vector<example::point> bones(const joints& theta) {
  std::vector<example::point> result{example::point::Zero()};
  for (int i = 1; i <= 7; ++i) {
    result.push_back(translation(robots::panda().pose(theta, i)));
  }
  result.push_back(translation(robots::panda().pose(theta)));
  return result;
}

/// Collision bodies along the links, and the ball as an obstacle.
[[nodiscard]] scene with_ball(const sphere<double>& ball) {
  scene result{.obstacles = {ball}, .margin = .01};
  const joints any = joints::Constant(.5);
  for (int i = 2; i <= 7; ++i) {
    const auto link_pose = robots::panda().pose(any, i);
    const auto next = i < 7 ? robots::panda().pose(any, i + 1) : robots::panda().pose(any);
    result.bodies.push_back(
        {i, {vector3<double>(0, 0, 0), transform_point(conj(link_pose), translation(next)), .06}});
  }
  return result;
}

void print(const std::vector<candidate>& candidates) {
  std::printf("%-24s  joints, radians\n", "");
  for (const candidate& each : candidates) {
    std::printf("%-24s", each.name.c_str());
    for (const double x : each.result.joints) {
      std::printf(" %7.3f", x);
    }
    std::printf("  %s\n", to_text(each.result.reason));
  }
}

void draw(const std::string& folder, const std::vector<candidate>& candidates,
          const sphere<double>& ball) {
  example::drawing picture({2.5, -3.5, 2.5});
  for (const candidate& each : candidates) {
    const auto points = bones(each.result.joints);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      picture.capsule(points[i], points[i + 1], each.thickness, each.colour);
    }
  }
  picture.ball(ball.centre, ball.radius, "#8c959f");
  write_file(folder + "/goals_in_part.csv", picture.csv());
  if (!example::draw(folder, "goals_in_part", 640, picture.script("goals_in_part.csv"))) {
    std::printf("No picture: gnuplot is not installed\n");
  }
}

void run(const std::string& folder) {
  const auto arm = robots::panda();
  const auto goal = position_and_pointing_goal(vector3<double>(.45, .1, .25),
                                               vector3<double>(0, 0, 1), vector3<double>(0, 0, -1));
  const joints posture(0, -.3, 0, -2.2, 0, 2, .8);
  const sphere<double> ball{vector3<double>(.1, 0, .67), .07};
  constexpr std::array colours{"#56b4e9", "#00805d", "#a8497c", "#b37700", "#6e7781", "#0072b2"};

  std::vector<candidate> candidates;
  random_source random(4);
  const joints lower = lower_limits(arm), upper = upper_limits(arm);
  for (std::size_t k = 0; k < colours.size(); ++k) {
    joints start;
    for (int i = 0; i < 7; ++i) {
      start[i] = random.uniform(lower[i], upper[i]);
    }
    candidates.push_back(
        {"from anywhere", colours[k], inverse_kinematics(arm, goal, start, {.seed = k + 1}), .012});
  }
  candidates.push_back({"nearest to the posture", "#24292f",
                        inverse_kinematics(arm, goal, posture, {}, preferred_posture{posture}),
                        .025});
  const scene scene_with_ball = with_ball(ball);
  candidates.push_back(
      {"and clear of the ball", "#d55e00",
       inverse_kinematics(arm, goal, posture, {}, preferred_posture{posture}, scene_with_ball),
       .025});
  print(candidates);
  for (std::size_t i = candidates.size() - 2; i < candidates.size(); ++i) {
    const joints& theta = candidates[i].result.joints;
    std::printf("%s: %.4f rad from the posture, %.4f m from the ball\n", candidates[i].name.c_str(),
                (theta - posture).norm(), clearance(arm, theta, scene_with_ball).distance);
  }
  draw(folder, candidates, ball);
}

} // namespace

int main(int argc, char** argv) {
  return example::run_program("goals_in_part", [&] {
    example::option_list description("Inverse kinematics of a Panda for a partial goal: position "
                                     "and direction of a tool. Options");
    description.value<std::string>(
        "out", "FOLDER", "output folder for tables and pictures (default: goals_in_part_out)");
    description.flag("help", "print this and stop");
    if (const auto line = example::command_line::parse(argc, argv, description)) {
      const std::string folder = line->text("out").value_or("goals_in_part_out");
      example::require_folder(folder);
      std::filesystem::create_directories(folder);
      run(folder);
    }
    return 0;
  });
}
