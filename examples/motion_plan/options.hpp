// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "../support/arms.hpp"
#include "../support/command_line.hpp"
#include "../support/numbers.hpp"

#include <duet/core/random_source.hpp>
#include <duet/duet.hpp>
#include <duet/io/srdf.hpp>
#include <duet/io/urdf.hpp>
#include <duet/robotics/bounding_capsules.hpp>
#include <duet/robotics/pairs_apart.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

/// \file
/// The command line and the problem that it describes.

namespace motion_plan_example {

using pose_type = duet::dual_quaternion<double>;
using point = Eigen::Vector3d;

struct problem {
  example::arm_chain arm;
  Eigen::VectorXd start;
  pose_type goal;
  duet::scene scene;
  double velocity = 1, acceleration = 2;
  std::string out = "motion_plan_out";
  std::optional<double> jerk = {};

  /// True if there are obstacles or collision pairs.
  [[nodiscard]] bool has_margins() const {
    return !scene.obstacles.empty() || !scene.pairs.empty();
  }
};

/// A configuration of a built-in arm well within its limits, with the hand pointing down.
inline std::optional<std::vector<double>> usual_posture(const std::string& robot) {
  const double quarter = std::acos(-1.0) / 4;
  if (robot == "panda") {
    return std::vector<double>{0, -quarter, 0, -3 * quarter, 0, 2 * quarter, quarter};
  }
  if (robot == "iiwa14") {
    return std::vector<double>{0, .6, 0, -1.5, 0, 1, 0};
  }
  if (robot == "ur5e") {
    return std::vector<double>{0, -1.3, 1.9, -2.2, -1.57, 0};
  }
  if (robot == "baxter_left") {
    return std::vector<double>{0, -.6, 0, 1.3, 0, .9, 0};
  }
  return std::nullopt;
}

/// A capsule along each link, from its frame to the next one. If the frame of a link is at its far
/// end, as in the classic Denavit–Hartenberg convention, the capsule is fixed to the next frame.
inline std::vector<duet::collision_body> bodies(const example::arm_chain& arm, double radius) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(arm.size());
  const Eigen::VectorXd moved = Eigen::VectorXd::Constant(arm.size(), .5);
  const auto pose_at = [&](const Eigen::VectorXd& theta, int link) -> pose_type {
    return link <= arm.size() ? arm.pose(theta, link) : arm.pose(theta);
  };
  // Origin of the frame of `link` relative to the frame of `from`.
  const auto origin_in = [&](const Eigen::VectorXd& theta, int from, int link) -> point {
    return duet::transform_point(conj(pose_at(theta, from)),
                                 point(duet::translation(pose_at(theta, link))));
  };
  std::vector<duet::collision_body> result;
  for (int link = 1; link <= arm.size(); ++link) {
    const bool is_fixed_to_next =
        (origin_in(zero, link, link + 1) - origin_in(moved, link, link + 1)).norm() > 1e-9;
    const int on = is_fixed_to_next ? link + 1 : link;
    const point end = origin_in(zero, on, is_fixed_to_next ? link : link + 1);
    result.push_back({on, duet::capsule<>(point(0, 0, 0), end, radius)});
  }
  return result;
}

/// Removes the pairs of bodies that are closer than the margin in each of a hundred random
/// configurations, since no motion can separate them, and prints them.
inline void remove_pairs_that_always_touch(duet::scene& scene, const example::arm_chain& arm) {
  using std::numbers::pi;
  std::vector<duet::collision_pair> touching = scene.pairs;
  duet::random_source random(1);
  for (int k = 0; k < 100; ++k) {
    Eigen::VectorXd theta(arm.size());
    for (int i = 0; i < arm.size(); ++i) {
      const auto& limits = arm.limits(i);
      theta[i] = random.uniform(std::max(limits.lower, -pi), std::min(limits.upper, pi));
    }
    std::erase_if(touching, [&](const duet::collision_pair& each) {
      return closest_points(arm, theta, scene.bodies[each.first], scene.bodies[each.second])
                 .distance >= scene.margin;
    });
  }
  for (const duet::collision_pair& each : touching) {
    std::printf("bodies %zu and %zu always touch: ignored by --self-collision\n", each.first,
                each.second);
    std::erase_if(scene.pairs, [&](const duet::collision_pair& other) {
      return other.first == each.first && other.second == each.second;
    });
  }
}

/// Adds bounding capsules of the collision shapes of the robot description, with mesh files
/// relative to its folder; without such shapes, capsules along the links. With --self-collision
/// also adds the pairs of links that can collide.
inline void add_bodies(duet::scene& scene, const example::arm_chain& arm,
                       const example::command_line& arguments) {
  const double radius = arguments.get<double>("radius").value_or(.05);
  scene.bodies = bodies(arm, radius);
  if (const auto file = arguments.text("urdf")) {
    const auto read = duet::read_urdf(*file, arguments.text("base").value_or(""),
                                      arguments.text("tip").value_or(""));
    const std::filesystem::path folder = std::filesystem::path(*file).parent_path();
    const auto fitted = duet::bounding_capsules(read, folder.string());
    if (!fitted.bodies.empty()) {
      scene.bodies = fitted.bodies;
    }
  }
  const auto srdf = arguments.text("srdf");
  if (arguments.has("self-collision")) {
    scene.pairs = duet::self_collision_pairs(arm, scene.bodies,
                                             srdf ? duet::read_disabled_collisions(*srdf)
                                                  : std::vector<duet::link_pair>{});
    remove_pairs_that_always_touch(scene, arm);
  } else if (srdf) {
    throw std::runtime_error("--srdf requires --self-collision");
  }
}

/// \throws std::runtime_error with the option's name
inline std::vector<double> numbers(const std::string& option, const std::string& text,
                                   std::size_t count) {
  std::vector<double> result = example::parse_numbers(option, text);
  if (result.size() != count) {
    throw std::runtime_error(option + ": " + std::to_string(count) + " numbers expected, got " +
                             std::to_string(result.size()));
  }
  return result;
}

/// `x, y, z, qw, qx, qy, qz`.
inline pose_type pose_of(const std::string& option, const std::string& text) {
  const auto x = numbers(option, text, 7);
  const duet::quaternion<double> q(x[3], x[4], x[5], x[6]);
  if (!(std::abs(norm(q) - 1) <= duet::unit_norm_tolerance)) {
    throw std::runtime_error(option + ": the quaternion has norm " + duet::to_text(norm(q)) +
                             ", not 1");
  }
  return duet::pose(normalized(q), point(x[0], x[1], x[2]));
}

/// The start rotated about the vertical axis through the base, and raised.
inline pose_type usual_goal(const pose_type& start) {
  const auto rotation = duet::from_rotation_vector(point(0, 0, .8));
  return duet::pose(rotation * duet::rotation(start),
                    point(duet::rotate(rotation, duet::translation(start)) + point(0, 0, .1)));
}

inline example::option_list description() {
  example::option_list result(
      "Plans a motion of an arm: the tip follows the screw motion to a goal, the arm avoids "
      "obstacles, and the\ntime scaling respects the limits of the joints. A pose is "
      "x,y,z,qw,qx,qy,qz (scalar first); metres,\nradians, seconds, axes of the base. Options");
  result.flag("help", "print this and stop");
  example::add_arm_options(result);
  result.value<std::string>(
      "start", "X,X,...",
      "start configuration (default: hand down, or the midpoint of the limits)");
  result.value<std::string>("goal", "POSE",
                            "goal pose of the tip (default: to the side of the start)");
  result.value<std::string>("goal-configuration", "X,X,...",
                            "instead of --goal: the pose of the tip in this configuration");
  result.value<std::vector<std::string>>("sphere", "X,Y,Z,R",
                                         "a sphere as obstacle (may be repeated)");
  result.value<std::vector<std::string>>(
      "capsule", "X,Y,Z,X,Y,Z,R",
      "a capsule as obstacle: ends of its axis, radius (may be repeated)");
  result.value<std::vector<std::string>>(
      "box", "X,Y,Z,A,B,C", "a box as obstacle: centre, half extents (may be repeated)");
  result.value<double>("floor", "Z", "height of the floor: everything below is an obstacle");
  result.flag("self-collision", "avoid collisions between links as well");
  result.value<std::string>("srdf", "FILE",
                            "pairs of links that --self-collision ignores (<disable_collisions>)");
  result.value<double>("radius", "R", "radius of links without collision shapes (default: 0.05)");
  result.value<double>("margin", "D", "distance to obstacles and other links (default: 0.02)");
  result.value<double>("max-velocity", "V",
                       "velocity limit of all joints, in addition to their own (default: 1)");
  result.value<double>("max-acceleration", "A", "acceleration limit of all joints (default: 2)");
  result.value<double>("max-jerk", "J",
                       "jerk limit of all joints (default: none); its effect is drawn");
  result.value<std::string>("out", "DIR",
                            "folder for tables and pictures (default: motion_plan_out)");
  return result;
}

/// Returns nothing if only help was requested.
/// \throws std::exception with a one-line message
inline std::optional<problem> parse(int argc, char** argv) {
  const auto arguments = example::command_line::parse(argc, argv, description());
  if (!arguments) {
    return std::nullopt;
  }
  problem result{example::arm_of(*arguments), {}, {}, {}};
  const auto usual = arguments->has("urdf")
                         ? std::nullopt
                         : usual_posture(arguments->text("robot").value_or("panda"));
  result.start = usual && !arguments->has("start")
                     ? Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(
                           usual->data(), Eigen::Index(usual->size())))
                     : example::coordinates(result.arm, *arguments, "start");
  const auto goal = arguments->text("goal"), goal_joints = arguments->text("goal-configuration");
  if (goal && goal_joints) {
    throw std::runtime_error("--goal and --goal-configuration exclude each other");
  }
  result.goal =
      goal ? pose_of("--goal", *goal)
      : goal_joints
          ? result.arm.pose(example::coordinates(result.arm, *arguments, "goal-configuration"))
          : usual_goal(result.arm.pose(result.start));

  const auto each = [&](const char* name, std::size_t count, const auto& add) {
    for (const auto& text :
         arguments->get<std::vector<std::string>>(name).value_or(std::vector<std::string>{})) {
      add(numbers(std::string("--") + name, text, count));
    }
  };
  auto& obstacles = result.scene.obstacles;
  each("sphere", 4, [&](const auto& x) {
    obstacles.push_back(duet::sphere<>{point(x[0], x[1], x[2]), x[3]});
  });
  each("capsule", 7, [&](const auto& x) {
    obstacles.push_back(duet::capsule<>(point(x[0], x[1], x[2]), point(x[3], x[4], x[5]), x[6]));
  });
  each("box", 6, [&](const auto& x) {
    obstacles.push_back(duet::box<>{
        duet::pose(duet::quaternion<double>(1), point(x[0], x[1], x[2])), point(x[3], x[4], x[5])});
  });
  if (const auto z = arguments->get<double>("floor")) {
    obstacles.push_back(duet::half_space<>{point(0, 0, 1), *z});
  }
  result.scene.margin = arguments->get<double>("margin").value_or(.02);
  add_bodies(result.scene, result.arm, *arguments);
  result.velocity = arguments->get<double>("max-velocity").value_or(result.velocity);
  result.acceleration = arguments->get<double>("max-acceleration").value_or(result.acceleration);
  result.jerk = arguments->get<double>("max-jerk");
  result.out = arguments->text("out").value_or(result.out);
  return result;
}

} // namespace motion_plan_example
