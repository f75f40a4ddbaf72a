// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Inverse kinematics: joint coordinates within the limits for a pose of the tip of an arm, or for
// each pose of a file; otherwise the reason why there are none. The arm is built in or read from a
// URDF file.

#include "support/arms.hpp"
#include "support/command_line.hpp"
#include "support/poses.hpp"
#include "support/program.hpp"
#include "support/progress_line.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/core/text/file.hpp>
#include <duet/duet.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace duet;
using solution = inverse_kinematics_result;

struct goal {
  std::string name; ///< option, or file and line
  dual_quaternion<double> pose;
};

/// The pose of the tip at a third of each joint range.
[[nodiscard]] goal example_goal(const example::arm_chain& arm) {
  Eigen::VectorXd theta(arm.size());
  for (int i = 0; i < arm.size(); ++i) {
    const double x = (2 * arm.limits(i).lower + arm.limits(i).upper) / 3;
    theta[i] = x - x == 0 ? x : 1;
  }
  return {"the goal", arm.pose(theta)};
}

[[nodiscard]] std::vector<goal> goals_of(const example::command_line& arguments,
                                         const example::arm_chain& arm) {
  if (arguments.has("goal") && arguments.has("goals")) {
    throw std::runtime_error("--goal and --goals exclude each other");
  }
  if (const auto text = arguments.text("goal")) {
    return {{"--goal", example::parse_pose("--goal", *text)}};
  }
  const auto path = arguments.text("goals");
  if (!path) {
    return {example_goal(arm)};
  }
  std::vector<goal> result;
  for (const auto& [line, pose] : example::read_poses(*path)) {
    result.push_back({*path + ":" + std::to_string(line), pose});
  }
  return result;
}

[[nodiscard]] std::string failure_message(const goal& target, const solution& results) {
  std::ostringstream text;
  text << target.name << ": not reached (" << to_text(results.reason) << "), "
       << results.deviation.translation << " m and " << results.deviation.rotation
       << " rad from it in the closest configuration";
  return text.str();
}

void write_joints(const std::string& path, const std::vector<solution>& results) {
  std::string text;
  for (Eigen::Index i = 0; i < results.front().joints.size(); ++i) {
    text += "q" + std::to_string(i) + ",";
  }
  text += "is_reached,length,angle\n";
  for (const solution& s : results) {
    std::vector<double> row(s.joints.begin(), s.joints.end());
    row.insert(row.end(), {s.reason == stop_reason::reached ? 1.0 : 0.0, s.deviation.translation,
                           s.deviation.rotation});
    text += csv_line(row);
  }
  write_file(path, text);
}

void solve(const example::command_line& arguments) {
  const auto out = arguments.text("out");
  if (out) {
    require_writable(*out);
  }
  const example::arm_chain arm = example::arm_of(arguments);
  const Eigen::VectorXd start = example::coordinates(arm, arguments, "start");
  const std::vector<goal> goals = goals_of(arguments, arm);
  inverse_kinematics_options options;
  options.tolerance = arguments.get<double>("tolerance").value_or(options.tolerance.translation);
  options.max_restarts = arguments.get<int>("max-restarts").value_or(options.max_restarts);
  options.seed = arguments.get<std::uint64_t>("seed").value_or(options.seed);

  std::vector<dual_quaternion<double>> poses;
  for (const goal& g : goals) {
    poses.push_back(g.pose);
  }
  std::vector<solution> results(goals.size());
  {
    example::progress_line line("goals");
    inverse_kinematics(arm, poses, start, results, options, {.threads = 0, .report = line});
  }
  if (goals.size() == 1 && results[0].reason != stop_reason::reached) {
    throw std::runtime_error(failure_message(goals[0], results[0]));
  }
  int reached = 0, iterations = 0, restarts = 0;
  double deviation = 0;
  for (std::size_t k = 0; k < goals.size(); ++k) {
    const solution& s = results[k];
    iterations += s.iterations;
    restarts += s.restarts;
    if (s.reason != stop_reason::reached) {
      std::printf("%s\n", printable(failure_message(goals[k], s)).c_str());
      continue;
    }
    ++reached;
    deviation = std::max({deviation, s.deviation.translation, s.deviation.rotation});
    if (goals.size() == 1) {
      std::printf("joints  ");
      for (const double x : s.joints) {
        std::printf(" %9.6f", x);
      }
      std::printf("\n");
    }
  }
  if (out) {
    write_joints(*out, results);
  }
  std::printf("inverse kinematics: reached=%d of=%zu iterations=%d restarts=%d deviation=%.2g\n",
              reached, goals.size(), iterations, restarts, deviation);
}

} // namespace

int main(int argc, char** argv) {
  return example::run_program("inverse_kinematics", [&] {
    example::option_list description(
        "Inverse kinematics of a robot arm within its joint limits.\nA pose is "
        "x,y,z,qw,qx,qy,qz (scalar first), or a matrix [R t; 0 1] row by row, 12 or 16 numbers.\n"
        "Metres and radians. Options");
    example::add_arm_options(description);
    description.value<std::string>(
        "goal", "POSE",
        "pose of the tip, comma-separated (default: that at a third of all joint ranges)");
    description.value<std::string>("goals", "FILE",
                                   "CSV file with a pose on each line, instead of --goal");
    description.value<std::string>("start", "X,X,...",
                                   "initial guess (default: the midpoint of the limits)");
    description.value<double>("tolerance", "X",
                              "tolerance of the pose, in metres and radians (default: 1e-6)");
    description.value<int>("max-restarts", "N", "maximum number of random restarts (default: 100)");
    description.value<std::uint64_t>("seed", "N", "seed of the random restarts (default: 1)");
    description.value<std::string>("out", "FILE", "CSV file for the solution of each goal");
    description.flag("help", "print this and stop");
    const auto line = example::command_line::parse(argc, argv, description);
    if (line) {
      solve(*line);
    }
    return 0;
  });
}
