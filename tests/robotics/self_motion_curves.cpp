// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/robotics/self_motion_curves.hpp>

#include <initializer_list>

namespace test_robotics_self_motion_curves {
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

/// Distance of a configuration from the nearest point of a curve.
double distance(const self_motion_curve& curve, const vector& theta) {
  double min_distance = std::numeric_limits<double>::infinity();
  for (const auto& x : curve.joints) {
    min_distance = std::min(min_distance, difference(x, theta).norm());
  }
  return min_distance;
}

/// Checks that every curve is closed and consists of solutions, and that exactly one contains the
/// configuration of the goal.
void check_curves(const chain& arm, const vector& theta,
                  const std::vector<self_motion_curve>& curves, double resolution) {
  const auto goal = arm.pose(theta);
  int containing = 0;
  for (const auto& curve : curves) {
    CHECK(curve.is_closed);
    for (std::size_t k = 0; k < curve.joints.size(); ++k) {
      const pose_error error = pose_error_between(arm.pose(curve.joints[k]), goal);
      CHECK(error.translation < 1e-10);
      CHECK(error.rotation < 1e-10);
      const vector step = difference(curve.joints[(k + 1) % curve.joints.size()], curve.joints[k]);
      CHECK(step.norm() > 0);
      CHECK(step.norm() <= resolution * (1 + 1e-9));
    }
    containing += distance(curve, theta) <= resolution / 2;
  }
  CHECK(containing == 1);
}

/// Shoulder, elbow and wrist of iiwa have two branches each, which a self-motion without
/// singularities does not connect.
TEST_CASE("self_motion_curves: an arm with spherical shoulder and wrist has eight components") {
  const chain arm = robots::iiwa14().table();
  duet_test::random_source random(1);
  const vector theta = configuration(random);
  const double resolution = .4;
  const auto curves = self_motion_curves(arm, arm.pose(theta), {.resolution = resolution});
  CHECK(curves.size() == 8);
  check_curves(arm, theta, curves, resolution);
}

TEST_CASE(
    "self_motion_curves: the number of curves of a general arm does not depend on the resolution") {
  duet_test::random_source random(2);
  std::array<joint<>, 7> joints;
  for (auto& j : joints) {
    const auto a = random.direction<4>();
    j.origin = {quaternion<double>(a[0], a[1], a[2], a[3]),
                {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}};
  }
  const chain arm(joints);
  const vector theta = configuration(random);
  const auto curves = self_motion_curves(arm, arm.pose(theta), {.resolution = .9});
  check_curves(arm, theta, curves, .9);
  const auto finer = self_motion_curves(arm, arm.pose(theta), {.resolution = .6});
  CHECK(finer.size() == curves.size());
}

/// Checks a component: a closed curve without jumps, or a sample of the stated dimension; the tip
/// is at the goal.
void check_component(const chain& arm, const self_motion_curve& part,
                     const dual_quaternion<double>& goal, double resolution) {
  for (const auto& x : part.joints) {
    const pose_error error = pose_error_between(arm.pose(x), goal);
    CHECK(error.translation < 1e-10);
    CHECK(error.rotation < 1e-10);
  }
  if (part.dimension == 1) {
    CHECK(part.is_closed);
    for (std::size_t k = 0; k < part.joints.size(); ++k) {
      const auto& next = part.joints[(k + 1) % part.joints.size()];
      CHECK(difference(next, part.joints[k]).norm() <= resolution * (1 + 1e-9));
    }
  } else {
    CHECK(!part.is_closed);
    CHECK((part.dimension == 0 ? part.joints.size() == 1 : part.joints.size() > 20));
  }
}

/// Dimensions of the components, sorted.
std::vector<int> dimensions(const chain& arm, const vector& theta, double resolution) {
  const auto goal = arm.pose(theta);
  std::vector<int> result;
  for (const auto& part : self_motion_curves(arm, goal, {.resolution = resolution})) {
    check_component(arm, part, goal, resolution);
    result.push_back(part.dimension);
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// With a straight elbow axes 3 and 5 coincide, with a straight shoulder or wrist axes 1 and 3 or 5
/// and 7: only the sum of their angles matters. Otherwise the elbow rotates about the line from
/// shoulder to wrist; two curves cross where shoulder or wrist are straight at a point of the
/// circle.
TEST_CASE(
    "self_motion_curves: straight elbows, shoulders and wrists of iiwa yield curves and tori") {
  const chain arm = robots::iiwa14().table();
  const vector bent = (vector() << .3, .6, -.2, -1.3, .4, .9, .1).finished();
  const auto straight = [&](std::initializer_list<int> joints) {
    vector result = bent;
    for (const int i : joints) {
      result[i] = 0;
    }
    return dimensions(arm, result, .6);
  };
  using list = std::vector<int>;
  CHECK(straight({3}) == list{1, 1, 1, 1});
  CHECK(straight({1}) == list{1, 1, 1, 1, 1, 1, 1, 1});
  CHECK(straight({5}) == list{1, 1, 1, 1, 1, 1, 1, 1});
  CHECK(straight({1, 5}) == list{1, 1, 1, 1, 2, 2});
  CHECK(straight({1, 3}) == list{2, 2});
  CHECK(straight({3, 5}) == list{2, 2});
  // Quarter turns, with all links in a plane.
  CHECK(dimensions(arm, pi / 2 * (vector() << 0, 1, 0, 1, 0, 1, 0).finished(), .6) ==
        list{1, 1, 1, 1, 1, 1, 1, 1});
}

TEST_CASE(
    "self_motion_curves: the upright iiwa has one component of three dimensions, evenly sampled") {
  const chain arm = robots::iiwa14().table();
  const vector zero = vector::Zero(), moved = (vector() << .3, 0, -.3, 0, .4, 0, -.4).finished();
  CHECK(pose_error_between(arm.pose(moved), arm.pose(zero)).translation < 1e-12);
  const auto parts = self_motion_curves(arm, arm.pose(zero), {.resolution = .6});
  REQUIRE(parts.size() == 1);
  CHECK(parts[0].dimension == 3);
  CHECK(parts[0].joints.size() == 64);
  CHECK(distance(parts[0], moved) < 2.5);
  for (const auto& x : parts[0].joints) {
    CHECK(std::abs(std::remainder(x[0] + x[2] + x[4] + x[6], 2 * pi)) < 1e-5);
    CHECK(std::abs(std::remainder(x[3], 2 * pi)) < 1e-5);
  }
}

TEST_CASE("self_motion_curves: Panda in its zero configuration has two curves and a torus") {
  CHECK(dimensions(robots::panda().table(), vector::Zero(), .6) == std::vector<int>{1, 1, 2});
}

TEST_CASE("self_motion_curves: other chains and invalid resolutions are rejected") {
  const chain arm = robots::panda().table();
  const auto goal = arm.pose(vector::Zero().eval());
  DUET_CHECK_REFUSED("duet: self_motion_curves: the chain has 6 moving joints (expected 7)",
                     self_motion_curves(robots::ur5e().table(), goal));
  DUET_CHECK_REFUSED("duet: self_motion_curves: resolution is 0 (expected within (0, 1])",
                     self_motion_curves(arm, goal, {.resolution = 0}));
}

} // namespace
} // namespace test_robotics_self_motion_curves
