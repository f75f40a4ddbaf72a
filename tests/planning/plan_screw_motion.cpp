// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "mechanism/arms.hpp"

#include <duet/planning/plan_screw_motion.hpp>
#include <duet/planning/printed_plan.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

namespace test_planning_plan_screw_motion {
namespace {

using namespace duet;
using vector = duet_test::coordinates<7>;

const auto arm = robots::panda().table();

vector gripper_down() {
  const double quarter = std::numbers::pi / 4;
  vector theta;
  theta << 0, -quarter, 0, -3 * quarter, 0, 2 * quarter, quarter;
  return theta;
}

/// A configuration near another one, within the limits.
vector near(const vector& theta, duet_test::random_source& random) {
  vector result;
  for (int i = 0; i < 7; ++i) {
    result[i] =
        std::clamp(theta[i] + random.uniform(-.5, .5), arm.limits(i).lower, arm.limits(i).upper);
  }
  return result;
}

/// The largest distance, in metres and radians, of the straight joint paths between waypoints from
/// the screw motion at the same τ; infinite outside the limits.
template <class Plan>
double worst(const Plan& plan, const dual_quaternion<double>& goal) {
  double result = 0;
  for (std::size_t k = 1; k < plan.joints.size(); ++k) {
    for (int part = 1; part <= 10; ++part) {
      const double x = part / 10.0;
      const vector theta = (1 - x) * plan.joints[k - 1] + x * plan.joints[k];
      for (int i = 0; i < 7; ++i) {
        if (theta[i] < arm.limits(i).lower - 1e-15 || theta[i] > arm.limits(i).upper + 1e-15) {
          return INFINITY;
        }
      }
      const double tau = (1 - x) * plan.tau[k - 1] + x * plan.tau[k];
      const pose_deviation d = deviation_between(arm.pose(theta), sclerp(plan.poses[0], goal, tau));
      result = std::max({result, d.length, d.angle});
    }
  }
  return result;
}

} // namespace

TEST_CASE("from the gripper-down pose to near goals, along the screw") {
  duet_test::random_source random(1);
  int reached = 0;
  for (int k = 0; k < 50; ++k) {
    const auto goal = arm.pose(near(gripper_down(), random));
    // The sign of the goal does not matter.
    const auto plan = plan_screw_motion(arm, gripper_down(), k % 2 == 0 ? goal : -goal);
    reached += plan.reason == stop_reason::reached;
    CHECK(worst(plan, goal) < 1.1e-5);
    if (plan.reason == stop_reason::reached) {
      const pose_deviation left = deviation_between(plan.poses.back(), goal);
      CHECK(std::max(left.length, left.angle) <= 1e-6);
      CHECK(plan.tau.back() == 1);
      CHECK(plan.smallest_singular_value > 1e-3);
    }
  }
  CHECK(reached == 50);
}

TEST_CASE("unrelated goals: every path is along the screw and within limits, whatever its end") {
  duet_test::random_source random(2);
  int reached = 0;
  for (int k = 0; k < 12; ++k) {
    vector start, end;
    for (int i = 0; i < 7; ++i) {
      const double middle = (arm.limits(i).lower + arm.limits(i).upper) / 2;
      const double half = .8 * (arm.limits(i).upper - middle);
      start[i] = middle + half * random.uniform(-1, 1);
      end[i] = middle + half * random.uniform(-1, 1);
    }
    const auto goal = arm.pose(end);
    const auto plan = plan_screw_motion(arm, start, goal);
    reached += plan.reason == stop_reason::reached;
    CHECK((plan.reason == stop_reason::reached) == (plan.tau.back() == 1));
    CHECK(plan.reason != stop_reason::iteration_limit);
    CHECK(worst(plan, goal) < 1.1e-5);
  }
  CHECK(reached > 2);
}

TEST_CASE("N24: the notes' planner reaches near goals too, but drifts from the screw") {
  duet_test::random_source random(1);
  double drift = 0;
  for (int k = 0; k < 3; ++k) {
    const auto goal = arm.pose(near(gripper_down(), random));
    const auto plan = printed_screw_plan(arm, gripper_down(), goal);
    CHECK(plan.reason == stop_reason::reached);
    const pose_deviation left = deviation_between(plan.poses.back(), goal);
    CHECK(std::max(left.length, left.angle) <= 1e-4);
    // Each step goes one hundredth of what is left.
    CHECK(plan.iterations > 300);
    for (const pose_deviation& d : plan.deviations) {
      drift = std::max({drift, d.length, d.angle});
    }
  }
  CHECK(drift > 1e-5);
}

TEST_CASE("why it stops") {
  // A goal out of reach: as far as the arm goes.
  const auto far = pose(rotation(arm.pose(gripper_down())), Eigen::Vector3d(2, 0, .3));
  const auto plan = plan_screw_motion(arm, gripper_down(), far);
  CHECK(plan.reason != stop_reason::reached);
  CHECK(plan.tau.back() < 1);
  CHECK(plan.tau.back() > .1);
  CHECK(worst(plan, far) < 1.1e-5);
  CHECK(plan_screw_motion(arm, gripper_down(), far, {.iterations = 5}).reason ==
        stop_reason::iteration_limit);
  // A joint's limit, and no other joint to go the same way.
  std::array<joint<>, 6> joints;
  for (std::size_t i = 0; i < 6; ++i) {
    joints[i].kind = i < 3 ? joint_kind::prismatic : joint_kind::revolute;
    joints[i].axis = {double(i % 3 == 0), double(i % 3 == 1), double(i % 3 == 2)};
  }
  joints[0].limits = {-1, .5};
  const serial_chain<6> gantry(joints);
  const Eigen::Matrix<double, 6, 1> zero = Eigen::Matrix<double, 6, 1>::Zero();
  const auto stopped =
      plan_screw_motion(gantry, zero, pose(quaternion<double>(1), Eigen::Vector3d(1, 0, 0)));
  CHECK(stopped.reason == stop_reason::joint_limit);
  CHECK(stopped.joints.back()[0] == doctest::Approx(.5).epsilon(1e-4));
  CHECK(std::string(to_text(stopped.reason)) == "joint_limit");
  // Nothing to do.
  const auto nothing = plan_screw_motion(gantry, zero, gantry.pose(zero));
  CHECK(nothing.reason == stop_reason::reached);
}

TEST_CASE("bad problems") {
  const vector start = gripper_down();
  const auto goal = arm.pose(start);
  vector outside = start;
  outside[3] = 1;
  CHECK_THROWS_WITH_AS(
      (void)plan_screw_motion(arm, outside, goal),
      "duet: plan: the start has 1 for joint 3, whose limits are -3.0718 and -0.0698",
      invalid_input);
  outside[3] = std::nan("");
  CHECK_THROWS_AS((void)plan_screw_motion(arm, outside, goal), invalid_input);
  CHECK_THROWS_AS((void)plan_screw_motion(arm, start, goal * 2.0), invalid_input);
  CHECK_THROWS_AS((void)printed_screw_plan(arm, start, goal * std::nan("")), invalid_input);
}

} // namespace test_planning_plan_screw_motion
