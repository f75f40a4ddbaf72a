// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "robotics/paths.hpp"

#include <duet/duet.hpp>
#include <duet/robotics.hpp>

namespace test_robotics_follow_path {
namespace {

using namespace duet;
using duet_test::gripper_down;
using duet_test::largest_deviation;
using vector = duet_test::coordinates<7>;
using poses = std::vector<dual_quaternion<double>>;

const auto arm = robots::panda().table();

/// The tip at the gripper-down pose and on a round nearby.
poses corners() {
  const auto first = arm.pose(gripper_down());
  poses result = {first};
  for (const Eigen::Vector3d& t :
       {Eigen::Vector3d(.1, .05, 0), Eigen::Vector3d(.1, .1, .08), Eigen::Vector3d(0, .1, .05)}) {
    result.push_back(pose(from_rotation_vector(Eigen::Vector3d(2 * t)), t) * first);
  }
  return result;
}

template <class Plan>
void check_reached(const Plan& plan, double last) {
  CHECK(plan.reason == stop_reason::reached);
  CHECK(plan.tau.back() == last);
  CHECK(plan.joints.front() == gripper_down());
}

TEST_CASE("follow_path: passes through each pose of a list along screw motions") {
  const poses list = corners();
  const auto path = [&](double u) {
    const std::size_t i = std::min(std::size_t(u), list.size() - 2);
    return sclerp(list[i], list[i + 1], u - double(i));
  };
  const auto plan = follow_path(arm, gripper_down(), list);
  check_reached(plan, 3);
  CHECK(largest_deviation(arm, plan, path) < 1e-5);
  for (std::size_t i = 0; i < list.size(); ++i) {
    CHECK(std::count(plan.tau.begin(), plan.tau.end(), double(i)) == 1);
  }
  // Two poses are what plan_screw_motion takes.
  const auto two = follow_path(arm, gripper_down(), poses{list[0], list[1]});
  const auto screw = plan_screw_motion(arm, gripper_down(), list[1]);
  REQUIRE(two.joints.size() == screw.joints.size());
  CHECK((two.joints.back() - screw.joints.back()).norm() < 1e-9);
  CHECK(follow_path(arm, gripper_down(), poses{list[0]}).reason == stop_reason::reached);
}

TEST_CASE("follow_path: follows splines over their domains") {
  const poses list = corners();
  const std::vector<double> u = {2, 2.5, 4, 5};
  const auto smooth = interpolate<rotation_vector_spline<dual<double, 1, screw_tag>>>(u, list);
  const auto plan = follow_path(arm, gripper_down(), smooth);
  check_reached(plan, 5);
  CHECK(plan.tau.front() == 2);
  CHECK(largest_deviation(arm, plan, smooth) < 1e-5);
  const auto curve = interpolate<cumulative_bspline<dual<double, 1, screw_tag>>>(u, list);
  const auto other = follow_path(arm, gripper_down(), curve);
  check_reached(other, 5);
  CHECK(largest_deviation(arm, other, curve) < 1e-5);
}

TEST_CASE("follow_path: objectives move the joints and keep the tip on the path") {
  vector bent = gripper_down();
  bent[2] = .6;
  const auto first = arm.pose(bent);
  const auto circle = [&](double u) {
    return pose(quaternion<double>(1),
                Eigen::Vector3d(.1 * (std::cos(u) - 1), .1 * std::sin(u), 0)) *
           first;
  };
  const auto plain = follow_path(arm, bent, circle, 0, 3);
  CHECK(plain.reason == stop_reason::reached);
  CHECK(plain.tau.back() == 3);
  CHECK(largest_deviation(arm, plain, circle) < 1e-5);

  vector posture = bent;
  posture[2] = -.6;
  const auto distance = [&](const auto& plan) { return (plan.joints.back() - posture).norm(); };
  const auto by_formula = follow_path(arm, bent, circle, 0, 3, {}, preferred_posture{posture, 5.0});
  CHECK(by_formula.reason == stop_reason::reached);
  CHECK(largest_deviation(arm, by_formula, circle) < 1e-5);
  CHECK(distance(by_formula) < distance(plain) - .01);
  // The same function, differentiated automatically.
  const auto by_ad = follow_path(arm, bent, circle, 0, 3, {}, [&](const auto& theta) {
    return preferred_posture{posture, 5.0}(theta);
  });
  REQUIRE(by_ad.joints.size() == by_formula.joints.size());
  CHECK((by_ad.joints.back() - by_formula.joints.back()).norm() < 1e-9);

  const auto agile =
      follow_path(arm, bent, circle, 0, 3, {.centring = 0}, manipulability_objective{arm, 10.0});
  const auto lazy = follow_path(arm, bent, circle, 0, 3, {.centring = 0});
  CHECK(agile.reason == stop_reason::reached);
  CHECK(largest_deviation(arm, agile, circle) < 1e-5);
  CHECK(manipulability(arm, agile.joints.back()) > 1.01 * manipulability(arm, lazy.joints.back()));
}

TEST_CASE("objectives: member gradients agree with automatic differentiation") {
  const vector theta = gripper_down() + vector::Constant(.1);
  // No joint where a sign would not count.
  const preferred_posture posture{gripper_down() + vector::Constant(.3), 3.0};
  CHECK((gradient(posture, theta).gradient - posture.gradient(theta)).norm() < 1e-14);
  const manipulability_objective agile{arm, 1.5};
  const auto symbolic = agile.gradient(theta);
  CHECK((gradient(agile, theta).gradient - symbolic).norm() < 1e-12 * symbolic.norm());
}

TEST_CASE("follow_path: an objective that is nan at the start is rejected") {
  const Eigen::Matrix<double, 7, 1> start(0, -.75, 0, -2.5, 0, 1.5, .75);
  const auto nowhere = [](const auto& x) { return 0 * x[0] + std::nan(""); };
  const auto start_pose = arm.pose(start);
  const auto path = [&](double u) {
    return pose(quaternion<double>(1), vector3<double>(0, 0, .05 * u)) * start_pose;
  };
  const char* const what = "duet: follow_path: the objective is nan at the start, joints "
                           "(0, -0.75, 0, -2.5, 0, 1.5, 0.75)";
  DUET_CHECK_REFUSED(what, follow_path(arm, start, path, 0, 1, {}, nowhere));
  DUET_CHECK_REFUSED(what, plan_screw_motion(arm, start, path(1), {}, nowhere));
}

TEST_CASE("follow_path: invalid paths and starts are rejected") {
  const vector start = gripper_down();
  const auto first = arm.pose(start);
  const auto still = [&](double) { return first; };
  DUET_CHECK_REFUSED("duet: follow_path: the list of poses is empty",
                     follow_path(arm, start, poses{}));
  DUET_CHECK_REFUSED(
      doctest::Contains(
          "duet: follow_path: pose 1 is not a unit dual quaternion: |p|^2 = 4, p.q = "),
      follow_path(arm, start, poses{first, first * 2.0}));
  DUET_CHECK_REFUSED(
      doctest::Contains("duet: follow_path: the path begins 0.5 units of length and "),
      follow_path(arm, start,
                  poses{pose(quaternion<double>(1), Eigen::Vector3d(0, 0, .5)) * first}));
  DUET_CHECK_REFUSED("duet: follow_path: the parameter of the path goes from 1 to 1 "
                     "(expected an increasing, finite interval)",
                     follow_path(arm, start, still, 1, 1));
  CHECK_THROWS_AS((void)follow_path(arm, start, still, 0, INFINITY), invalid_input);
  DUET_CHECK_REFUSED(
      doctest::Contains("is not finite: (nan, nan, nan, nan)"),
      follow_path(
          arm, start, [&](double u) { return u > .5 ? first * std::nan("") : first; }, 0, 1));
  vector outside = start;
  outside[5] = 4;
  DUET_CHECK_REFUSED("duet: follow_path: joint 5 of the start is 4 (expected a finite number "
                     "from -0.0175 to 3.7525)",
                     follow_path(arm, outside, poses{first}));
  CHECK_THROWS_AS((void)follow_path(arm, Eigen::VectorXd(Eigen::VectorXd::Zero(6)), poses{first}),
                  invalid_input);
}

} // namespace
} // namespace test_robotics_follow_path
