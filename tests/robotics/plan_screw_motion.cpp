// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "../../src/robotics/path_step.hpp"
#include "robotics/paths.hpp"

#include <duet/motion/printed_plan.hpp>
#include <duet/robotics/plan_screw_motion.hpp>

#include <Eigen/Cholesky>

namespace test_robotics_plan_screw_motion {
namespace {

using namespace duet;
using duet_test::gripper_down;
using vector = duet_test::coordinates<7>;

const auto arm = robots::panda().table();

double worst(const motion_plan& plan, const dual_quaternion<double>& goal) {
  return duet_test::deviation_from_screw(arm, plan, goal);
}

struct problem {
  vector start, end;
};

/// Problem `number` of those that bench/planning.cpp counts: in the inner 80 % of the joints'
/// ranges, `near` within 0.5 rad per joint and cut off there.
problem random_problem(unsigned seed, int number, bool is_near) {
  duet_test::random_source random(seed);
  problem result;
  for (int k = 0; k <= number; ++k) {
    for (int i = 0; i < 7; ++i) {
      const double centre = (arm.limits(i).lower + arm.limits(i).upper) / 2;
      const double half = .8 * (arm.limits(i).upper - centre);
      double& from = result.start[i];
      from = centre + half * random.uniform(-1, 1);
      result.end[i] = is_near
                          ? std::clamp(from + random.uniform(-.5, .5), centre - half, centre + half)
                          : centre + half * random.uniform(-1, 1);
    }
  }
  return result;
}

/// Smallest singular value by inverse iteration.
double smallest_singular_value(const vector& theta) {
  const auto m = jacobian(arm, theta, frame::hybrid);
  const Eigen::LLT<matrix6<double>> gram(matrix6<double>(m * m.transpose()));
  vector6<double> x = vector6<double>::Ones();
  double length = 0;
  for (int i = 0; i < 60; ++i) {
    x = gram.solve(x);
    length = x.norm();
    x /= length;
  }
  return 1 / std::sqrt(length);
}

constexpr plan_options without_search = {.search_step = 0};

TEST_CASE("plan_screw_motion: reaches near goals along the screw") {
  duet_test::random_source random(1);
  for (int k = 0; k < 8; ++k) {
    vector end = gripper_down();
    for (int i = 0; i < 7; ++i) {
      end[i] =
          std::clamp(end[i] + random.uniform(-.5, .5), arm.limits(i).lower, arm.limits(i).upper);
    }
    const auto goal = arm.pose(end);
    // The sign of the goal does not matter.
    const auto plan = plan_screw_motion(arm, gripper_down(), k % 2 == 0 ? goal : -goal);
    REQUIRE(plan.reason == stop_reason::reached);
    CHECK(worst(plan, goal) < 1e-5);
    CHECK(plan.joints.front() == gripper_down());
    const pose_error deviation = pose_error_between(plan.poses.back(), goal);
    CHECK(std::max(deviation.translation, deviation.rotation) <= 1e-6);
    CHECK(plan.tau.back() == 1);
    CHECK(plan.iterations <
          2.3 * double(plan.joints.size())); // a step to first order, and Newton's
    double margin = 10, smallest = 10;
    for (const Eigen::VectorXd& theta : plan.joints) {
      for (int i = 0; i < 7; ++i) {
        margin = std::min({margin, theta[i] - arm.limits(i).lower, arm.limits(i).upper - theta[i]});
      }
      if (k == 0) {
        smallest = std::min(smallest, smallest_singular_value(theta));
      }
    }
    CHECK(plan.smallest_limit_margin == margin);
    if (k == 0) {
      CHECK(plan.smallest_singular_value == doctest::Approx(smallest).epsilon(.05));
    }
  }
}

TEST_CASE("plan_screw_motion: joint centring increases the distance from limits") {
  const vector lower = lower_limits(arm), upper = upper_limits(arm);
  const vector centre = (lower + upper) / 2;
  const vector theta = centre + .45 * (upper - lower);
  const vector step = detail::joint_centring_step(theta, lower, upper, .1);
  CHECK((step + vector::Constant(.1 * .9 * .9 * .9)).norm() < 1e-14);
  CHECK(detail::joint_centring_step(centre, lower, upper, .1).norm() < 1e-14);
}

TEST_CASE("plan_screw_motion: self-motions continue a plan that is stuck") {
  const auto [start, end] = random_problem(1, 96, true);
  const auto goal = arm.pose(end);
  const auto stuck = plan_screw_motion(arm, start, goal, without_search);
  CHECK(stuck.reason == stop_reason::joint_limit);
  CHECK(stuck.tau.back() < 1);
  CHECK(worst(stuck, goal) < 1e-5);
  const auto plan = plan_screw_motion(arm, start, goal);
  CHECK(plan.reason == stop_reason::reached);
  CHECK(plan.iterations > stuck.iterations);
  CHECK(std::adjacent_find(plan.tau.begin(), plan.tau.end()) != plan.tau.end());
  CHECK(std::is_sorted(plan.tau.begin(), plan.tau.end()));
  CHECK(worst(plan, goal) < 1e-5);
}

/// Damped steps alone end at a singularity.
TEST_CASE("plan_screw_motion: passes near a singularity without self-motions") {
  const auto [start, end] = random_problem(1, 84, true);
  const auto goal = arm.pose(end);
  const auto plan = plan_screw_motion(arm, start, goal, without_search);
  CHECK(plan.reason == stop_reason::reached);
  CHECK(plan.smallest_singular_value < detail::damping_threshold);
  CHECK(std::adjacent_find(plan.tau.begin(), plan.tau.end()) == plan.tau.end());
  CHECK(worst(plan, goal) < 1e-5);
}

TEST_CASE("plan_screw_motion: an arm with limits of one joint only reaches its goal") {
  // The same arm with all but one joint continuous, as a chain of run-time size.
  auto joints = std::array<joint<>, 7>{};
  for (std::size_t i = 0; i < 7; ++i) {
    joints[i].axis = {double(i % 2), 0, double((i + 1) % 2)};
    joints[i].origin.translation = {.02, .01, .25};
    joints[i].kind = i == 3 ? joint_kind::revolute : joint_kind::continuous;
  }
  joints[3].limits = {.1, 2};
  const bounded_chain<8> free_arm{std::span<const joint<>>(joints)};
  vector start, end;
  start << .1, .5, .3, 1, -.4, .7, .2;
  end << .5, .2, .6, .6, 0, 1, -.2;
  const auto plan = plan_screw_motion(free_arm, start, free_arm.pose(end));
  CHECK(plan.reason == stop_reason::reached);
  CHECK(plan.smallest_limit_margin > 0);
  CHECK(plan.smallest_limit_margin <= .9);
}

TEST_CASE("N24: the planner of the notes reaches near goals but drifts from the screw") {
  vector end = gripper_down();
  end += vector(.3, -.2, .4, .1, -.3, .2, .4);
  const auto goal = arm.pose(end);
  const auto plan = printed_screw_plan(arm, gripper_down(), goal);
  CHECK(plan.reason == stop_reason::reached);
  const pose_error deviation = pose_error_between(plan.poses.back(), goal);
  CHECK(std::max(deviation.translation, deviation.rotation) <= 1e-4);
  // Each step covers one hundredth of the remaining motion.
  CHECK(plan.iterations > 300);
  double drift = 0;
  for (const pose_error& d : plan.deviations) {
    drift = std::max({drift, d.translation, d.rotation});
  }
  CHECK(drift > 1e-5);
}

TEST_CASE("plan_screw_motion: reports the termination reason") {
  // Farther than the elbow can be stretched: as far as the arm goes.
  const auto far = pose(rotation(arm.pose(gripper_down())), Eigen::Vector3d(.87, 0, .3));
  const auto plan = plan_screw_motion(arm, gripper_down(), far, without_search);
  CHECK(plan.reason == stop_reason::singular);
  CHECK(plan.tau.back() < 1);
  CHECK(plan.tau.back() > .1);
  CHECK(worst(plan, far) < 1e-5);
  CHECK(plan_screw_motion(arm, gripper_down(), far, {.max_iterations = 5}).reason ==
        stop_reason::iteration_limit);
  CHECK(
      plan_screw_motion(arm, gripper_down(), far, {.max_iterations = plan.iterations + 9}).reason ==
      stop_reason::iteration_limit);
  // A joint at its limit, without another joint of the same effect.
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
  CHECK(stopped.smallest_limit_margin >= 0);
  CHECK(std::string(to_text(stopped.reason)) == "joint_limit");
  // Farther away than the links reach: nothing is tried.
  const auto up = [&](double distance) {
    return plan_screw_motion(arm, gripper_down(),
                             pose(quaternion<double>(1), Eigen::Vector3d(0, 0, .333 + distance)));
  };
  const double reach = .316 + 2 * .0825 + .384 + .088 + .107; // and farther than any elbow
  const auto beyond = up(reach);
  CHECK(beyond.reason == stop_reason::out_of_reach);
  CHECK(beyond.iterations == 0);
  CHECK(beyond.joints.size() == 1);
  CHECK(beyond.joints.front() == gripper_down());
  CHECK(beyond.tau.front() == 0);
  CHECK(beyond.smallest_limit_margin > .1);
  const auto short_of_it = up(.85); // the links are long enough, their joints do not bend that way
  CHECK(short_of_it.reason != stop_reason::reached);
  CHECK(short_of_it.reason != stop_reason::out_of_reach);
  CHECK(short_of_it.joints.size() > 1);
  CHECK_THROWS_AS((void)plan_screw_motion(arm, gripper_down(), beyond.poses.front() * 2.0),
                  invalid_input);
  // A path with a gap.
  const auto jump = follow_path(
      gantry, zero,
      [](double u) {
        return pose(quaternion<double>(1), Eigen::Vector3d(0, u < .3 ? u : u + .1, 0));
      },
      0, 1);
  CHECK(jump.reason == stop_reason::no_progress);
  CHECK(jump.tau.back() == doctest::Approx(.3).epsilon(1e-4));
  // The goal is the pose at the start.
  const auto nothing = plan_screw_motion(gantry, zero, gantry.pose(zero));
  CHECK(nothing.reason == stop_reason::reached);
}

TEST_CASE("plan_screw_motion: invalid starts, goals and options are rejected") {
  const vector start = gripper_down();
  const auto goal = arm.pose(start);
  vector outside = start;
  outside[3] = 1;
  DUET_CHECK_REFUSED("duet: plan_screw_motion: joint 3 of the start is 1 (expected a finite "
                     "number from -3.0718 to -0.0698)",
                     plan_screw_motion(arm, outside, goal));
  outside[3] = std::nan("");
  CHECK_THROWS_AS((void)plan_screw_motion(arm, outside, goal), invalid_input);
  CHECK_THROWS_AS((void)plan_screw_motion(arm, start, goal * 2.0), invalid_input);
  CHECK_THROWS_AS((void)printed_screw_plan(arm, start, goal * std::nan("")), invalid_input);
  const auto nowhere = pose(rotation(goal), vector3<double>(INFINITY, 0, 0));
  DUET_CHECK_REFUSED(
      doctest::Contains("duet: plan_screw_motion: the translation of the goal is not finite: ("),
      plan_screw_motion(arm, start, nowhere));
  DUET_CHECK_REFUSED(
      "duet: plan_screw_motion: deviation.translation is 0 (expected a positive number)",
      plan_screw_motion(arm, start, goal, {.deviation = 0}));
  DUET_CHECK_REFUSED(
      "duet: plan_screw_motion: search_step is 1e-09 (expected 0 or a number from 1e-6 to 1)",
      plan_screw_motion(arm, start, goal, {.search_step = 1e-9}));
  CHECK_THROWS_AS((void)plan_screw_motion(arm, start, goal, {.centring = std::nan("")}),
                  invalid_input);
}

} // namespace
} // namespace test_robotics_plan_screw_motion
