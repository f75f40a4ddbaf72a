// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/random.hpp"

#include <duet/mechanism/robots.hpp>
#include <duet/planning/self_motion_curves.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace test_planning_self_motion_curves {
namespace {

using namespace duet;
using std::numbers::pi;
using chain = serial_chain<7>;
using vector = Eigen::Matrix<double, 7, 1>;

vector difference(const vector& a, const vector& b) {
  return (a - b).unaryExpr([](double x) { return std::remainder(x, 2 * pi); });
}

vector configuration(duet_test::random_source& random) {
  vector theta;
  for (double& x : theta) {
    x = random.uniform(-pi, pi);
  }
  return theta;
}

/// How far a configuration is from the nearest point of a curve.
double distance(const self_motion_curve<7>& curve, const vector& theta) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& x : curve.joints) {
    least = std::min(least, difference(x, theta).norm());
  }
  return least;
}

/// Every curve is one, every point on it a solution, and the configuration that the goal was made
/// from is on just one of them.
void check_curves(const chain& arm, const vector& theta,
                  const std::vector<self_motion_curve<7>>& curves, double resolution) {
  const auto goal = arm.pose(theta);
  int near = 0;
  for (const auto& curve : curves) {
    CHECK(curve.is_closed);
    for (std::size_t k = 0; k < curve.joints.size(); ++k) {
      const pose_deviation left = deviation_between(arm.pose(curve.joints[k]), goal);
      CHECK(left.length < 1e-10);
      CHECK(left.angle < 1e-10);
      const vector step = difference(curve.joints[(k + 1) % curve.joints.size()], curve.joints[k]);
      CHECK(step.norm() > 0);
      CHECK(step.norm() <= resolution * (1 + 1e-9));
    }
    near += distance(curve, theta) <= resolution / 2;
  }
  CHECK(near == 1);
}

/// Shoulder, elbow and wrist of iiwa turn two ways each, and none of them can be changed with the
/// tip in place where no joint is stretched on the way.
TEST_CASE("eight components of an arm with spherical shoulder and wrist") {
  const chain arm = robots::iiwa14().table();
  duet_test::random_source random(1);
  const vector theta = configuration(random);
  const double resolution = .4;
  const auto curves = self_motion_curves(arm, arm.pose(theta), {.resolution = resolution});
  CHECK(curves.size() == 8);
  check_curves(arm, theta, curves, resolution);
}

TEST_CASE("a general arm; finer curves are as many") {
  duet_test::random_source random(2);
  std::array<joint<>, 7> joints;
  for (auto& j : joints) {
    const auto a = random.direction<4>();
    j.origin = {quaternion<double>(a[0], a[1], a[2], a[3]),
                {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}};
  }
  const chain arm(joints);
  const vector theta = configuration(random);
  const auto curves = self_motion_curves(arm, arm.pose(theta), {.resolution = .4});
  check_curves(arm, theta, curves, .4);
  const auto finer = self_motion_curves(arm, arm.pose(theta), {.resolution = .3});
  CHECK(finer.size() == curves.size());
}

TEST_CASE("what is refused") {
  const chain arm = robots::panda().table();
  const auto goal = arm.pose(vector::Zero().eval());
  CHECK_THROWS_WITH_AS(static_cast<void>(self_motion_curves(robots::ur5e().table(), goal)),
                       "duet: self_motion_curves: the chain has 6 moving joints, not 7",
                       invalid_input);
  CHECK_THROWS_WITH_AS(static_cast<void>(self_motion_curves(arm, goal, {.resolution = 0})),
                       "duet: self_motion_curves: resolution is 0, not within (0, 1]",
                       invalid_input);
}

} // namespace
} // namespace test_planning_self_motion_curves
