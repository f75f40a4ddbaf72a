// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "robotics/chains.hpp"
#include "support/message.hpp"

#include <duet/robotics.hpp>

#include <span>

// Many goals at once are as many one by one, to the last bit.

namespace test_robotics_many_goals {
namespace {

using namespace duet;
using chain = duet_test::any_chain;
using vector = duet_test::any_joints;
using duet_test::configuration;
using result = inverse_kinematics_result;

bool are_identical(const result& a, const result& b) {
  return a.joints == b.joints && a.deviation.translation == b.deviation.translation &&
         a.deviation.rotation == b.deviation.rotation && a.iterations == b.iterations &&
         a.restarts == b.restarts && a.reason == b.reason;
}

template <class Goals, class Objective, class Scene>
void check(const chain& arm, const Goals& goals, const vector& start,
           const inverse_kinematics_options& options, const Objective& objective,
           const Scene& around) {
  std::vector<result> one_by_one, out(goals.size());
  for (const auto& goal : goals) {
    one_by_one.push_back(inverse_kinematics(arm, goal, start, options, objective, around));
  }
  const auto has = [&](stop_reason reason) {
    return std::any_of(one_by_one.begin(), one_by_one.end(),
                       [&](const result& x) { return x.reason == reason; });
  };
  CHECK(has(stop_reason::reached));
  CHECK(has(stop_reason::out_of_reach));
  for (const unsigned threads : {1U, 2U, 3U}) {
    CAPTURE(threads);
    std::fill(out.begin(), out.end(), result{});
    inverse_kinematics(arm, goals, start, out, options, {threads}, objective, around);
    CHECK(std::equal(out.begin(), out.end(), one_by_one.begin(), are_identical));
    std::fill(out.begin(), out.end(), result{});
    const auto enough = [](const progress& p) { return p.done < 4; };
    std::size_t completed = 0;
    try {
      inverse_kinematics(arm, goals, start, out, options, {threads, enough}, objective, around);
    } catch (const cancelled& early) {
      completed = early.completed();
    }
    CHECK(completed >= 4);
    CHECK(completed < 4 + threads);
    CHECK(std::equal(out.begin(), out.begin() + std::ptrdiff_t(completed), one_by_one.begin(),
                     are_identical));
  }
}

const auto small_first = [](const auto& theta) {
  using std::cos;
  return cos(theta[1]) + theta[0] * theta[0];
};

TEST_CASE(
    "many goals: regions agree with single calls to the last bit, with and without objectives") {
  duet_test::random_source random(91);
  for (const chain& arm : {chain(robots::panda().table()), chain(duet_test::stanford_arm(1))}) {
    const vector start = configuration(arm, random);
    std::vector<task_space_region> regions;
    std::vector<dual_quaternion<double>> poses;
    for (int k = 0; k < 10; ++k) {
      const auto tip = arm.pose(configuration(arm, random));
      poses.push_back(tip);
      const vector3<double> n(0, .6, .8), p = translation(tip);
      regions.push_back(k % 3 == 0   ? position_goal(p)
                        : k % 3 == 1 ? position_and_pointing_goal(p, n, rotate(rotation(tip), n))
                                     : free_axis_goal(tip, n));
    }
    regions[2] = position_goal({90, 0, 0});
    poses[5] = pose(quaternion<double>(1), vector3<double>(0, 90, 0));
    const inverse_kinematics_options options{.max_restarts = 5, .seed = 7, .candidates = 2};
    scene around;
    around.bodies = {{arm.size(), sphere<>{{0, 0, 0}, .01}}};
    around.obstacles = {sphere<>{translation(poses[1]), .02}};
    check(arm, regions, start, options, no_objective{}, no_scene{});
    check(arm, std::span(regions), start, options, preferred_posture{start}, no_scene{});
    check(arm, regions, start, options, small_first, around);
    check(arm, poses, start, options, no_objective{}, no_scene{});
    check(arm, poses, start, options, small_first, no_scene{});
    check(arm, poses, start, options, no_objective{}, around);
    const auto plain = inverse_kinematics(arm, poses[1], start, options, {}, around);
    std::vector<result> out(poses.size());
    inverse_kinematics(arm, poses, start, out, options, one_core, {}, around);
    CHECK(are_identical(out[1], plain));
  }
}

TEST_CASE("many goals: user-defined goals in an array; optional arguments") {
  const auto arm = robots::ur5e();
  using joints = Eigen::Matrix<double, 6, 1>;
  const joints start(0, -1, 1, 0, 1, 0);
  const auto at_distance = [](double d) {
    return equation_goal{[d]<class S>(const dual_quaternion<S>& a) {
      return std::array<S, 6>{translation(a).norm() - d};
    }};
  };
  const std::array goals{at_distance(.5), at_distance(.6), at_distance(9)};
  std::array<inverse_kinematics_result, 3> out;
  inverse_kinematics(arm, goals, start, out);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto alone = inverse_kinematics(arm, goals[i], start);
    CHECK(out[i].joints == alone.joints);
    CHECK(out[i].reason == alone.reason);
  }
  CHECK(out[1].reason == stop_reason::reached);
  CHECK(std::abs(translation(arm.pose(out[1].joints)).norm() - .6) < 1e-6);
  CHECK(out[2].reason != stop_reason::reached);
}

TEST_CASE("many goals: invalid arguments are rejected before the first search") {
  const chain arm = robots::panda().table();
  const vector start = (vector(7) << 0, -.8, 0, -2.4, 0, 1.6, .8).finished();
  std::vector<task_space_region> regions(20, position_goal({.5, 0, .5}));
  std::vector<dual_quaternion<double>> poses(
      20, pose(quaternion<double>(1), vector3<double>(.5, 0, .5)));
  std::vector<result> out(20);
  out[0].iterations = -1;
  const preferred_posture preference{start};
  const auto text_of = [&](const auto& goals, std::size_t count, const auto& objective) {
    return duet_test::message_of<invalid_input>([&] {
      inverse_kinematics(arm, goals, start, std::span(out).first(count), {}, all_cores, objective);
    });
  };
  CHECK(text_of(regions, 7, preference) ==
        "duet: inverse_kinematics: 20 goals, but room for 7 results");
  CHECK(text_of(poses, 7, preference) ==
        "duet: inverse_kinematics: 20 goals, but room for 7 results");
  CHECK(text_of(regions, 20, preferred_posture{vector(vector::Zero(3))}) ==
        "duet: preferred_posture: 3 coordinates (expected 7, one per joint)");
  regions[17].max_tilt = -1;
  regions[18].axis = {0, 0, 2};
  poses[17] = 2 * poses[17];
  CHECK(text_of(regions, 20, no_objective{}) ==
        "duet: inverse_kinematics: max_tilt of goal 17 is -1 (expected a non-negative number)");
  CHECK(text_of(poses, 20, preference) == "duet: inverse_kinematics: goal 17 is not a unit dual "
                                          "quaternion: |p|^2 = 4, p.q = 0 (expected 1 and 0)");
  regions[17].max_tilt = 1;
  CHECK(text_of(regions, 20, no_objective{}) ==
        "duet: inverse_kinematics: the axis of goal 18 (0, 0, 2) is not a unit vector");
  CHECK(out[0].iterations == -1);
}

} // namespace
} // namespace test_robotics_many_goals
