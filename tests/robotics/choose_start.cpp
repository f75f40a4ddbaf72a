// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "robotics/chains.hpp"
#include "support/message.hpp"
#include "support/samples.hpp"

#include <duet/duet.hpp>
#include <duet/robotics.hpp>

namespace test_robotics_choose_start {
namespace {

using namespace duet;
using chain = duet_test::any_chain;
using vector = duet_test::any_joints;
using duet_test::configuration;

const chain ur5e = robots::ur5e().table();
const vector bent = (vector(6) << .3, -1.1, 1.4, -.5, .9, .2).finished();

/// The tip's path upwards from its pose at `bent`.
dual_quaternion<double> rising(double u) {
  return pose(quaternion<double>(1), vector3<double>(0, 0, .05 * u)) * ur5e.pose(bent);
}

/// True if it is a plan along the complete path, from a start within limits.
template <class Path>
bool is_complete_plan(const chain& arm, const start_search_result& found, const Path& path,
                      double first, double last) {
  const auto& plan = found.plan;
  if (found.reason != stop_reason::reached || found.unsolved || plan.tau.front() != first ||
      plan.tau.back() != last) {
    return false;
  }
  for (std::size_t k = 0; k < plan.joints.size(); ++k) {
    const auto deviation = pose_error_between(arm.pose(plan.joints[k]), path(plan.tau[k]));
    if (deviation.translation > 1e-5 || deviation.rotation > 1e-5 ||
        !duet_test::is_within_limits(arm, plan.joints[k])) {
      return false;
    }
  }
  return true;
}

TEST_CASE("find_start_configuration: finds a start for every path of a known joint path") {
  duet_test::random_source random(91);
  const std::array<chain, 5> arms{robots::ur5e().table(), robots::panda().table(),
                                  robots::iiwa14().table(), robots::baxter_left().table(),
                                  duet_test::every_joint()};
  for (const chain& arm : arms) {
    CAPTURE(&arm - arms.data());
    const int count = arm.size() == 6 ? duet_test::sample_count(20) : 1;
    int solved = 0;
    for (int k = 0; k < count; ++k) {
      const vector from = configuration(arm, random), to = configuration(arm, random);
      const auto path = [&](double u) { return arm.pose((from + .3 * u * (to - from)).eval()); };
      const auto found = find_start_configuration(arm, path, 0, 1, {.resolution = .5});
      solved += is_complete_plan(arm, found, path, 0, 1);
    }
    CHECK(solved == count);
  }
}

TEST_CASE("find_start_configuration: finds the only feasible branch and full turn") {
  // The last joint rotates by two and a half full turns, so it must begin near a limit.
  const vector theta = (vector(6) << .3, -1.1, 1.4, -.5, .9, -6).finished();
  const auto path = [&](double u) {
    vector x = theta;
    x[5] += 11 * u;
    return ur5e.pose(x);
  };
  const auto found = find_start_configuration(ur5e, path, 0, 1);
  CHECK(is_complete_plan(ur5e, found, path, 0, 1));
  CHECK(found.plan.joints.front()[5] < -4);
  // A further two and a half full turns do not fit into the limits.
  const auto more = [&](double u) {
    vector x = theta;
    x[5] += 14 * u;
    return ur5e.pose(x);
  };
  const auto stuck = find_start_configuration(ur5e, more, 0, 1);
  CHECK(stuck.reason == stop_reason::joint_limit);
  CHECK(!stuck.unsolved); // each pose has solutions, the path has none
  CHECK(stuck.plan.tau.back() > .8);
}

TEST_CASE("find_start_configuration: the start with the lowest objective is tried first") {
  const auto all = all_inverse_kinematics(ur5e, rising(0));
  REQUIRE(all.solutions.size() == 8);
  for (const auto& branch : all.solutions) {
    const auto found =
        find_start_configuration(ur5e, rising, 0, 1, {}, preferred_posture{branch.joints});
    CHECK(found.reason == stop_reason::reached);
    CHECK(found.starts == 1);
    CHECK((found.plan.joints.front() - branch.joints).norm() < 1e-9);
  }
}

TEST_CASE(
    "find_start_configuration: starts with a nan objective are skipped; nan at all is an error") {
  for (const auto& branch : all_inverse_kinematics(ur5e, rising(0)).solutions) {
    const auto only = [&](const auto& x) {
      using std::sqrt;
      auto sum = 1e-6 - (x[0] - branch.joints[0]) * (x[0] - branch.joints[0]);
      for (int i = 1; i < 6; ++i) {
        sum -= (x[i] - branch.joints[i]) * (x[i] - branch.joints[i]);
      }
      return sqrt(sum);
    };
    const auto found = find_start_configuration(ur5e, rising, 0, 1, {}, only);
    CHECK((found.plan.joints.front() - branch.joints).norm() < 1e-9);
  }
  const auto nowhere = [](const auto& x) { return 0 * x[0] + std::nan(""); };
  CHECK(duet_test::message_of<invalid_input>(
            [&] { (void)find_start_configuration(ur5e, rising, 0, 1, {}, nowhere); })
            .starts_with("duet: find_start_configuration: the objective is nan at all starts, for "
                         "example at the joints ("));
}

TEST_CASE("find_start_configuration: reports the first pose without a solution and the reason") {
  const auto start = ur5e.pose(bent);
  const auto out = [&](double u) {
    return pose(quaternion<double>(1), vector3<double>(2 * u, 0, 0)) * start;
  };
  const auto far = find_start_configuration(ur5e, out, 0, 1);
  REQUIRE(far.unsolved);
  CHECK(far.is_certain);
  CHECK((far.reason == stop_reason::out_of_reach || far.reason == stop_reason::no_solution));
  // At this parameter the pose is just out of reach.
  CHECK(all_inverse_kinematics(ur5e, out(*far.unsolved)).solutions.empty());
  CHECK(!all_inverse_kinematics(ur5e, out(*far.unsolved - 2e-6)).solutions.empty());
  CHECK(far.plan.tau.back() > .9 * *far.unsolved);
  // At this first pose there is no solution at all.
  const auto none = find_start_configuration(ur5e, out, .9, 1);
  REQUIRE(none.unsolved);
  CHECK(*none.unsolved == .9);
  CHECK(none.reason == stop_reason::out_of_reach);
  CHECK(none.plan.joints.empty());

  // Limits: the base rotates by at most 1 rad, and the wrist cannot reach its other solution.
  auto limited = ur5e;
  for (int i = 0; i < 6; ++i) {
    limited = with_limits(limited, i, {bent[i] - .5, bent[i] + .5});
  }
  const auto rotating = [&](double u) {
    return pose(exp(vector3<double>(0, 0, u / 2)), vector3<double>(0, 0, 0)) * start;
  };
  const auto bounded = find_start_configuration(limited, rotating, 0, 1);
  REQUIRE(bounded.unsolved);
  CHECK(bounded.reason == stop_reason::joint_limit);
  CHECK(bounded.is_certain);
  CHECK(*bounded.unsolved == doctest::Approx(.5).epsilon(1e-5));

  // Obstacles: a wall on the path of the flange.
  scene around;
  around.bodies = {{6, {vector3<double>(0, 0, 0), vector3<double>(0, 0, -.05), .04}}};
  around.obstacles = {box<double>{
      pose(quaternion<double>(1), vector3<double>(translation(start) + vector3<double>(0, 0, -.4))),
      vector3<double>(1, 1, .1)}};
  const auto down = [&](double u) {
    return pose(quaternion<double>(1), vector3<double>(0, 0, -.35 * u)) * start;
  };
  const auto blocked = find_start_configuration(ur5e, down, 0, 1, {}, no_objective{}, around);
  REQUIRE(blocked.unsolved);
  CHECK(blocked.reason == stop_reason::obstacle);
  CHECK(*blocked.unsolved > .3);
  CHECK(*blocked.unsolved < 1);
}

TEST_CASE("find_start_configuration: follows a spline of poses over its whole domain") {
  std::vector<double> u;
  std::vector<dual_quaternion<double>> poses;
  for (int i = 0; i < 5; ++i) {
    vector x = bent;
    x[0] += .2 * i;
    x[3] -= .1 * i;
    u.push_back(2 + i);
    poses.push_back(ur5e.pose(x));
  }
  const auto curve = interpolate<rotation_vector_spline<dual<double, 1, screw_tag>>>(u, poses);
  const auto found = find_start_configuration(ur5e, curve);
  CHECK(is_complete_plan(ur5e, found, curve, 2, 6));
  // Every knot is a waypoint.
  for (const double each : u) {
    CHECK(std::find(found.plan.tau.begin(), found.plan.tau.end(), each) != found.plan.tau.end());
  }
  // The objective says which start, as of other paths.
  for (const auto& branch : all_inverse_kinematics(ur5e, curve(2)).solutions) {
    const auto preferred =
        find_start_configuration(ur5e, curve, {}, preferred_posture{branch.joints});
    CHECK((preferred.reason != stop_reason::reached || preferred.starts > 1 ||
           (preferred.plan.joints.front() - branch.joints).norm() < 1e-9));
  }
}

/// The flange's body is kept apart from the upper arm's: of the elbow's two ways one is too near.
TEST_CASE("inverse kinematics and starts respect self-collision pairs") {
  const auto all = all_inverse_kinematics(ur5e, ur5e.pose(bent));
  REQUIRE(all.solutions.size() == 8);
  scene around;
  around.bodies = {{2, {vector3<double>(0, 0, .1), vector3<double>(-.4, 0, .1), .05}},
                   {6, {vector3<double>(0, 0, 0), vector3<double>(0, 0, .1), .05}}};
  around.pairs = {{0, 1}};
  std::vector<double> distances;
  for (const auto& branch : all.solutions) {
    distances.push_back(clearance(ur5e, branch.joints, around).distance);
  }
  const auto [nearest_pair, farthest_pair] =
      std::minmax_element(distances.begin(), distances.end());
  REQUIRE(*farthest_pair > *nearest_pair + .02);
  around.margin = (*nearest_pair + *farthest_pair) / 2;
  const vector too_near = all.solutions[std::size_t(nearest_pair - distances.begin())].joints;
  const auto goal = ur5e.pose(bent);
  // Without pairs the solution at the start is the one; with them it is another.
  const auto free = inverse_kinematics(ur5e, goal, too_near);
  CHECK((free.joints - too_near).norm() < 1e-9);
  const auto separated = inverse_kinematics(ur5e, goal, too_near, {}, no_objective{}, around);
  REQUIRE(separated.reason == stop_reason::reached);
  CHECK(clearance(ur5e, separated.joints, around).distance >= around.margin - 1e-6);

  const auto path = [&](double u) {
    return pose(quaternion<double>(1), vector3<double>(0, 0, .02 * u)) * goal;
  };
  const preferred_posture preference{too_near};
  CHECK((find_start_configuration(ur5e, path, 0, 1, {}, preference).plan.joints.front() - too_near)
            .norm() < 1e-9);
  const auto found = find_start_configuration(ur5e, path, 0, 1, {}, preference, around);
  REQUIRE(is_complete_plan(ur5e, found, path, 0, 1));
  CHECK(found.plan.smallest_clearance >= around.margin - 1e-6);
  // No configuration keeps this distance.
  around.margin = *farthest_pair + .3;
  around.influence_distance_offset = 1;
  const auto none = find_start_configuration(ur5e, path, 0, 1, {}, preference, around);
  CHECK(none.reason == stop_reason::obstacle);
  REQUIRE(none.unsolved);
  CHECK(*none.unsolved == 0);
}

TEST_CASE(
    "find_start_configuration: a seven-joint path that ends early reports the unsolved pose") {
  const chain arm = robots::iiwa14().table();
  const vector theta = (vector(7) << .3, .6, -.2, -1.3, .4, .9, .1).finished();
  const auto path = [&](double u) {
    return pose(quaternion<double>(1), vector3<double>(0, 0, u)) * arm.pose(theta);
  };
  const auto found = find_start_configuration(arm, path, 0, 1,
                                              {.max_starts = 4, .resolution = .5, .sampling = .1});
  REQUIRE(found.unsolved);
  CHECK((found.reason == stop_reason::out_of_reach || found.reason == stop_reason::no_solution));
  CHECK(found.plan.tau.back() <= *found.unsolved + 1e-5);
  CHECK(found.plan.tau.back() > .8 * *found.unsolved);
}

TEST_CASE("find_start_configuration: invalid options, intervals and postures are rejected") {
  const auto path = [&](double) { return ur5e.pose(bent); };
  DUET_CHECK_REFUSED("duet: find_start_configuration: the parameter of the path goes from 1 to 1 "
                     "(expected an increasing, finite interval)",
                     find_start_configuration(ur5e, path, 1, 1));
  DUET_CHECK_REFUSED("duet: find_start_configuration: max_starts is 0 (expected a positive number)",
                     find_start_configuration(ur5e, path, 0, 1, {.max_starts = 0}));
  DUET_CHECK_REFUSED("duet: find_start_configuration: sampling is 2 (expected within (0, 1])",
                     find_start_configuration(ur5e, path, 0, 1, {.sampling = 2}));
  const preferred_posture few{vector(vector::Zero(5))};
  const char* const what = "duet: preferred_posture: 5 coordinates (expected 6, one per joint)";
  DUET_CHECK_REFUSED(what, find_start_configuration(ur5e, path, 0, 1, {}, few));
  DUET_CHECK_REFUSED(what, follow_path(ur5e, bent, path, 0, 1, {}, few));
}

} // namespace
} // namespace test_robotics_choose_start
