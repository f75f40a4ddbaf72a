// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Chains of all types and lengths in duet::robotics.

#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>
#include <duet/robotics.hpp>

namespace test_robotics_long_chains {
namespace {

using namespace duet;

/// Revolute joints a fifth of a metre apart, with axes along y and z in turn.
template <int N>
serial_chain<N> snake() {
  std::array<joint<double>, std::size_t(N)> joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    joints[i].kind = joint_kind::revolute;
    joints[i].origin.translation = {i == 0 ? 0 : .2, 0, 0};
    joints[i].axis = i % 2 == 0 ? std::array<double, 3>{0, 0, 1} : std::array<double, 3>{0, 1, 0};
    joints[i].limits = {-2, 2, 1};
  }
  placement<double> tool;
  tool.translation = {.2, 0, 0};
  return serial_chain<N>(joints, tool);
}

template <int N>
Eigen::VectorXd bent(double angle) {
  Eigen::VectorXd theta(N);
  for (int i = 0; i < N; ++i) {
    theta[i] = angle * (i % 3 - 1) + angle / 3;
  }
  return theta;
}

template <class Arm>
void check_pose(const Arm& arm, const Eigen::VectorXd& theta, const dual_quaternion<double>& goal) {
  const pose_error error = pose_error_between(arm.pose(theta), goal);
  CHECK(error.translation < 1e-6);
  CHECK(error.rotation < 1e-6);
}

TEST_CASE("inverse kinematics and planning of a chain of twenty joints") {
  const auto arm = snake<20>();
  const Eigen::VectorXd start = bent<20>(.2);
  const auto goal = arm.pose(bent<20>(.35));
  const auto found = inverse_kinematics(arm, goal, start);
  CHECK(found.reason == stop_reason::reached);
  REQUIRE(found.joints.size() == 20);
  check_pose(arm, found.joints, goal);

  const auto position = position_goal(translation(goal));
  const auto posture = preferred_posture{bent<20>(.1)};
  const auto chosen = inverse_kinematics(arm, position, start, {.candidates = 2}, posture);
  CHECK(chosen.reason == stop_reason::reached);
  CHECK((translation(arm.pose(chosen.joints)) - translation(goal)).norm() < 1e-6);

  const auto plan = plan_screw_motion(arm, start, goal);
  CHECK(plan.reason == stop_reason::reached);
  REQUIRE(plan.joints.size() > 5);
  check_pose(arm, plan.joints.back(), goal);
}

TEST_CASE("inverse kinematics has the same result for chains of 100 joints and an error beyond") {
  const auto arm = snake<100>();
  const auto goal = arm.pose(bent<100>(.06));
  const auto found = inverse_kinematics(arm, goal, bent<100>(.05));
  CHECK(found.reason == stop_reason::reached);
  check_pose(arm, found.joints, goal);
  DUET_CHECK_REFUSED("duet: the chain has 101 joints (expected at most 100)",
                     inverse_kinematics(snake<101>(), dual_quaternion<double>(1.),
                                        Eigen::VectorXd::Zero(101).eval()));
}

TEST_CASE("static, fixed-size and bounded chains have the same solutions and plans") {
  const auto arm = robots::panda();
  const serial_chain<7>& table = arm.table();
  const bounded_chain<12> bounded = table;
  duet_test::random_source random(7);
  Eigen::Matrix<double, 7, 1> start, end;
  for (int i = 0; i < 7; ++i) {
    const auto& limits = table.limits(i);
    start[i] = limits.lower + (limits.upper - limits.lower) * random.uniform(.3, .7);
    end[i] = limits.lower + (limits.upper - limits.lower) * random.uniform(.3, .7);
  }
  const auto goal = arm.pose(end);
  const auto first = inverse_kinematics(arm, goal, start);
  const auto plan = plan_screw_motion(arm, start, goal);
  CHECK(first.reason == stop_reason::reached);
  const auto check_same = [&](const auto& chain) {
    const auto other = inverse_kinematics(chain, goal, start);
    CHECK((other.joints - first.joints).norm() < 1e-9);
    CHECK(other.iterations == first.iterations);
    const auto other_plan = plan_screw_motion(chain, start, goal);
    CHECK(other_plan.reason == plan.reason);
    REQUIRE(other_plan.joints.size() == plan.joints.size());
    CHECK((other_plan.joints.back() - plan.joints.back()).norm() < 1e-9);
  };
  check_same(table);
  check_same(bounded);
  check_same(chain_view(bounded));
}

TEST_CASE("chain_view has the poses, Jacobians and tables of its chain") {
  const auto arm = robots::ur5e();
  const chain_view view = arm;
  const std::array theta{.1, -.2, .3, -.4, .5, -.6};
  REQUIRE(view.size() == 6);
  for (int i = 0; i <= 6; ++i) {
    CHECK(pose_error_between(view.pose(theta, i), arm.pose(theta, i)).translation < 1e-15);
  }
  Eigen::Matrix<double, 6, 6> columns;
  const auto tip = view.pose_and_jacobian(theta.data(), columns.data());
  CHECK((columns - jacobian(arm, theta, frame::hybrid)).norm() < 1e-15);
  CHECK((jacobian(view, theta, frame::body) - jacobian(arm, theta, frame::body)).norm() < 1e-15);
  CHECK((tip.translation.eigen() - translation(arm.pose(theta))).norm() < 1e-15);
  for (int i = 0; i < 6; ++i) {
    CHECK(view.kind(i) == arm.kind(i));
    CHECK(view.limits(i).upper == arm.limits(i).upper);
  }
}

} // namespace
} // namespace test_robotics_long_chains
