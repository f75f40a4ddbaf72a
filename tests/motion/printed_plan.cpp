// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "robotics/paths.hpp"

#include <duet/motion/printed_plan.hpp>

namespace test_motion_printed_plan {
namespace {

using namespace duet;
using duet_test::gripper_down;
using vector = duet_test::coordinates<7>;

const auto arm = robots::panda().table();

vector near_gripper_down() {
  vector end = gripper_down();
  end += vector(.3, -.2, .4, .1, -.3, .2, .4);
  return end;
}

/// A circle of 10 cm through the tip, in n equal steps.
std::vector<dual_quaternion<double>> circle(int n) {
  const auto first = arm.pose(gripper_down());
  std::vector<dual_quaternion<double>> path;
  for (int i = 1; i <= n; ++i) {
    const double u = 6.283185307179586 * i / n;
    const Eigen::Vector3d moved(.1 * std::cos(u) - .1, .1 * std::sin(u), 0);
    path.push_back(pose(quaternion<double>(1), moved) * first);
  }
  return path;
}

/// The largest deviation from the poses after the first half of them.
template <class Plan>
double lag(const Plan& plan, std::size_t poses) {
  double result = 0;
  for (std::size_t k = poses / 2; k <= poses; ++k) {
    result = std::max(result, plan.deviations[k].translation);
  }
  return result;
}

TEST_CASE("N24: every step is ScLERP followed by N23, from the end of the previous step") {
  const auto goal = arm.pose(near_gripper_down());
  for (const double beta : {.3, 1., 1.8, 2.5}) {
    const auto plan = printed_screw_plan(arm, gripper_down(), goal, {.tau = .1, .beta = beta});
    CAPTURE(beta);
    CHECK(plan.reason == stop_reason::reached);
    CHECK(plan.joints.size() == std::size_t(plan.iterations) + 1);
    CHECK(plan.joints.front() == gripper_down());
    for (std::size_t k = 1; k < plan.joints.size(); ++k) {
      const auto next = sclerp(arm.pose(plan.joints[k - 1]), goal, .1);
      CHECK(plan.joints[k] == resolved_step(arm, plan.joints[k - 1], next, beta));
    }
  }
}

TEST_CASE("N24: each step leaves about 1 − βτ of the motion") {
  const auto goal = arm.pose(near_gripper_down());
  const auto initial_error = pose_error_between(arm.pose(gripper_down()), goal);
  const double remaining_part = 1e-4 / std::max(initial_error.translation, initial_error.rotation);
  for (const double tau : {.05, .1}) {
    for (const double beta : {.3, 1., 1.8, 2.5}) {
      CAPTURE(tau);
      CAPTURE(beta);
      const auto plan = printed_screw_plan(arm, gripper_down(), goal, {.tau = tau, .beta = beta});
      CHECK(plan.reason == stop_reason::reached);
      CHECK(plan.iterations ==
            doctest::Approx(std::log(remaining_part) / std::log1p(-beta * tau)).epsilon(.06));
    }
  }
  // If 1 − βτ is not between −1 and 1, the error does not decrease.
  CHECK(printed_screw_plan(arm, gripper_down(), goal, {.tau = 1, .beta = 2.5}).reason !=
        stop_reason::reached);
}

TEST_CASE("N25, note 2: inverse kinematics depends on the start") {
  const auto goal = arm.pose(near_gripper_down());
  std::vector<vector> answers;
  for (const auto& shift : {vector(0, 0, 0, 0, 0, 0, 0), vector(-.6, .3, .5, .4, -.2, .3, -.4),
                            vector(.8, -.2, -.5, .3, .4, .5, .1)}) {
    const auto plan = printed_screw_plan(arm, vector(gripper_down() + shift), goal, {.tau = .1});
    CHECK(plan.reason == stop_reason::reached);
    const auto off = pose_error_between(arm.pose(plan.joints.back()), goal);
    CHECK(off.translation <= 1e-4);
    CHECK(off.rotation <= 1e-4);
    answers.push_back(plan.joints.back());
  }
  CHECK((answers[0] - answers[1]).norm() > .1);
  CHECK((answers[0] - answers[2]).norm() > .1);
  // Started from the result, no step is made.
  CHECK(printed_screw_plan(arm, answers[0], goal).iterations == 0);
}

TEST_CASE("N25, note 1: N23 towards each pose of a path in turn") {
  const auto path = circle(100);
  const auto plan = printed_path_plan(arm, gripper_down(), path, {.beta = .7});
  CHECK(plan.reason == stop_reason::reached);
  CHECK(plan.joints.size() == std::size_t(plan.iterations) + 1);
  CHECK(plan.joints.size() > 101); // it lags, and catches up at the end
  CHECK(plan.tau.front() == 0);
  CHECK(plan.deviations.front().translation ==
        doctest::Approx(.2 * std::sin(3.141592653589793 / 100)));
  for (std::size_t k = 1; k < plan.joints.size(); ++k) {
    const std::size_t target = std::min<std::size_t>(k, 100);
    CHECK(plan.tau[k] == double(target));
    CHECK(plan.joints[k] == resolved_step(arm, plan.joints[k - 1], path[target - 1], .7));
    CHECK(plan.deviations[k].translation ==
          pose_error_between(arm.pose(plan.joints[k]), path[target - 1]).translation);
  }
  CHECK(pose_error_between(arm.pose(plan.joints.back()), path.back()).translation <= 1e-4);
}

TEST_CASE("N25, note 1: dependence of the error along a path on β") {
  const double h = 6.283185307179586 * .1 / 200;
  const auto fine = circle(200);
  for (const double beta : {.3, .6, 1.4, 1.8}) {
    CAPTURE(beta);
    const auto plan = printed_path_plan(arm, gripper_down(), fine, {.beta = beta});
    CHECK(plan.reason == stop_reason::reached);
    CHECK(lag(plan, 200) == doctest::Approx(std::abs(1 - beta) / beta * h).epsilon(.03));
  }
  // With β = 1 a step leaves what is of second order in its length.
  const auto coarse = printed_path_plan(arm, gripper_down(), circle(100));
  const auto exact = printed_path_plan(arm, gripper_down(), fine);
  CHECK(exact.iterations == 200);
  CHECK(lag(coarse, 100) / lag(exact, 200) == doctest::Approx(4).epsilon(.05));
  // Errors grow by 1 − β.
  CHECK(printed_path_plan(arm, gripper_down(), fine, {.beta = 2.5, .max_iterations = 300}).reason !=
        stop_reason::reached);
}

TEST_CASE("N25: invalid paths are rejected") {
  std::vector<dual_quaternion<double>> path;
  CHECK_THROWS_WITH_AS((void)printed_path_plan(arm, gripper_down(), path),
                       "duet: printed_path_plan: the path has no poses", invalid_input);
  path = circle(10);
  CHECK(printed_path_plan(arm, gripper_down(), path, {.max_iterations = 4}).reason ==
        stop_reason::iteration_limit);
  path[3] = dual_quaternion<double>(2);
  CHECK_THROWS_WITH_AS(
      (void)printed_path_plan(arm, gripper_down(), path),
      "duet: printed_path_plan: pose 3 of the path is not a unit dual quaternion: |p|^2 = 4, "
      "p.q = 0 (expected 1 and 0)",
      invalid_input);
  vector outside = gripper_down();
  outside[3] = 1;
  CHECK_THROWS_AS((void)printed_path_plan(arm, outside, circle(10)), invalid_input);
}

} // namespace
} // namespace test_motion_printed_plan
