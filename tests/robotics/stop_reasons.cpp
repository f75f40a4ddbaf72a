// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "robotics/layered_search.hpp"
#include "robotics/paths.hpp"
#include "robotics/singular_problems.hpp"

#include <duet/kinematics/adapted.hpp>
#include <duet/robotics/follow_path.hpp>
#include <duet/robotics/plan_screw_motion.hpp>
#include <duet/robotics/self_motion_curves.hpp>

#include <Eigen/Core>

namespace test_robotics_stop_reasons {
namespace {

using namespace duet;
using namespace singular_problems;

/// One of `bench/reasons.cpp`.
struct case_of_bench {
  std::size_t arm;
  family kind;
  unsigned seed;
  int number;
};
constexpr std::size_t ur5e = 0, puma = 1, irb = 2, kr = 3, mate = 4;

constexpr std::size_t panda = 0, iiwa = 1, baxter = 2;

/// The plan, which keeps to its screw.
template <int N>
motion_plan plan_of(const arm<N>& a, const case_of_bench& which, screw& path) {
  const auto p = make(a, which.kind, which.seed, which.number);
  path = {a.chain.pose(p.start), a.chain.pose(p.end)};
  auto plan = plan_screw_motion(a.chain, p.start, path.last);
  CHECK(duet_test::largest_deviation(a.chain, plan, path) < 1.01e-5);
  return plan;
}

struct six_case {
  std::string what;
  case_of_bench which;
  stop_reason reason;
  double tolerance = 1e-4; ///< of the end, by a complete search; 0: without this search
};

TEST_CASE("plans of six joints stop where the path ends, with the reason of a complete search") {
  const auto arms = six_joints();
  for (const six_case& each : std::initializer_list<six_case>{
           {"a limit ends a rapid reorientation within a micrometre of a singularity, whose "
            "smallest singular values are 2e-7 to 4e-7",
            {puma, family::past, 1, 27},
            stop_reason::joint_limit},
           {"the same", {kr, family::near_wrist, 3, 11}, stop_reason::joint_limit},
           {"a limit just before a singularity, without which joints would go on by 3e-7 of the "
            "path",
            {mate, family::near_wrist, 3, 53},
            stop_reason::joint_limit},
           {"the self-motion of joints 2, 3, 4 and 6 at the UR5e's singular wrist ends at limits "
            "before the continuation begins",
            {ur5e, family::from_wrist, 1, 94},
            stop_reason::joint_limit},
           {"the same", {ur5e, family::from_wrist, 2, 9}, stop_reason::joint_limit},
           {"the same", {ur5e, family::from_wrist, 2, 42}, stop_reason::joint_limit},
           {"the same", {ur5e, family::from_wrist, 3, 48}, stop_reason::joint_limit},
           {"the same", {ur5e, family::from_wrist, 3, 72}, stop_reason::joint_limit},
           {"poses out of reach by less than the tolerance are passed, and a later limit ends the "
            "path",
            {kr, family::from_elbow, 3, 33},
            stop_reason::joint_limit},
           {"the elbow, 1.5 milliradians from where it is stretched, may bend to either side",
            {kr, family::near_wrist, 2, 86},
            stop_reason::reached},
           {"a limit blocks the rapid reorientation, but the tip passes at a distance of 9.6e-6",
            {ur5e, family::past, 4, 32},
            stop_reason::reached,
            0},
           {"whole steps of the search end 5e-4 of the path before",
            {mate, family::from_wrist, 3, 30},
            stop_reason::singular,
            1e-5},
           {"whole steps of the search end 4e-3 of the path before",
            {kr, family::from_elbow, 4, 74},
            stop_reason::joint_limit,
            1e-5},
           {"the exact path ends at a limit, but within the deviation it continues past the "
            "singularity from where full steps of the search end, not shorter ones",
            {puma, family::past, 2, 59},
            stop_reason::reached,
            0},
           {"the same", {irb, family::past, 2, 1}, stop_reason::reached, 0},
           {"the same", {kr, family::past, 2, 62}, stop_reason::reached, 0},
           {"the same", {kr, family::past, 2, 72}, stop_reason::reached, 0},
           {"the same", {mate, family::past, 3, 56}, stop_reason::reached, 0}}) {
    CAPTURE(each.what);
    CAPTURE(each.which.arm);
    CAPTURE(each.which.number);
    const auto& a = arms[each.which.arm];
    screw path;
    const auto plan = plan_of(a, each.which, path);
    CHECK(plan.reason == each.reason);
    if (each.tolerance > 0) {
      const auto verdict = duet_test::complete_path_verdict(a.chain, path, plan);
      CHECK(verdict.why == each.reason);
      CHECK(plan.tau.back() > verdict.end - each.tolerance);
    }
  }
}

using seven = Eigen::Matrix<double, 7, 1>;

/// Verdict by all self-motion curves, from the start alone.
duet_test::path_verdict layered(const serial_chain<7>& arm,
                                const duet_test::layered_search::path_function& path,
                                const seven& start) {
  const auto nothing = [](double) { return std::optional<seven>(); };
  return duet_test::layered_search(arm, path, nothing)(start);
}

/// Both verdicts are checked: a path with a continuation and one without.
TEST_CASE("layered_search: verdict for paths with known results") {
  const auto arm = robots::panda().table();
  const seven start = (seven() << .3, -.8, .2, -2.1, .1, 1.6, .8).finished();
  // The base rotates by 2u, the ranges of the others are almost zero.
  const auto rotating = [&](double u) {
    return pose(exp(vector3<double>(0, 0, u)), vector3<double>(0, 0, 0)) * arm.pose(start);
  };
  const seven margin = (seven() << .1, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3).finished();
  const auto stopped =
      layered(with_limits(arm, seven(start - margin), seven(start + margin)), rotating, start);
  CHECK(stopped.why == stop_reason::joint_limit);
  CHECK(std::abs(stopped.end - .05) < .005);
  // Outwards, without limits to speak of: as far as the arm reaches.
  const seven range = seven::Constant(3.1);
  const auto far = with_limits(arm, seven(-range), range);
  const auto out = [&](double u) {
    return pose(quaternion<double>(1), vector3<double>(4 * u, 0, 0)) * arm.pose(start);
  };
  const auto ended = layered(far, out, start);
  CHECK(ended.why == stop_reason::singular);
  CHECK(!self_motion_curves(arm, out(ended.end)).empty());
  CHECK(self_motion_curves(arm, out(ended.end + 1e-5)).empty());
}

/// Where the path ends by the complete search, which takes seconds for each: `bench/reasons.cpp`
/// runs it for all of them.
struct seven_case {
  std::string what;
  case_of_bench which;
  double end, tolerance;
};

TEST_CASE("plans of seven joints end where the path ends") {
  const char* const small = "pieces get small: whole steps end 2e-5 to 2e-4 of the path before";
  const char* const limit = "a limit ends the path 4e-5 or 2e-5 before a singularity";
  const char* const led = "whole steps pass the singularity of wrist or shoulder so closely that "
                          "joints are led to another side of it";
  for (const seven_case& each : std::initializer_list<seven_case>{
           {small, {baxter, family::from_elbow, 1, 59}, .013109843, 2e-5},
           {small, {baxter, family::from_wrist, 2, 91}, .068662008, 2e-5},
           {small, {panda, family::from_wrist, 3, 99}, .026795705, 2e-5},
           {small, {baxter, family::near_wrist, 3, 91}, .025577545, 2e-5},
           {small, {baxter, family::from_wrist, 3, 58}, .058522542, 2e-5},
           {small, {baxter, family::from_wrist, 3, 66}, .059509277, 2e-5},
           {small, {baxter, family::near_wrist, 4, 41}, .154043833, 2e-5},
           {small, {baxter, family::from_wrist, 4, 32}, .363484701, 2e-5},
           {"without limits another continuation, which separates much earlier, would go further",
            {baxter, family::from_elbow, 3, 84},
            .010255177,
            2e-4},
           {limit, {baxter, family::from_wrist, 3, 42}, .432702382, 1e-5},
           {limit, {panda, family::from_elbow, 3, 88}, .022216797, 1e-5},
           {led, {iiwa, family::across, 4, 98}, 1, 0},
           {led, {iiwa, family::near_wrist, 4, 74}, 1, 0}}) {
    CAPTURE(each.what);
    CAPTURE(each.which.arm);
    CAPTURE(each.which.number);
    screw path;
    const auto plan = plan_of(redundant_arm()[each.which.arm], each.which, path);
    CHECK((plan.reason == (each.end == 1 ? stop_reason::reached : stop_reason::singular) ||
           (each.what == limit && plan.reason == stop_reason::joint_limit)));
    CHECK(plan.tau.back() >= each.end - each.tolerance);
  }
}

/// A component leaves the limits between points 0.4 apart. The path does not continue beyond 0.605
/// by closed forms at 4000 angles of the elbow, each followed from one 200th of the path to the
/// next.
TEST_CASE("layered_search: detects limits that cut a self-motion component") {
  screw path;
  const auto a = redundant_arm()[iiwa];
  const auto plan = plan_of(a, {iiwa, family::past, 2, 77}, path);
  const auto verdict = duet_test::complete_path_verdict(a.chain, path, plan);
  CHECK(verdict.why == stop_reason::joint_limit);
  CHECK(std::abs(verdict.end - .6043) < 1e-4);
  CHECK(plan.reason == verdict.why);
}

/// Where none of the steps of a search led to its next parameter, what they had reached on the way
/// counted at positive parameters alone: this plan ended 5e-3 too early.
TEST_CASE("the end of a plan does not depend on the first parameter") {
  const auto a = redundant_arm()[panda];
  const auto p = make(a, family::from_wrist, 1, 42);
  const screw path{a.chain.pose(p.start), a.chain.pose(p.end)};
  const auto plan = follow_path(a.chain, p.start, path, 0, 1);
  const auto shifted = follow_path(
      a.chain, p.start, [&](double u) { return path(u + 5); }, -5, -4);
  CHECK(shifted.reason == plan.reason);
  CHECK(std::abs(shifted.tau.back() + 5 - plan.tau.back()) < 1e-5);
}

} // namespace
} // namespace test_robotics_stop_reasons
