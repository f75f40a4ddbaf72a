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

template <int N>
struct planned {
  motion_plan plan;
  duet_test::path_verdict verdict;
};

/// The plan, which keeps to its screw, and what a complete search says.
template <int N>
planned<N> solve(const arm<N>& a, const case_of_bench& which) {
  const auto p = make(a, which.kind, which.seed, which.number);
  const screw path{a.chain.pose(p.start), a.chain.pose(p.end)};
  auto plan = plan_screw_motion(a.chain, p.start, path.last);
  CHECK(duet_test::largest_deviation(a.chain, plan, path) < 1.01e-5);
  const auto verdict = duet_test::complete_path_verdict(a.chain, path, plan);
  return {std::move(plan), verdict};
}
planned<6> solve_six(const case_of_bench& which) { return solve(six_joints()[which.arm], which); }

void check_ends_at_limit(const std::vector<case_of_bench>& all) {
  for (const auto& each : all) {
    CAPTURE(each.arm);
    CAPTURE(each.number);
    const auto [plan, verdict] = solve_six(each);
    CHECK(verdict.why == stop_reason::joint_limit);
    CHECK(plan.reason == verdict.why);
    CHECK(plan.tau.back() > verdict.end - 1e-4);
  }
}

} // namespace

/// Their smallest singular values are 2e-7 to 4e-7.
TEST_CASE("a limit ends a rapid reorientation within a micrometre of a singularity") {
  check_ends_at_limit({{puma, family::past, 1, 27}, {kr, family::near_wrist, 3, 11}});
}

/// Without that limit the joints would go on by 3e-7 of the path.
TEST_CASE("a limit ends the path just before a singularity does") {
  check_ends_at_limit({{mate, family::near_wrist, 3, 53}});
}

/// The self-motion of joints 2, 3, 4 and 6 ends at limits before the continuation begins.
TEST_CASE("limits end the self-motion at the UR5e's singular wrist") {
  check_ends_at_limit({{ur5e, family::from_wrist, 1, 94},
                       {ur5e, family::from_wrist, 2, 9},
                       {ur5e, family::from_wrist, 2, 42},
                       {ur5e, family::from_wrist, 3, 48},
                       {ur5e, family::from_wrist, 3, 72}});
}

/// The plan passes poses that are out of reach by less than its tolerance and ends at a later
/// limit.
TEST_CASE("a plan beyond the end of the exact path reports the reason at its own end") {
  check_ends_at_limit({{kr, family::from_elbow, 3, 33}});
}

/// The elbow, 1.5 milliradians from where it is stretched, may bend to either side.
TEST_CASE("both continuations near a stretched elbow are searched") {
  const auto [plan, verdict] = solve_six({kr, family::near_wrist, 2, 86});
  CHECK(verdict.why == stop_reason::reached);
  CHECK(plan.reason == stop_reason::reached);
}

/// A limit blocks the rapid reorientation, but the tip passes the singularity at a distance
/// of 9.6e-6.
TEST_CASE("a path may pass a singularity within the admissible deviation") {
  CHECK(solve_six({ur5e, family::past, 4, 32}).plan.reason == stop_reason::reached);
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
  const auto panda = robots::panda().table();
  const seven start = (seven() << .3, -.8, .2, -2.1, .1, 1.6, .8).finished();
  // The base rotates by 2u, the ranges of the others are almost zero.
  const auto rotating = [&](double u) {
    return pose(exp(vector3<double>(0, 0, u)), vector3<double>(0, 0, 0)) * panda.pose(start);
  };
  const seven margin = (seven() << .1, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3).finished();
  const auto stopped =
      layered(with_limits(panda, seven(start - margin), seven(start + margin)), rotating, start);
  CHECK(stopped.why == stop_reason::joint_limit);
  CHECK(std::abs(stopped.end - .05) < .005);
  // Outwards, without limits to speak of: as far as the arm reaches.
  const seven range = seven::Constant(3.1);
  const auto far = with_limits(panda, seven(-range), range);
  const auto out = [&](double u) {
    return pose(quaternion<double>(1), vector3<double>(4 * u, 0, 0)) * panda.pose(start);
  };
  const auto ended = layered(far, out, start);
  CHECK(ended.why == stop_reason::singular);
  CHECK(!self_motion_curves(panda, out(ended.end)).empty());
  CHECK(self_motion_curves(panda, out(ended.end + 1e-5)).empty());
}

/// The plan, which keeps to its screw.
motion_plan plan_of(const arm<7>& a, const case_of_bench& which) {
  const auto p = make(a, which.kind, which.seed, which.number);
  const screw path{a.chain.pose(p.start), a.chain.pose(p.end)};
  auto plan = plan_screw_motion(a.chain, p.start, path.last);
  CHECK(duet_test::largest_deviation(a.chain, plan, path) < 1.01e-5);
  return plan;
}
constexpr std::size_t panda = 0, iiwa = 1, baxter = 2;

/// Where the path ends by the complete search, which takes seconds for each: `bench/reasons.cpp`
/// runs it for all of them.
struct known_end {
  case_of_bench which;
  double end;
};

/// Pieces get small there: whole steps of the search end 2e-5 to 2e-4 of the path before.
TEST_CASE("plans of seven joints end within 2e-5 of where the path ends") {
  for (const auto& each : {known_end{{baxter, family::from_elbow, 1, 59}, .013109843},
                           {{baxter, family::from_wrist, 2, 91}, .068662008},
                           {{panda, family::from_wrist, 3, 99}, .026795705},
                           {{baxter, family::near_wrist, 3, 91}, .025577545},
                           {{baxter, family::from_wrist, 3, 58}, .058522542},
                           {{baxter, family::from_wrist, 3, 66}, .059509277},
                           {{baxter, family::near_wrist, 4, 41}, .154043833},
                           {{baxter, family::from_wrist, 4, 32}, .363484701}}) {
    CAPTURE(each.which.arm);
    CAPTURE(each.which.number);
    const auto plan = plan_of(redundant_arm()[each.which.arm], each.which);
    CHECK(plan.reason == stop_reason::singular);
    CHECK(plan.tau.back() > each.end - 2e-5);
  }
}

/// Whole steps of the search end 5e-4 and 4e-3 of the path before.
TEST_CASE("plans of six joints end within 1e-5 of where the path ends") {
  for (const case_of_bench& each :
       {case_of_bench{mate, family::from_wrist, 3, 30}, {kr, family::from_elbow, 4, 74}}) {
    CAPTURE(each.arm);
    const auto [plan, verdict] = solve_six(each);
    CHECK(plan.reason == verdict.why);
    CHECK(plan.tau.back() > verdict.end - 1e-5);
  }
}

/// The exact path ends at a limit, but within the deviation it continues past the singularity: from
/// where full steps of the search end, not from nearer to the singularity, where shorter ones end.
TEST_CASE("following a continuation to its end keeps plans that pass near its end") {
  for (const case_of_bench& each : {case_of_bench{puma, family::past, 2, 59},
                                    {irb, family::past, 2, 1},
                                    {kr, family::past, 2, 62},
                                    {kr, family::past, 2, 72},
                                    {mate, family::past, 3, 56}}) {
    CAPTURE(each.arm);
    CAPTURE(each.number);
    CHECK(solve_six(each).plan.reason == stop_reason::reached);
  }
}

/// Whole steps of the search pass the singularity of the wrist or of the shoulder so near that the
/// joints are led to another side of it.
TEST_CASE("a continuation that steps do not follow is searched with shorter steps") {
  for (const case_of_bench& each :
       {case_of_bench{iiwa, family::across, 4, 98}, {iiwa, family::near_wrist, 4, 74}}) {
    CAPTURE(each.number);
    CHECK(plan_of(redundant_arm()[each.arm], each).reason == stop_reason::reached);
  }
}

/// A component leaves the limits between points 0.4 apart. The path does not continue beyond 0.605
/// by closed forms at 4000 angles of the elbow, each followed from one 200th of the path to the
/// next.
TEST_CASE("layered_search: detects limits that cut a self-motion component") {
  const auto [plan, verdict] = solve(redundant_arm()[iiwa], {iiwa, family::past, 2, 77});
  CHECK(verdict.why == stop_reason::joint_limit);
  CHECK(std::abs(verdict.end - .6043) < 1e-4);
  CHECK(plan.reason == verdict.why);
}

/// Without limits the path would continue by 4e-5 and 2e-5.
TEST_CASE("limits end a path less than 1e-4 before a singularity would") {
  for (const auto& each : {known_end{{baxter, family::from_wrist, 3, 42}, .432702382},
                           {{panda, family::from_elbow, 3, 88}, .022216797}}) {
    CAPTURE(each.which.number);
    const auto plan = plan_of(redundant_arm()[each.which.arm], each.which);
    CHECK((plan.reason == stop_reason::singular || plan.reason == stop_reason::joint_limit));
    CHECK(plan.tau.back() > each.end - 1e-5);
  }
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

/// Without limits another continuation, which separates much earlier, would go further.
TEST_CASE("a path of the Baxter ends where no self-motion continues it, with or without limits") {
  const auto plan = plan_of(redundant_arm()[baxter], {baxter, family::from_elbow, 3, 84});
  CHECK(plan.reason == stop_reason::singular);
  CHECK(plan.tau.back() > .010255177 - 2e-4);
}

} // namespace test_robotics_stop_reasons
