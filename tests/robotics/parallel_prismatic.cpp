// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "robotics/chains.hpp"
#include "support/multiprecision.hpp"

#include <duet/kinematics/adapted.hpp>
#include <duet/robotics.hpp>

// Arms with two prismatic joints that are parallel in every configuration: poses within reach have
// infinitely many solutions, represented by one per solution of the revolute joints; other poses
// have none, for certain.

namespace test_robotics_parallel_prismatic {
namespace {

using namespace duet;
using std::numbers::pi;
using chain = duet_test::any_chain;
using vector = duet_test::any_joints;
using result = all_inverse_kinematics_result;

/// Indices of the two prismatic joints, parallel or (`is_opposite`) antiparallel; all joints
/// between them rotate about their direction.
struct arm_kind {
  int first, second;
  bool is_opposite = false;
};
const std::vector<arm_kind> kinds = {{0, 1}, {2, 3}, {4, 5},       {0, 2},       {3, 5},
                                     {1, 4}, {0, 3}, {1, 2, true}, {2, 4, true}, {2, 5, true}};

chain random_arm(const arm_kind& kind, duet_test::random_source& random,
                 double reach = std::numeric_limits<double>::infinity()) {
  std::array<joint<>, 6> joints;
  for (int i = 0; i < 6; ++i) {
    joint<>& each = joints[std::size_t(i)];
    const auto at = [&] { return random.uniform(-1, 1); };
    const auto q = random.direction<4>();
    const double angle = random.uniform(-pi, pi);
    each.origin = {quaternion<double>(q[0], q[1], q[2], q[3]), {at(), at(), at()}};
    if (kind.first < i && i <= kind.second) { // about the previous axis
      each.origin.rotation = quaternion<double>(std::cos(angle), 0, 0, std::sin(angle));
      if (kind.is_opposite && i == kind.second) {
        each.origin.rotation = each.origin.rotation * quaternion<double>(0, 1, 0, 0);
      }
    }
    if (i == kind.first || i == kind.second) {
      each.kind = joint_kind::prismatic;
      each.limits = {-reach, reach};
    }
  }
  return serial_chain<6>(joints, {quaternion<double>(1), {.3, -.2, .4}});
}

vector configuration(duet_test::random_source& random, const arm_kind& kind) {
  vector theta(6);
  for (int i = 0; i < 6; ++i) {
    const double max_abs = i == kind.first || i == kind.second ? 1 : pi;
    theta[i] = random.uniform(-max_abs, max_abs);
  }
  return theta;
}

/// Largest difference of rotation angles, and of the sum of both prismatic displacements.
double distance(const arm_kind& kind, const vector& a, const vector& b) {
  const double sign = kind.is_opposite ? -1 : 1;
  double largest =
      std::abs(a[kind.first] - b[kind.first] + sign * (a[kind.second] - b[kind.second]));
  for (int i = 0; i < 6; ++i) {
    if (i != kind.first && i != kind.second) {
      largest = std::max(largest, std::abs(std::remainder(a[i] - b[i], 2 * pi)));
    }
  }
  return largest;
}
int count_of(const result& all, const arm_kind& kind, const vector& theta) {
  return int(std::count_if(all.solutions.begin(), all.solutions.end(),
                           [&](const auto& s) { return distance(kind, s.joints, theta) < 1e-7; }));
}

/// Pose error by homogeneous matrices with 50 digits.
double max_abs_difference(const chain& arm, const vector& theta,
                          const dual_quaternion<double>& goal) {
  using wide = duet_test::real_50;
  const Eigen::Matrix<wide, Eigen::Dynamic, 1> exact = theta.cast<wide>();
  return double(
      (transform_matrix(arm.pose(exact)) - transform_matrix(dual_quaternion<wide>(goal))).norm());
}

TEST_CASE("all_inverse_kinematics: with parallel prismatic joints each solution of the revolute "
          "joints is found once") {
  duet_test::random_source random(311);
  for (const arm_kind& kind : kinds) {
    CAPTURE(kind.first);
    CAPTURE(kind.second);
    int others = 0;
    for (int k = 0; k < 20; ++k) {
      const chain arm = random_arm(kind, random);
      const vector theta = configuration(random, kind);
      const auto goal = arm.pose(theta);
      const result all = all_inverse_kinematics(arm, goal);
      CHECK(all.method == solution_method::two_prismatic);
      CHECK_FALSE(all.is_complete);
      CHECK(all.complex_solutions == 0);
      CHECK(count_of(all, kind, theta) == 1);
      for (const auto& s : all.solutions) {
        CHECK(max_abs_difference(arm, s.joints, goal) < 1e-12);
        CHECK(s.smallest_singular_value < 1e-14);
        CHECK(count_of(all, kind, s.joints) == 1);
        CHECK(s.within_limits);
      }
      for (int start = 0; start < 5; ++start) {
        const auto solution = inverse_kinematics(arm, goal, configuration(random, kind),
                                                 {.tolerance = 1e-11, .max_restarts = 3});
        if (solution.reason == stop_reason::reached) {
          ++others;
          CHECK(count_of(all, kind, solution.joints) == 1);
        }
      }
    }
    CHECK(others > 20); // otherwise the search has tested nothing
  }
}

TEST_CASE("all_inverse_kinematics: with parallel prismatic joints a goal outside the reachable "
          "set has no solution, for certain") {
  duet_test::random_source random(312);
  for (const arm_kind& kind : kinds) {
    int certain = 0;
    for (int k = 0; k < 10; ++k) {
      const chain arm = random_arm(kind, random);
      const auto reachable = arm.pose(configuration(random, kind));
      const auto q = random.direction<4>();
      const auto anywhere = pose(quaternion<double>(q[0], q[1], q[2], q[3]),
                                 vector3<double>(.2, .5, random.uniform(-1, 1)));
      const auto slightly_off =
          pose(from_rotation_vector(vector3<double>(1e-6, 1e-6, 0)), vector3<double>(0, 0, 0)) *
          reachable;
      for (const auto& goal : {anywhere, slightly_off}) {
        const result all = all_inverse_kinematics(arm, goal);
        CHECK(all.solutions.empty());
        certain += all.is_complete;
      }
    }
    CHECK(certain >= 19);
  }
}

TEST_CASE("all_inverse_kinematics: parallel prismatic joints are moved within their limits") {
  duet_test::random_source random(313);
  for (const arm_kind& kind : kinds) {
    int within = 0;
    for (int k = 0; k < 10; ++k) {
      const chain arm = random_arm(kind, random);
      const vector theta = configuration(random, kind);
      vector lower = lower_limits(arm), upper = upper_limits(arm);
      for (const int i : {kind.first, kind.second}) { // a short range around its coordinate
        lower[i] = theta[i] - random.uniform(0, .1);
        upper[i] = theta[i] + random.uniform(0, .1);
      }
      const auto limited = with_limits(arm, lower, upper);
      const auto goal = limited.pose(theta);
      const result all = all_inverse_kinematics(limited, goal);
      CHECK(count_of(all, kind, theta) == 1);
      for (const auto& s : all.solutions) {
        CHECK(max_abs_difference(limited, s.joints, goal) < 1e-12);
        within += s.within_limits && distance(kind, s.joints, theta) < 1e-7;
      }
    }
    CHECK(within == 10);
  }
}

TEST_CASE(
    "all_inverse_kinematics: prismatic joints that are parallel for some goals only are solved") {
  duet_test::random_source random(314);
  std::array<joint<>, 6> joints;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto q = random.direction<4>();
    joints[i].origin = {quaternion<double>(q[0], q[1], q[2], q[3]),
                        {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}};
  }
  joints[0].origin.rotation = quaternion<double>(1);
  joints[0].kind = joints[5].kind = joint_kind::prismatic;
  const chain arm = serial_chain<6>(joints, {});
  // Goals at which the last prismatic joint is parallel to the first, found by a search for the
  // rotation alone.
  const arm_kind kind{0, 5};
  const double infinity = std::numeric_limits<double>::infinity();
  int made = 0;
  for (int k = 0; k < 10; ++k) {
    const double angle = random.uniform(-pi, pi);
    const quaternion<double> upright(std::cos(angle), 0, 0, std::sin(angle));
    const task_space_region rotation_alone{.frame = pose(upright, vector3<double>(0, 0, 0)),
                                           .lower = {-infinity, -infinity, -infinity},
                                           .upper = {infinity, infinity, infinity}};
    const auto known = inverse_kinematics(arm, rotation_alone, configuration(random, kind),
                                          {.tolerance = {1, 1e-14}});
    if (known.reason == stop_reason::reached) {
      ++made;
      const auto goal = pose(upright, translation(arm.pose(known.joints)));
      const result all = all_inverse_kinematics(arm, goal);
      CHECK(count_of(all, kind, known.joints) == 1);
      CHECK_FALSE(all.is_complete);
    }
  }
  CHECK(made > 4);
}

} // namespace
} // namespace test_robotics_parallel_prismatic
