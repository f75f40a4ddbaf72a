// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "../support/arms.hpp"
#include "../support/command_line.hpp"
#include "../support/numbers.hpp"

#include <duet/core/random_source.hpp>
#include <duet/duet.hpp>
#include <duet/mechanism/srdf.hpp>
#include <duet/mechanism/urdf.hpp>
#include <duet/planning/capsules_of.hpp>
#include <duet/planning/pairs_apart.hpp>

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
/// The command line, and the problem that it describes.

namespace motion_plan_example {

using pose_type = duet::dual_quaternion<double>;
using point = Eigen::Vector3d;

struct problem {
  example::arm_chain arm;
  Eigen::VectorXd start;
  pose_type goal;
  duet::scene around;
  double velocity = 1, acceleration = 2;
  std::string out = "motion_plan_out";
  std::optional<double> jerk = {};

  /// Is there anything that the arm could touch?
  [[nodiscard]] bool has_margins() const {
    return !around.obstacles.empty() || !around.pairs.empty();
  }
};

/// Somewhere in the middle of what a known arm can do, its hand pointing down.
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

/// A capsule along each link, from its frame to that of the next one; along the next one where its
/// frame is at its far end, as in the first of Denavit and Hartenberg's conventions.
inline std::vector<duet::collision_body> bodies(const example::arm_chain& arm, double radius) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(arm.size());
  const Eigen::VectorXd moved = Eigen::VectorXd::Constant(arm.size(), .5);
  const auto pose_at = [&](const Eigen::VectorXd& theta, int link) -> pose_type {
    return link <= arm.size() ? arm.pose(theta, link) : arm.pose(theta);
  };
  // Where one link's frame is, seen from another's.
  const auto seen = [&](const Eigen::VectorXd& theta, int from, int link) -> point {
    return duet::transform_point(conj(pose_at(theta, from)),
                                 point(duet::translation(pose_at(theta, link))));
  };
  std::vector<duet::collision_body> result;
  for (int link = 1; link <= arm.size(); ++link) {
    const bool turns_next =
        (seen(zero, link, link + 1) - seen(moved, link, link + 1)).norm() > 1e-9;
    const int on = turns_next ? link + 1 : link;
    const point end = seen(zero, on, turns_next ? link : link + 1);
    result.push_back({on, duet::capsule<>(point(0, 0, 0), end, radius)});
  }
  return result;
}

/// Pairs of bodies that are too close whatever the joints do cannot be kept apart: those that are
/// in a hundred random configurations are left out, and told.
inline void leave_out_what_always_touches(duet::scene& around, const example::arm_chain& arm) {
  using std::numbers::pi;
  std::vector<duet::collision_pair> touching = around.pairs;
  duet::random_source random(1);
  for (int k = 0; k < 100; ++k) {
    Eigen::VectorXd theta(arm.size());
    for (int i = 0; i < arm.size(); ++i) {
      const auto& limits = arm.limits(i);
      theta[i] = random.uniform(std::max(limits.lower, -pi), std::min(limits.upper, pi));
    }
    std::erase_if(touching, [&](const duet::collision_pair& each) {
      return closest_points(arm, theta, around.bodies[each.first], around.bodies[each.second])
                 .distance >= around.margin;
    });
  }
  for (const duet::collision_pair& each : touching) {
    std::printf("bodies %zu and %zu always touch: left out of --self\n", each.first, each.second);
    std::erase_if(around.pairs, [&](const duet::collision_pair& other) {
      return other.first == each.first && other.second == each.second;
    });
  }
}

/// Capsules around the shapes that a robot description has for collisions, if it has some, with
/// files of meshes beside it; else along its links. With --self those that can run into each other.
inline void add_bodies(duet::scene& around, const example::arm_chain& arm,
                       const example::command_line& given) {
  const double radius = given.get<double>("radius").value_or(.05);
  around.bodies = bodies(arm, radius);
  if (const auto file = given.text("urdf")) {
    const auto read =
        duet::read_urdf(*file, given.text("base").value_or(""), given.text("tip").value_or(""));
    const std::filesystem::path folder = std::filesystem::path(*file).parent_path();
    const auto fitted = duet::bounding_capsules(read, folder.string());
    if (!fitted.bodies.empty()) {
      around.bodies = fitted.bodies;
    }
  }
  const auto srdf = given.text("srdf");
  if (given.has("self")) {
    around.pairs = duet::self_collision_pairs(arm, around.bodies,
                                              srdf ? duet::read_disabled_collisions(*srdf)
                                                   : std::vector<duet::link_pair>{});
    leave_out_what_always_touches(around, arm);
  } else if (srdf) {
    throw std::runtime_error("--srdf is for --self");
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

/// Half a metre to the side and turned about the vertical: round the obstacle, if there is one.
inline pose_type usual_goal(const pose_type& start) {
  const auto turn = duet::from_rotation_vector(point(0, 0, .8));
  return duet::pose(turn * duet::rotation(start),
                    point(duet::rotate(turn, duet::translation(start)) + point(0, 0, .1)));
}

inline example::option_list description() {
  example::option_list result(
      "Moves the tip of an arm along the screw motion to a goal, around obstacles, and says when "
      "it is where.\nA pose is x,y,z,qw,qx,qy,qz (scalar first); metres, radians, seconds, axes of "
      "the base. Options");
  result.flag("help", "print this and stop");
  example::add_arm_options(result);
  result.value<std::string>("start", "X,X,...",
                            "joint coordinates (default: hand down, or the middle of limits)");
  result.value<std::string>("goal", "POSE", "of the tip (default: to the side)");
  result.value<std::string>("goal-joints", "X,X,...",
                            "the tip's pose at these coordinates instead");
  result.value<std::vector<std::string>>("sphere", "X,Y,Z,R",
                                         "an obstacle; this and the next may be repeated");
  result.value<std::vector<std::string>>("capsule", "X,Y,Z,X,Y,Z,R",
                                         "an obstacle by the ends of its axis and its radius");
  result.value<std::vector<std::string>>("box", "X,Y,Z,A,B,C",
                                         "an obstacle by its centre and half sizes");
  result.value<double>("floor", "Z", "everything below is an obstacle");
  result.flag("self", "keep links apart from each other, too");
  result.value<std::string>("srdf", "FILE",
                            "which pairs of links --self leaves out: <disable_collisions>");
  result.value<double>("radius", "R", "of links without shapes for collisions (default: 0.05)");
  result.value<double>("margin", "D", "to what is not touched (default: 0.02)");
  result.value<double>("velocity", "V", "limit of all joints, besides their own (default: 1)");
  result.value<double>("acceleration", "A", "limit of all joints (default: 2)");
  result.value<double>("jerk", "J",
                       "limit of all joints (default: none); makes a picture of what that changes");
  result.value<std::string>("out", "DIR",
                            "folder for tables and pictures (default: motion_plan_out)");
  return result;
}

/// Nothing where only help was asked for.
/// \throws std::exception with a one-line message
inline std::optional<problem> parse(int argc, char** argv) {
  const auto given = example::command_line::parse(argc, argv, description());
  if (!given) {
    return std::nullopt;
  }
  problem result{example::arm_of(*given), {}, {}, {}};
  const auto usual =
      given->has("urdf") ? std::nullopt : usual_posture(given->text("robot").value_or("panda"));
  result.start = usual && !given->has("start") ? Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(
                                                     usual->data(), Eigen::Index(usual->size())))
                                               : example::coordinates(result.arm, *given, "start");
  const auto goal = given->text("goal"), goal_joints = given->text("goal-joints");
  if (goal && goal_joints) {
    throw std::runtime_error("--goal and --goal-joints exclude each other");
  }
  result.goal = goal ? pose_of("--goal", *goal)
                : goal_joints
                    ? result.arm.pose(example::coordinates(result.arm, *given, "goal-joints"))
                    : usual_goal(result.arm.pose(result.start));

  const auto each = [&](const char* name, std::size_t count, const auto& add) {
    for (const auto& text :
         given->get<std::vector<std::string>>(name).value_or(std::vector<std::string>{})) {
      add(numbers(std::string("--") + name, text, count));
    }
  };
  auto& obstacles = result.around.obstacles;
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
  if (const auto z = given->get<double>("floor")) {
    obstacles.push_back(duet::half_space<>{point(0, 0, 1), *z});
  }
  result.around.margin = given->get<double>("margin").value_or(.02);
  add_bodies(result.around, result.arm, *given);
  result.velocity = given->get<double>("velocity").value_or(result.velocity);
  result.acceleration = given->get<double>("acceleration").value_or(result.acceleration);
  result.jerk = given->get<double>("jerk");
  result.out = given->text("out").value_or(result.out);
  return result;
}

} // namespace motion_plan_example
