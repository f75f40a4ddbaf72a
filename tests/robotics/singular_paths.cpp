// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "../../src/robotics/planning_model.hpp"
#include "robotics/chains.hpp"
#include "robotics/complete_search.hpp"
#include "robotics/paths.hpp"
#include "robotics/singular_problems.hpp"

#include <duet/kinematics/adapted.hpp>
#include <duet/kinematics/chain_parameters.hpp>
#include <duet/robotics/plan_screw_motion.hpp>

namespace test_robotics_singular_paths {
namespace {

using namespace duet;
using chain = serial_chain<6>;
using vector = duet_test::coordinates<6>;
using singular_problems::screw;

const chain ur5e = robots::ur5e().table();

const chain limited_puma = singular_problems::six_joints()[1].chain;
const vector unlimited = vector::Constant(std::numeric_limits<double>::infinity());
const chain puma = with_limits(limited_puma, vector(-unlimited), unlimited);

vector configuration(duet_test::random_source& random, double max_angle) {
  vector theta;
  for (int i = 0; i < 6; ++i) {
    theta[i] = random.uniform(-max_angle, max_angle);
  }
  return theta;
}
vector nearby(const vector& theta, duet_test::random_source& random, double max_angle) {
  return theta + configuration(random, max_angle);
}

/// Along the screw to the pose of `end`.
motion_plan plan_to(const chain& arm, const vector& start, const vector& end) {
  return plan_screw_motion(arm, start, arm.pose(end));
}
double worst(const chain& arm, const motion_plan& plan, const vector& end) {
  return duet_test::deviation_from_screw(arm, plan, arm.pose(end));
}

/// Checks that the screw from one configuration's pose to that of another is followed.
template <int N>
void check_reached(const serial_chain<N>& arm, const duet_test::coordinates<N>& start,
                   const duet_test::coordinates<N>& end) {
  const auto plan = plan_screw_motion(arm, start, arm.pose(end));
  CHECK(plan.reason == stop_reason::reached);
  CHECK(plan.joints.front() == start);
  CHECK(std::is_sorted(plan.tau.begin(), plan.tau.end()));
  CHECK(plan.tau.back() == 1);
  CHECK(duet_test::largest_deviation(arm, plan, screw{arm.pose(start), arm.pose(end)}) < 1.1e-5);
}

double smallest_singular_value(const chain& arm, const vector& theta) {
  const detail::planning_model<8> model(arm);
  return detail::smallest_singular_value_of(model.at(model.joints(theta)).jacobian);
}

TEST_CASE("joints 4 and 6 reorient rapidly on a path near the wrist singularity") {
  duet_test::random_source random(2);
  for (int k = 0; k < 5; ++k) {
    vector start = configuration(random, 1);
    start[4] = .5;
    vector end = nearby(start, random, 1e-3);
    end[4] = -.5;
    check_reached(puma, start, end);
    // With limits that leave no room for the swing it stops there.
    vector lower = vector::Constant(-10), upper = vector::Constant(10);
    lower[3] = start[3] - .3;
    upper[3] = start[3] + .3;
    const chain narrow = with_limits(puma, lower, upper);
    const auto plan = plan_to(narrow, start, end);
    CHECK(plan.reason == stop_reason::joint_limit);
    CHECK(plan.tau.back() < .51);
    CHECK(worst(narrow, plan, end) < 1.1e-5);
  }
}

TEST_CASE("plans leave a stretched elbow inwards and not outwards") {
  duet_test::random_source random(3);
  for (int k = 0; k < 6; ++k) {
    vector start = configuration(random, 1);
    start[2] = 0;
    start[4] = 1 + .3 * start[4];
    const auto t = random.direction<3>();
    const Eigen::Vector3d stretch =
        translation(ur5e.pose(start, 2)) - translation(ur5e.pose(start, 1));
    const Eigen::Vector3d displacement = .01 * Eigen::Vector3d(t[0], t[1], t[2]) - .25 * stretch;
    const auto goal = pose(quaternion<double>(1), displacement) * ur5e.pose(start);
    const auto inwards = plan_screw_motion(ur5e, start, goal);
    CHECK(inwards.reason == stop_reason::reached);
    CHECK(std::abs(inwards.joints.back()[2]) > .1);
    CHECK(duet_test::deviation_from_screw(ur5e, inwards, goal) < 1.1e-5);
    const auto outwards = plan_screw_motion(
        ur5e, start,
        pose(quaternion<double>(1), Eigen::Vector3d(-displacement)) * ur5e.pose(start));
    CHECK(
        (outwards.reason == stop_reason::singular || outwards.reason == stop_reason::out_of_reach));
    CHECK(outwards.tau.back() < 1e-3);
  }
}

/// A path that leads to the singular pose can be followed backwards, except for self-motions that
/// limits cut off; the arms have no such limits here.
TEST_CASE("plans leave the wrist singularity whenever a path back to it exists") {
  duet_test::random_source random(4);
  int count = 0;
  for (const chain& arm : {ur5e, puma}) {
    for (int k = 0; k < 6; ++k) {
      vector start = configuration(random, 1.5);
      start[2] += start[2] > 0 ? .4 : -.4;
      start[4] = 0;
      vector end = nearby(start, random, .4);
      if (plan_to(arm, end, start).reason == stop_reason::reached) {
        check_reached(arm, start, end);
        ++count;
      }
    }
  }
  CHECK(count >= 8);
}

TEST_CASE("escape_direction: increases the smallest singular value fastest") {
  duet_test::random_source random(5);
  const detail::planning_model<8> model(puma);
  for (int k = 0; k < 5; ++k) {
    vector theta = configuration(random, 1);
    theta[2] += 1.5;
    theta[4] = 0;
    const auto at = model.at(model.joints(theta));
    const vector out =
        detail::to_chain_joints(puma, detail::singular_point(at.jacobian).escape_direction());
    CHECK(out.norm() == doctest::Approx(1));
    CHECK(std::abs(out[4]) == doctest::Approx(1)); // all axes but that of joint 5 go on meeting
    const double h = 1e-3, singular_value = smallest_singular_value(puma, theta + h * out);
    CHECK(singular_value > 1e-3 * h);
    CHECK(smallest_singular_value(puma, theta) < 1e-6);
    for (int trial = 0; trial < 5; ++trial) {
      const vector other = configuration(random, 1).normalized();
      CHECK(smallest_singular_value(puma, theta + h * other) < singular_value * (1 + 1e-2));
    }
  }
}

/// For a general arm w and n are unique, and the escape direction is the gradient of the
/// determinant.
TEST_CASE("escape_direction: is the gradient of the determinant by dual numbers") {
  const chain general = from_dh(std::array<dh_row<>, 6>{{{.a = .3, .d = .1, .alpha = .7},
                                                         {.a = .5, .d = -.2, .alpha = -1.1},
                                                         {.a = .2, .d = .3, .alpha = 1.3},
                                                         {.a = -.4, .d = .2, .alpha = -.6},
                                                         {.a = .1, .d = -.3, .alpha = .9},
                                                         {.a = .2, .d = .1, .alpha = .4}}});
  const auto determinant = [&](const auto& theta) {
    return Eigen::Matrix<std::decay_t<decltype(theta[0])>, 6, 6>(
               jacobian(general, theta, frame::hybrid))
        .determinant();
  };
  const detail::planning_model<8> model(general);
  duet_test::random_source random(7);
  int count = 0;
  for (int k = 0; k < 20; ++k) {
    vector low = configuration(random, 2), high = configuration(random, 2);
    if (determinant(low) * determinant(high) > 0) {
      continue;
    }
    ++count;
    for (int i = 0; i < 60; ++i) {
      const vector midpoint = (low + high) / 2;
      (determinant(low) * determinant(midpoint) > 0 ? low : high) = midpoint;
    }
    const auto at = model.at(model.joints(low));
    const vector out =
        detail::to_chain_joints(general, detail::singular_point(at.jacobian).escape_direction());
    const vector determinant_gradient = gradient(determinant, low).gradient.normalized();
    CHECK(std::abs(out.dot(determinant_gradient)) == doctest::Approx(1).epsilon(1e-6));
  }
  CHECK(count >= 5);
}

TEST_CASE("plans with prismatic joints do not depend on the unit of length") {
  const auto& stanford = duet_test::stanford_arm;
  for (const double unit : {1024., 1000.}) {
    const bool is_exact = unit == 1024;
    const chain metres = stanford(1), other = stanford(unit);
    duet_test::random_source random(6);
    int reached = 0;
    for (int k = 0; k < 10; ++k) {
      vector start = configuration(random, 1.4), end = nearby(start, random, .3);
      start[2] = random.uniform(.31, 1.2);
      end[2] = random.uniform(.31, 1.2);
      end[4] = std::clamp(end[4], -1.5, 1.5);
      const auto scaled = [&](vector x) {
        x[2] *= unit;
        return x;
      };
      const auto x = plan_screw_motion(metres, start, metres.pose(end),
                                       {.tolerance = {1e-6, 1e-7}, .deviation = {1e-5, 1e-6}});
      const auto y =
          plan_screw_motion(other, scaled(start), other.pose(scaled(end)),
                            {.tolerance = {1e-6 * unit, 1e-7}, .deviation = {1e-5 * unit, 1e-6}});
      reached += x.reason == stop_reason::reached;
      CHECK(x.reason == y.reason);
      REQUIRE(x.joints.size() == y.joints.size());
      CHECK(x.iterations == y.iterations);
      CHECK(y.joints.front() == scaled(start));
      for (std::size_t i = 0; i < x.joints.size(); ++i) {
        const double difference =
            (scaled(x.joints[i]) - y.joints[i]).cwiseAbs().maxCoeff() / (is_exact ? 1 : unit);
        CHECK(difference <= (is_exact ? 0 : 1e-6));
      }
    }
    CHECK(reached >= 5);
  }
}

/// Joints 2, 3, 4 and 6 swing by several radians within a ten thousandth of the path.
TEST_CASE("the UR5e passes its wrist singularity by a rapid reorientation") {
  duet_test::random_source random(8);
  int reached = 0;
  for (int k = 0; k < 12; ++k) {
    vector start = configuration(random, 2);
    start[4] = random.uniform(.3, 1.5);
    vector end = nearby(start, random, k % 2 == 0 ? 1e-3 : 1e-4);
    end[4] = -start[4];
    const screw path{ur5e.pose(start), ur5e.pose(end)};
    const auto verdict = duet_test::complete_search(ur5e, path)(start);
    const auto plan = plan_to(ur5e, start, end);
    CHECK((plan.reason == stop_reason::reached) == (verdict.why == stop_reason::reached));
    reached += plan.reason == stop_reason::reached;
    CHECK(worst(ur5e, plan, end) < 1.1e-5);
  }
  CHECK(reached >= 4);
}

TEST_CASE("plans stop only where all solutions end, with the same reason") {
  duet_test::random_source random(9);
  const chain narrow =
      with_limits(puma, vector(vector::Constant(-2.5)), vector(vector::Constant(2.5)));
  int joint_limit = 0, singular = 0;
  for (const chain& arm : {ur5e, narrow}) {
    for (int k = 0; k < 30; ++k) {
      vector start = configuration(random, 2);
      vector end = nearby(start, random, .5);
      if (k % 3 == 0) {
        end = start;
        end[4] = -start[4] + random.uniform(-.01, .01);
        end[3] += .01;
      } else if (k % 3 == 1) {
        start[2] = arm.limits(2).upper > 3 ? 0 : start[2]; // the UR5e's elbow is stretched
      }
      const screw path{arm.pose(start), arm.pose(end)};
      const auto verdict = duet_test::complete_search(arm, path)(start);
      const auto plan = plan_to(arm, start, end);
      CAPTURE(k);
      CHECK(plan.reason == verdict.why);
      CHECK(plan.tau.back() > verdict.end - 1e-4);
      joint_limit += plan.reason == stop_reason::joint_limit;
      singular += plan.reason == stop_reason::singular;
    }
  }
  CHECK(joint_limit >= 5);
  CHECK(singular >= 5);
}

/// A stretched elbow bends by ±s n, and that moves the tip inwards by s². Beside that it bends to
/// the one side as it is asked to, and to the other by as much more as it is bent.
TEST_CASE("singular_point: steps_for bends a stretched elbow by the right angle") {
  const detail::planning_model<8> model(ur5e);
  duet_test::random_source random(10);
  for (int k = 0; k < 5; ++k) {
    vector theta = configuration(random, 1);
    theta[2] = 0;
    theta[4] = 1 + .3 * theta[4];
    const auto stretched = model.at(model.joints(theta));
    const auto n = detail::self_motion_space(stretched.jacobian).any_direction();
    for (const double bent : {0., .002, -.001}) {
      const auto at = model.at(stretched.theta + bent * n);
      const detail::singular_point singular(at.jacobian);
      for (const double bend : {.01, -.02}) {
        const auto e = detail::error_twist(at.tip, model.at(at.theta + bend * n).tip);
        const auto [first, second] = singular.steps_for(e);
        const double near = first.dot(n) * bend > 0 ? first.dot(n) : second.dot(n);
        const double far = (first + second).dot(n) - near;
        CHECK(std::abs(near - bend) < .05 * std::abs(bend));
        CHECK(std::abs(far + bend + 2 * bent) < .1 * std::abs(bend));
        const auto [none, no_other] = singular.steps_for(-1 * e);
        CHECK(none.norm() == 0);
        CHECK(no_other.norm() == 0);
      }
    }
  }
}

using seven = duet_test::coordinates<7>;

TEST_CASE("orientation: is constant along a self-motion curve") {
  const auto arm = robots::panda().table();
  const detail::planning_model<8> model(arm);
  duet_test::random_source random(11);
  for (int k = 0; k < 5; ++k) {
    seven start;
    for (int i = 0; i < 7; ++i) {
      start[i] = random.uniform(-1, 1) - (i == 3 ? 1.5 : 0);
    }
    auto at = model.at(model.joints(start));
    auto n = detail::self_motion_space(at.jacobian).any_direction();
    const double first = detail::orientation(at.jacobian, n);
    CHECK(detail::orientation(at.jacobian, -1 * n) == -first);
    for (int step = 0; step < 300; ++step) {
      at = model.at(at.theta + .005 * n);
      n = detail::self_motion_space(at.jacobian).direction(n);
      CHECK(n.norm() == doctest::Approx(1));
      CHECK(detail::orientation(at.jacobian, n) == first);
      Eigen::Matrix<double, 7, 7> square;
      square << jacobian(arm, seven(detail::to_chain_joints(arm, at.theta)), frame::hybrid),
          detail::to_chain_joints(arm, n).transpose();
      CHECK(square.determinant() * first > 0);
    }
  }
}

/// Each problem has a solution, by Newton's method from its end and a self-motion to its start.
TEST_CASE("seven joints stay on their self-motion curve where another comes near") {
  const auto panda = robots::panda().table(), iiwa = robots::iiwa14().table(),
             baxter = robots::baxter_left().table();
  check_reached(panda, seven(2.094, .452, -1.599, -2.326, -1.616, 3.068, -1.331),
                seven(1.786, -.452, -1.55, -2.82, -1.93, 3.377, -1.477));
  check_reached(panda, seven(2.28538, -1.22115, -1.159, -.80361, -2.1876, 3.10306, .66382),
                seven(2.28549, 1.22115, -1.15898, -.80359, -2.18752, 3.10312, .66381));
  check_reached(iiwa, seven(1.8445, -.7148, .9794, -.8978, 1.6857, .7854, 1.8321),
                seven(1.8442, -.7148, .9796, -.8983, 1.6854, -.7854, 1.832));
  check_reached(baxter, seven(.45, -.13, -.94, .7, 1.49, -.68, -1.7),
                seven(.45, -.13, -.94, .7, 1.49, .68, -1.7));
}

/// By a complete search each problem has a solution with the elbow on one side only.
TEST_CASE("plans leave a stretched elbow near the wrist singularity on the feasible side") {
  check_reached(limited_puma, vector(-.45793, -.9896, -1.52382, -.53564, -.07137, 1.25488),
                vector(-.27789, -1.37498, -1.56042, -.86047, .16358, .91994));
  check_reached(limited_puma, vector(-.99518, -1.36755, -1.52382, -.98997, -.11179, 2.14885),
                vector(-.70383, -1.57117, -1.38841, -.54673, .13715, 2.33595));
  check_reached(limited_puma, vector(1.9469, -2.4579, -1.5238, -1.0966, .1102, -2.5373),
                vector(1.9115, -2.4834, -1.1631, -.8743, -.2154, -2.6595));
}

/// Both verdicts are checked: a path with a continuation and one without.
TEST_CASE("complete_search: verdict for paths with known results") {
  const vector theta = (vector() << .3, -1.1, 1.4, -.5, .9, .2).finished();
  const auto rotating = [&](double u) {
    return pose(exp(vector3<double>(0, 0, u)), vector3<double>(0, 0, 0)) * ur5e.pose(theta);
  };
  CHECK(duet_test::complete_search(ur5e, rotating)(theta).why == stop_reason::reached);
  // The base rotates by 2u.
  const chain limited = with_limits(ur5e, 0, {-1, theta[0] + .5});
  const auto stopped = duet_test::complete_search(limited, rotating)(theta);
  CHECK(stopped.why == stop_reason::joint_limit);
  CHECK(stopped.end == doctest::Approx(.25).epsilon(1e-6));
  const auto out = [&](double u) {
    return pose(quaternion<double>(1), vector3<double>(2 * u, 0, 0)) * ur5e.pose(theta);
  };
  const auto ended = duet_test::complete_search(ur5e, out)(theta);
  CHECK(ended.why == stop_reason::singular);
  CHECK(!all_inverse_kinematics(ur5e, out(ended.end)).solutions.empty());
  CHECK(all_inverse_kinematics(ur5e, out(ended.end + 1e-6)).solutions.size() <
        all_inverse_kinematics(ur5e, out(ended.end - 1e-3)).solutions.size());
}

} // namespace
} // namespace test_robotics_singular_paths
