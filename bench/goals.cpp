// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Partial goals and the solution one wants of them, for goals made from random joint coordinates:
/// how many are found, and the processor's time for one. Arguments: the number of goals of each
/// kind (1000), the seed (1).

#include <duet/core/random_source.hpp>
#include <duet/kinematics/adapted.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/robotics/all_inverse_kinematics.hpp>
#include <duet/robotics/choose_start.hpp>
#include <duet/robotics/goals.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <numbers>
#include <vector>

namespace {

using namespace duet;
/// Chains of any number of joints, so that all is compiled once.
using arm_chain = bounded_chain<16>;
using joints = detail::joint_vector<double, -16>;
using result = inverse_kinematics_result;

struct robot {
  const char* name;
  arm_chain arm;
};

/// Ten joints with axes in all directions.
arm_chain ten_joints() {
  std::array<joint<>, 10> all;
  for (std::size_t i = 0; i < 10; ++i) {
    all[i].origin.translation = {.1, .05, .08};
    all[i].axis = {double(i % 3 == 0), double(i % 3 == 1), double(i % 3 == 2)};
    all[i].limits = {-1.5, 1.5};
  }
  return serial_chain<10>(all, {quaternion<double>(1), {.1, 0, 0}});
}

std::vector<robot> robots_of_table() {
  return {{"Panda", robots::panda().table()},
          {"iiwa 14", robots::iiwa14().table()},
          {"UR5e", robots::ur5e().table()},
          {"Baxter, left arm", robots::baxter_left().table()},
          {"ten joints", ten_joints()}};
}

joints anywhere(const arm_chain& arm, random_source& random) {
  joints theta(arm.size());
  for (int i = 0; i < arm.size(); ++i) {
    theta[i] = random.uniform(arm.limits(i).lower, arm.limits(i).upper);
  }
  return theta;
}
joints nearby(const arm_chain& arm, joints theta, double max_change, random_source& random) {
  for (int i = 0; i < arm.size(); ++i) {
    theta[i] = std::clamp(theta[i] + random.uniform(-max_change, max_change), arm.limits(i).lower,
                          arm.limits(i).upper);
  }
  return theta;
}
bool is_within_limits(const arm_chain& arm, const joints& theta) {
  return (theta - lower_limits(arm)).minCoeff() >= 0 && (upper_limits(arm) - theta).minCoeff() >= 0;
}
constexpr double quarter = std::numbers::pi / 2;
/// The nearest multiples of an angle within the limits.
joints rounded(const arm_chain& arm, joints theta, double angle) {
  for (int i = 0; i < arm.size(); ++i) {
    theta[i] =
        std::clamp(angle * std::round(theta[i] / angle), arm.limits(i).lower, arm.limits(i).upper);
  }
  return theta;
}
/// True if the solution for the pose of a configuration is no farther from the posture than that
/// configuration and, for six joints, than any solution with any full turns within limits.
bool is_nearest(const arm_chain& arm, const joints& known,
                const preferred_posture<joints>& preference) {
  const auto goal = arm.pose(known);
  double min_value = preference(known);
  if (arm.size() == 6) {
    for (const auto& each : all_inverse_kinematics(arm, goal).solutions) {
      joints nearest = joints::Constant(6, 1e6);
      for (int i = 0; i < 6; ++i) {
        for (int full_turns = -2; full_turns <= 2; ++full_turns) {
          const double x = each.joints[i] + 4 * full_turns * quarter;
          const bool is_within = x >= arm.limits(i).lower && x <= arm.limits(i).upper;
          if (is_within &&
              std::abs(x - preference.posture[i]) < std::abs(nearest[i] - preference.posture[i])) {
            nearest[i] = x;
          }
        }
      }
      min_value = std::min(min_value, preference(nearest));
    }
  }
  const result found = inverse_kinematics(arm, goal, preference.posture, {}, preference);
  return found.reason == stop_reason::reached && is_within_limits(arm, found.joints) &&
         preference(found.joints) <= min_value * (1 + 1e-6) + 1e-5;
}
vector3<double> direction(random_source& random) {
  const auto n = random.direction<3>();
  return {n[0], n[1], n[2]};
}

/// One case: a configuration, and whether its result is as required.
using attempt = std::function<bool(const arm_chain&, const joints&, random_source&)>;

void row(const char* what, int count, std::uint64_t seed, const attempt& is_solved) {
  std::printf("| %s |", what);
  for (const robot& each : robots_of_table()) {
    random_source random(seed);
    int solved = 0;
    const std::clock_t before = std::clock();
    for (int k = 0; k < count; ++k) {
      solved += is_solved(each.arm, anywhere(each.arm, random), random);
    }
    const double time = double(std::clock() - before) / CLOCKS_PER_SEC / count * 1e6;
    if (solved == count) {
      std::printf(" all, ");
    } else {
      std::printf(" %.2f %%, ", 100. * solved / count);
    }
    std::printf(time < 9999.5 ? "%.3g µs |" : "%.0f ms |", time < 9999.5 ? time : time / 1e3);
    std::fflush(stdout);
  }
  std::printf("\n");
}

/// A goal made of the tip's pose, from a start anywhere.
template <class Make>
void goal_row(const char* what, int count, std::uint64_t seed, const Make& make) {
  row(what, count, seed, [&](const arm_chain& arm, const joints& known, random_source& random) {
    const auto goal = make(arm.pose(known), random);
    const result found = inverse_kinematics(arm, goal, anywhere(arm, random));
    return found.reason == stop_reason::reached && is_within_limits(arm, found.joints);
  });
}

void goals_in_part(int count, std::uint64_t seed) {
  goal_row("position", count, seed,
           [](const auto& tip, random_source&) { return position_goal(translation(tip)); });
  goal_row("pointing", count, seed, [](const auto& tip, random_source& random) {
    const vector3<double> n = direction(random);
    return pointing_goal(n, rotate(rotation(tip), n));
  });
  goal_row("position and pointing", count, seed, [](const auto& tip, random_source& random) {
    const vector3<double> n = direction(random);
    return position_and_pointing_goal(translation(tip), n, rotate(rotation(tip), n));
  });
  goal_row("position, pointing within 0.2 rad", count, seed,
           [](const auto& tip, random_source& random) {
             const vector3<double> n = direction(random);
             return position_and_pointing_goal(translation(tip), n, rotate(rotation(tip), n), .2);
           });
  goal_row("box of 2 cm, cone of 0.1 rad, turns ± 0.2", count, seed,
           [](const auto& tip, random_source& random) {
             const vector3<double> shift = .01 * direction(random), tilt = .04 * direction(random);
             const vector3<double> n = direction(random);
             return task_space_region{.frame = tip * pose(exp(tilt), shift),
                                      .lower = {-.01, -.01, -.01},
                                      .upper = {.01, .01, .01},
                                      .axis = {n[0], n[1], n[2]},
                                      .max_tilt = .1,
                                      .rotation_lower = -.2,
                                      .rotation_upper = .2};
           });
  goal_row("the whole pose", count, seed, [](const auto& tip, random_source&) { return tip; });
}

void preferences(int count, std::uint64_t seed) {
  row("pose, each joint within 0.3 of the start", count, seed,
      [](const arm_chain& arm, const joints& known, random_source& random) {
        const joints start = nearby(arm, known, .3, random);
        const auto bounded =
            with_limits_about(arm, start, joints(joints::Constant(arm.size(), .3)));
        const result found = inverse_kinematics(bounded, arm.pose(known), start);
        return found.reason == stop_reason::reached &&
               (found.joints - start).cwiseAbs().maxCoeff() <= .3 + 1e-12;
      });
  const auto preferred = [](const auto& goal_of) {
    return [=](const arm_chain& arm, const joints& known, random_source& random) {
      const preferred_posture preference{nearby(arm, known, .3, random)};
      const result found =
          inverse_kinematics(arm, goal_of(arm.pose(known)), preference.posture, {}, preference);
      return found.reason == stop_reason::reached && is_within_limits(arm, found.joints) &&
             preference(found.joints) <= preference(known) * (1 + 1e-6);
    };
  };
  row("position, nearest to a posture", count / 10, seed,
      preferred([](const auto& tip) { return position_goal(translation(tip)); }));
  row("pose, nearest to a posture", count / 10, seed,
      preferred([](const auto& tip) { return tip; }));
  row("pose, nearest to a posture anywhere", count / 10, seed,
      [](const arm_chain& arm, const joints& known, random_source& random) {
        const preferred_posture preference{anywhere(arm, random)};
        return is_nearest(arm, known, preference);
      });
  row("pose of multiples of 15°, nearest to quarter turns", count / 10, seed,
      [](const arm_chain& arm, const joints& known, random_source& random) {
        const preferred_posture preference{rounded(arm, anywhere(arm, random), quarter)};
        return is_nearest(arm, rounded(arm, known, quarter / 6), preference);
      });
  row("pose, clear of obstacles", count, seed,
      [](const arm_chain& arm, const joints& known, random_source& random) {
        const auto goal = arm.pose(known);
        const joints start = anywhere(arm, random);
        const joints other = inverse_kinematics(arm, goal, start).joints;
        scene around;
        around.margin = .02;
        for (int i = 3; i <= arm.size(); ++i) {
          around.bodies.push_back({i, {vector3<double>(0, 0, 0), vector3<double>(0, 0, .05), .04}});
        }
        for (int i = 3; i < arm.size() + 6; ++i) {
          const vector3<double> at = i < arm.size()
                                         ? vector3<double>(translation(arm.pose(other, i)))
                                         : vector3<double>(.8 * direction(random));
          around.obstacles.push_back(sphere<double>{at, random.uniform(.05, .15)});
          if (clearance(arm, known, around).distance < around.margin) {
            around.obstacles.pop_back();
          }
        }
        const result found = inverse_kinematics(arm, goal, start, {}, no_objective{}, around);
        return found.reason == stop_reason::reached && is_within_limits(arm, found.joints) &&
               clearance(arm, found.joints, around).distance >= around.margin - 1e-6;
      });
}

void starts(int count, std::uint64_t seed) {
  // Path of the tip while the joints move halfway to another configuration.
  const auto solve = [](bool is_any, bool is_structured = false) {
    return [=](const arm_chain& arm, const joints& unrounded, random_source& random) {
      const joints other = anywhere(arm, random);
      const joints known = is_structured ? rounded(arm, unrounded, quarter / 6) : unrounded;
      const joints displacement =
          .5 * ((is_structured ? rounded(arm, other, quarter / 6) : other) - known);
      const auto path = [&](double u) { return arm.pose(joints(known + u * displacement)); };
      if (is_any) {
        const result start =
            inverse_kinematics(arm, path(0), anywhere(arm, random), {.tolerance = 1e-9});
        return start.reason == stop_reason::reached &&
               follow_path(arm, start.joints, path, 0, 1).reason == stop_reason::reached;
      }
      return find_start_configuration(arm, path, 0, 1).reason == stop_reason::reached;
    };
  };
  row("path, from any solution", count, seed, solve(true));
  row("path, from the start that is chosen", count, seed, solve(false));
  row("path from multiples of 15°, from the start that is chosen", count, seed, solve(false, true));
}

} // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 1000;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  std::printf("|");
  for (const robot& each : robots_of_table()) {
    std::printf(" | %s", each.name);
  }
  std::printf(" |\n|---|---|---|---|---|---|\n");
  goals_in_part(count, seed);
  preferences(count, seed);
  starts(std::max(1, count / 100), seed);
}
