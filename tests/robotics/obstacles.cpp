// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "robotics/paths.hpp"

#include <duet/robotics/plan_screw_motion.hpp>

#include <Eigen/Core>

namespace test_robotics_obstacles {
namespace {

using namespace duet;
using vector = duet_test::coordinates<7>;
using duet_test::gripper_down;
using point = Eigen::Vector3d;

const auto arm = robots::panda().table();

/// The Panda's upper arm, elbow, forearm and flange.
scene arm_among(std::vector<obstacle> obstacles) {
  return {{{2, capsule<>({0, 0, 0}, {0, -.316, 0}, .06)},
           {3, sphere<>{{.0825, 0, 0}, .06}},
           {4, capsule<>({0, 0, 0}, {-.0825, .384, 0}, .06)},
           {7, capsule<>({0, 0, -.05}, {0, 0, .05}, .05)}},
          std::move(obstacles),
          .01};
}

TEST_CASE("plan_screw_motion: the elbow avoids an obstacle while the tip stays on the screw") {
  for (const int seed : {354, 373, 903}) {
    duet_test::random_source random{std::uint64_t(seed)};
    vector end;
    for (int i = 0; i < 7; ++i) {
      end[i] = gripper_down()[i] + random.uniform(-.6, .6);
    }
    const auto goal = arm.pose(end);
    // Near where the elbow would be.
    const auto plain = plan_screw_motion(arm, gripper_down(), goal);
    const vector late = plain.joints[plain.joints.size() * 2 / 3];
    const auto aside = random.direction<3>();
    const point centre = translation(arm.pose(late, 4)) + .15 * point(aside[0], aside[1], aside[2]);
    const auto rotated = pose(from_rotation_vector(point(.5, 1, 0)), centre);
    const scene around =
        arm_among({seed % 2 == 0 ? obstacle(sphere<>{centre, .1})
                                 : obstacle(box<>{rotated, point(.09, .07, .08)})});
    REQUIRE(clearance(arm, gripper_down(), around).distance > .01);
    REQUIRE(clearance(arm, late, around).distance < -.01);
    const auto plan = plan_screw_motion(arm, gripper_down(), goal, {}, {}, around);
    CHECK(plan.reason == stop_reason::reached);
    CHECK(plan.smallest_clearance < .0101); // it does touch the margin
    duet_test::check_clear_screw(arm, plan, goal, around);
  }
}

TEST_CASE("plan_screw_motion: an obstacle on the path of the tip ends the plan at the margin") {
  const auto start = gripper_down();
  const point from = translation(arm.pose(start));
  const auto goal = pose(rotation(arm.pose(start)), point(from + point(.1, 0, -.2)));
  // The flange's capsule ends 0.007 above the tip, which goes down by 0.2; the plate begins 0.1
  // below.
  const auto plate = pose(quaternion<double>(1), point(from + point(.1, 0, -.12)));
  const scene around = arm_among({box<>{plate, {.15, .2, .02}}});
  const auto plan = plan_screw_motion(arm, start, goal, {.search_step = 0}, {}, around);
  CHECK(plan.reason == stop_reason::obstacle);
  CHECK(std::string(to_text(plan.reason)) == "obstacle");
  CHECK(plan.tau.back() == doctest::Approx((.1 + .007 - .01) / .2).epsilon(1e-3));
  CHECK(plan.smallest_clearance == doctest::Approx(.01).epsilon(1e-3));
  duet_test::check_clear_screw(arm, plan, goal, around);
}

TEST_CASE("plan_screw_motion: distant obstacles do not change the plan") {
  const auto start = gripper_down();
  vector end = start;
  end[1] += .3;
  end[5] -= .4;
  const auto goal = arm.pose(end);
  const scene around = arm_among({sphere<>{{5, 5, 5}, 1}, half_space<>{{0, 0, 1}, -3}});
  const auto plan = plan_screw_motion(arm, start, goal, {}, {}, around);
  const auto plain = plan_screw_motion(arm, start, goal);
  CHECK(plan.reason == stop_reason::reached);
  CHECK(plan.joints == plain.joints);
  CHECK(plan.smallest_clearance > 2);
  CHECK(plain.smallest_clearance == INFINITY);
}

TEST_CASE("plan_screw_motion: limits are not reported as obstacles; invalid scenes are rejected") {
  const auto start = gripper_down();
  // A goal beyond the reach of the elbow, near a wall that does not block the path.
  const auto far = pose(rotation(arm.pose(start)), point(.87, 0, .3));
  const scene wall = arm_among({half_space<>{{0, 0, 1}, .2}});
  const auto stopped = plan_screw_motion(arm, start, far, {.search_step = 0}, {}, wall);
  CHECK(stopped.reason != stop_reason::reached);
  CHECK(stopped.reason != stop_reason::obstacle);
  CHECK(stopped.reason != stop_reason::out_of_reach);
  CHECK(stopped.tau.back() > .5);
  // If the goal is certainly out of reach, no step is tried.
  const auto farther = pose(rotation(arm.pose(start)), point(2, 0, .3));
  const auto stayed = plan_screw_motion(arm, start, farther, {}, {}, wall);
  CHECK(stayed.reason == stop_reason::out_of_reach);
  CHECK(stayed.joints.size() == 1);
  CHECK(stayed.smallest_clearance == clearance(arm, start, wall).distance);

  DUET_CHECK_REFUSED(
      doctest::Contains("from obstacle 0, closer than the margin of 0.01"),
      plan_screw_motion(arm, start, far, {}, {}, arm_among({half_space<>{{0, 0, 1}, .6}})));
  scene bad = wall;
  bad.margin = -1;
  DUET_CHECK_REFUSED("duet: the margin of a scene is -1 (expected a non-negative number)",
                     plan_screw_motion(arm, start, far, {}, {}, bad));
  bad = arm_among({half_space<>{{0, 0, 2}, 0}});
  DUET_CHECK_REFUSED("duet: the normal of obstacle 0 is not a unit vector",
                     plan_screw_motion(arm, start, far, {}, {}, bad));
}

} // namespace
} // namespace test_robotics_obstacles
