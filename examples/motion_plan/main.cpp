// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Motion planning for a robot arm: the tip follows a screw motion to a goal, the joints respect
// their limits and avoid obstacles, and the time scaling respects limits of velocity, acceleration
// and jerk. The arm is built in or read from a URDF file.

#include "options.hpp"
#include "pictures.hpp"
#include "scene_drawing.hpp"
#include "tables.hpp"

#include "../support/folder.hpp"
#include "../support/gnuplot.hpp"
#include "../support/program.hpp"
#include "../support/progress_line.hpp"

#include <duet/core/text/file.hpp>
#include <duet/robotics/plan_screw_motion.hpp>
#include <duet/robotics/time_parametrised.hpp>

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <future>
#include <iostream>
#include <string>
#include <vector>

namespace motion_plan_example {
namespace {

/// Plans, and displays the elapsed time.
plan_type plan(const problem& p) {
  auto result = std::async(std::launch::async, [&] {
    return duet::plan_screw_motion(p.arm, p.start, p.goal, {}, {}, p.scene);
  });
  example::progress_line line("");
  constexpr std::chrono::milliseconds tick(100);
  std::chrono::duration<double> time(0);
  do {
    line.say("planning for " + std::to_string(int(time.count())) + " s");
    time += tick;
  } while (result.wait_for(tick) != std::future_status::ready);
  return result.get();
}

/// The requested velocity limit, or that of the joint if it is lower.
Eigen::VectorXd velocities(const problem& p) {
  Eigen::VectorXd result(p.arm.size());
  for (int i = 0; i < p.arm.size(); ++i) {
    const double joint_limit = p.arm.limits(i).velocity;
    result[i] = joint_limit > 0 ? std::min(p.velocity, joint_limit) : p.velocity;
  }
  return result;
}

std::vector<point> tip_path(const problem& p, const duet::joint_trajectory& trajectory) {
  std::vector<point> result;
  for (int i = 0; i <= 200; ++i) {
    result.emplace_back(
        duet::translation(p.arm.pose(trajectory(trajectory.duration() * i / 200).value)));
  }
  return result;
}

/// Returns true if the goal was reached.
bool run(const problem& p) {
  example::require_folder(p.out);
  const plan_type result = plan(p);
  const Eigen::VectorXd acceleration = Eigen::VectorXd::Constant(p.arm.size(), p.acceleration);
  duet::time_parametrisation_options options{
      .curve = p.jerk ? duet::waypoint_interpolation::natural_cubic
                      : duet::waypoint_interpolation::pchip};
  const auto without_jerk_limit =
      duet::time_optimal_trajectory(result, velocities(p), acceleration, options);
  if (p.jerk) {
    options.jerk.assign(std::size_t(p.arm.size()), *p.jerk);
  }
  const auto trajectory =
      duet::time_optimal_trajectory(result, velocities(p), acceleration, options);
  std::filesystem::create_directories(p.out);
  std::string deviations;
  const worst_case worst = deviations_csv(p, result, deviations);
  duet::save_plan(p.out + "/plan.csv", result);
  duet::save_trajectory(p.out + "/trajectory.csv", trajectory,
                        trajectory.duration() > 0 ? trajectory.duration() / 500 : 1);
  duet::write_file(p.out + "/deviations.csv", deviations);
  const std::vector<point> tip = tip_path(p, trajectory);
  const auto nearest = closest(p, result);
  const example::drawing arm = drawing_of(p, result, tip, nearest);
  duet::write_file(p.out + "/arm_shapes.csv", arm.csv());

  std::printf("%s: %zu waypoints, %d iterations\n", duet::to_text(result.reason),
              result.joints.size(), result.iterations);
  std::printf("deviation from the screw     %.2g m and %.2g rad at most\n",
              worst.deviation.translation, worst.deviation.rotation);
  std::printf("smallest singular value      %.3g\n", result.smallest_singular_value);
  std::printf("smallest joint limit margin  %.3g\n", result.smallest_limit_margin);
  if (p.has_margins()) {
    std::printf("nearest to %s %.4g m\n", obstacles_of(p, "an obstacle      ", "another link     "),
                worst.clearance);
  }
  std::printf("duration                     %.3f s\n", trajectory.duration());
  if (p.jerk) {
    std::printf("without the jerk limit       %.3f s\n", without_jerk_limit.duration());
  }
  const std::size_t rows = 11 * (result.joints.size() - 1); // of deviations.csv
  const bool drawn =
      result.joints.size() > 1 &&
      example::draw(p.out, "joints", 640, joints_script(p, result, velocities(p), 500)) &&
      example::draw(p.out, "deviation", 480, deviation_script(p, rows)) &&
      example::draw(p.out, "arm", 440, arm_script(arm, p, result, tip, nearest, rows));
  if (p.jerk && drawn) {
    constexpr int count = 1001;
    duet::write_file(p.out + "/shares_without.csv",
                     shares_csv(p, velocities(p), without_jerk_limit, count));
    duet::write_file(p.out + "/shares.csv", shares_csv(p, velocities(p), trajectory, count));
    example::draw(p.out, "jerk", 520, jerk_script(trajectory.duration(), count));
  }
  std::cout << "Tables" << (drawn ? " and pictures (SVG, PNG)" : "") << " are in "
            << duet::printable(p.out) << "\n";
  if (!drawn) {
    std::cout << "No pictures: gnuplot is not installed, or nothing moves\n";
  }
  std::printf("motion plan: reason=%s tau=%.4f waypoints=%zu deviation_m=%.2g deviation_rad=%.2g "
              "duration=%.4g\n",
              duet::to_text(result.reason), result.tau.back(), result.joints.size(),
              worst.deviation.translation, worst.deviation.rotation, trajectory.duration());
  if (result.reason != duet::stop_reason::reached) {
    std::fflush(stdout);
    std::cerr << "motion_plan: the goal is not reached: " << duet::to_text(result.reason)
              << " after " << duet::to_text(std::floor(1000 * result.tau.back()) / 10)
              << " % of the path\n";
  }
  return result.reason == duet::stop_reason::reached;
}

} // namespace
} // namespace motion_plan_example

int main(int argc, char** argv) {
  return example::run_program("motion_plan", [&] {
    const auto input = motion_plan_example::parse(argc, argv);
    return !input || motion_plan_example::run(*input) ? 0 : 1;
  });
}
