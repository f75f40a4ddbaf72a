// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "robotics/chains.hpp"
#include "support/message.hpp"
#include "support/multiprecision.hpp"

#include <duet/duet.hpp>
#include <duet/robotics.hpp>

namespace test_robotics_wanted_solution {
namespace {

using namespace duet;
using chain = duet_test::any_chain;
using vector = duet_test::any_joints;
using duet_test::configuration;
using duet_test::is_within_limits;
using std::numbers::pi;

/// Known arms and one with all kinds of joints.
std::vector<chain> arms() {
  auto result = duet_test::known_arms();
  result.push_back(duet_test::every_joint());
  return result;
}

vector nearby(const chain& arm, vector theta, double max_change, duet_test::random_source& random) {
  for (int i = 0; i < arm.size(); ++i) {
    theta[i] = std::clamp(theta[i] + random.uniform(-max_change, max_change), arm.limits(i).lower,
                          arm.limits(i).upper);
  }
  return theta;
}

/// Distance of the tip from a position, in 50 digits.
double distance(const chain& arm, const Eigen::VectorXd& theta, const vector3<double>& p) {
  using duet_test::real_50;
  const Eigen::Matrix<real_50, Eigen::Dynamic, 1> exact = theta.cast<real_50>();
  return double((translation(arm.pose(exact)) - p.cast<real_50>()).norm());
}

/// Norm of the gradient projected onto the motions with the tip at a fixed position and joints
/// within limits: zero at a local minimum. Active limits are identified by the sign, too.
double projected_gradient(const chain& arm, const vector& theta, vector gradient) {
  std::vector<vector> active_rows;
  const auto j = jacobian(arm, theta, frame::hybrid);
  const auto hold = [&](vector row) {
    for (int twice = 0; twice < 2; ++twice) {
      for (const vector& other : active_rows) {
        row -= other.dot(row) * other;
      }
    }
    if (row.norm() > 1e-6) {
      active_rows.push_back(row / row.norm());
    }
  };
  for (int i = 0; i < 3; ++i) {
    hold(j.row(i).transpose());
  }
  for (int i = 0; i < arm.size(); ++i) {
    if (std::min(theta[i] - arm.limits(i).lower, arm.limits(i).upper - theta[i]) < 1e-7) {
      hold(vector::Unit(arm.size(), i));
    }
  }
  for (const vector& row : active_rows) {
    gradient -= row.dot(gradient) * row;
  }
  return gradient.norm();
}

/// The chain's bodies: a capsule along each link but the first two.
scene bodies(const chain& arm) {
  scene result;
  for (int i = 3; i <= arm.size(); ++i) {
    result.bodies.push_back({i, {vector3<double>(0, 0, 0), vector3<double>(0, 0, .1), .05}});
  }
  result.margin = .02;
  return result;
}

/// Spheres that leave one configuration alone: at joints of another, and anywhere.
void put_spheres(scene& around, const chain& arm, const vector& known, const vector& other,
                 duet_test::random_source& random) {
  around.obstacles.clear();
  for (int i = 3; i < arm.size() + 6; ++i) {
    const auto x = [&](double lower, double upper) { return random.uniform(lower, upper); };
    const vector3<double> at = i < arm.size() ? vector3<double>(translation(arm.pose(other, i)))
                                              : vector3<double>(x(-.8, .8), x(-.8, .8), x(0, 1.2));
    around.obstacles.push_back(sphere<double>{at, x(.05, .2)});
    if (clearance(arm, known, around).distance < around.margin) {
      around.obstacles.pop_back();
    }
  }
}

TEST_CASE(
    "preferred_posture: the result is a local minimum and not worse than the known solution") {
  duet_test::random_source random(81);
  const auto all = arms();
  for (const chain& arm : all) {
    CAPTURE(&arm - all.data());
    int solved = 0, flat = 0;
    for (int k = 0; k < 10; ++k) {
      const vector known = configuration(arm, random);
      const vector3<double> p = translation(arm.pose(known));
      const preferred_posture preference{nearby(arm, known, .4, random)};
      const auto found =
          inverse_kinematics(arm, position_goal(p), preference.posture, {}, preference);
      CHECK(is_within_limits(arm, found.joints));
      solved += found.reason == stop_reason::reached && distance(arm, found.joints, p) < 1e-6 &&
                preference(found.joints) <= preference(known);
      flat += projected_gradient(arm, found.joints, preference.gradient(found.joints)) < 1e-6;
    }
    CHECK(solved == 10);
    CHECK(flat == 10);
  }
}

TEST_CASE("objective: the best branch of a pose is found, with derivatives by dual numbers") {
  // The last three joints as small as possible; without a member gradient.
  const auto preference = [](const auto& theta) {
    using std::cos;
    std::decay_t<decltype(theta[0])> sum(0);
    for (Eigen::Index i = 3; i < 6; ++i) {
      sum += 1 - cos(theta[i]);
    }
    return sum;
  };
  duet_test::random_source random(82);
  for (const chain& arm : {chain(robots::ur5e().table()), chain(robots::iiwa14().table())}) {
    int better = 0, solved = 0;
    for (int k = 0; k < 10; ++k) {
      const vector known = configuration(arm, random), start = configuration(arm, random);
      const auto goal = arm.pose(known);
      const auto found = inverse_kinematics(arm, goal, start, {.candidates = 20}, preference);
      const auto deviation = pose_error_between(arm.pose(found.joints), goal);
      solved += found.reason == stop_reason::reached &&
                deviation.translation <= 1e-6 * (1 + 1e-9) &&
                deviation.rotation <= 1e-6 * (1 + 1e-9) && is_within_limits(arm, found.joints);
      better += preference(found.joints) <= preference(known) + 1e-6;
      CHECK(preference(found.joints) <=
            preference(inverse_kinematics(arm, goal, start).joints) + 1e-6);
    }
    CHECK(solved == 10);
    CHECK(better >= 9); // another branch may have been missed
  }
}

TEST_CASE("objective: minimum at the boundary or in the interior of a region") {
  const chain arm = robots::iiwa14().table();
  const vector start = (vector(7) << .3, .6, -.2, -1.3, .4, .9, .1).finished();
  const vector3<double> p = translation(arm.pose(start));
  auto box = position_goal(p);
  box.lower = {-.1, -.1, -.1};
  box.upper = {.1, .1, .1};
  const auto height = [&](const auto& theta) { return translation(arm.pose(theta))[2]; };
  const auto low = inverse_kinematics(arm, box, start, {}, height);
  CHECK(low.reason == stop_reason::reached);
  CHECK(height(low.joints) - p[2] == doctest::Approx(-.1).epsilon(1e-4));
  // Inside the box no bound is active.
  const auto distance_to_centre = [&](const auto& theta) {
    return (translation(arm.pose(theta)) - (p + vector3<double>(.02, -.03, .01))).squaredNorm();
  };
  const auto inside = inverse_kinematics(arm, box, start, {}, distance_to_centre);
  CHECK(inside.reason == stop_reason::reached);
  CHECK(distance_to_centre(inside.joints) < 1e-8);
}

TEST_CASE("with_limits_about: solutions stay within the bounds about the start") {
  duet_test::random_source random(83);
  for (const chain& arm : arms()) {
    int solved = 0;
    for (int k = 0; k < 40; ++k) {
      const vector known = configuration(arm, random);
      vector max_change(arm.size());
      for (double& x : max_change) {
        x = random.uniform(.01, .5);
      }
      vector start = known;
      for (int i = 0; i < arm.size(); ++i) {
        start[i] = std::clamp(known[i] + random.uniform(-max_change[i], max_change[i]),
                              arm.limits(i).lower, arm.limits(i).upper);
      }
      const auto goal = arm.pose(known);
      const auto found = inverse_kinematics(with_limits_about(arm, start, max_change), goal, start);
      const auto deviation = pose_error_between(arm.pose(found.joints), goal);
      const double rounding = 1e-14;
      solved += found.reason == stop_reason::reached && deviation.translation <= 1.001e-6 &&
                ((found.joints - start).cwiseAbs() - max_change).maxCoeff() <= rounding &&
                is_within_limits(arm, found.joints);
    }
    CHECK(solved == 40);
  }
  // A goal beyond the bounds is reported as such.
  const chain panda = robots::panda().table();
  const vector start = (vector(7) << 0, -.8, 0, -2.4, 0, 1.6, .8).finished();
  vector distant = start;
  distant[0] += .6;
  const auto bounded = with_limits_about(panda, start, vector(vector::Constant(7, .1)));
  CHECK(
      inverse_kinematics(bounded, position_goal(translation(panda.pose(distant))), start).reason ==
      stop_reason::joint_limit);
}

TEST_CASE("inverse_kinematics: solutions among obstacles respect the margin") {
  duet_test::random_source random(84);
  const auto all = arms();
  int without = 0;
  for (const chain& arm : all) {
    CAPTURE(&arm - all.data());
    scene around = bodies(arm);
    int solved = 0;
    for (int k = 0; k < 8; ++k) {
      const vector known = configuration(arm, random), start = configuration(arm, random);
      const auto goal = arm.pose(known);
      const vector3<double> z(0, 0, 1), p = translation(goal);
      const auto pointing = position_and_pointing_goal(p, z, rotate(rotation(goal), z));
      const vector free = inverse_kinematics(arm, pointing, start).joints;
      put_spheres(around, arm, known, free, random);
      const auto one = inverse_kinematics(arm, goal, start, {}, no_objective{}, around);
      const auto two = inverse_kinematics(arm, pointing, start, {}, no_objective{}, around);
      const auto three = inverse_kinematics(arm, position_goal(p), start, {.candidates = 2},
                                            preferred_posture{known}, around);
      for (const auto& found : {one, two, three}) {
        solved += found.reason == stop_reason::reached && distance(arm, found.joints, p) < 1.1e-6 &&
                  clearance(arm, found.joints, around).distance >= around.margin - 1e-6 &&
                  is_within_limits(arm, found.joints);
      }
      without += clearance(arm, free, around).distance < around.margin;
    }
    CHECK(solved == 24);
  }
  CHECK(without > 10); // else it was no test
}

TEST_CASE("inverse_kinematics: a solution too close to an obstacle is moved without a restart") {
  const chain arm = robots::panda().table();
  const vector start = (vector(7) << .1, -.4, .2, -2, .1, 1.7, .6).finished();
  scene around;
  around.margin = .05;
  around.bodies = {{4, {vector3<double>(0, 0, 0), vector3<double>(0, 0, 0), .05}}};
  const vector3<double> elbow = translation(arm.pose(start, 4));
  for (const double side : {-1., 1.}) {
    around.obstacles = {sphere<double>{elbow + vector3<double>(0, .12 * side, 0), .05}};
    CHECK(clearance(arm, start, around).distance == doctest::Approx(.02));
    const auto goal = arm.pose(start);
    const auto found =
        inverse_kinematics(arm, goal, start, {.max_restarts = 0}, no_objective{}, around);
    CHECK(found.reason == stop_reason::reached);
    CHECK(clearance(arm, found.joints, around).distance >= .05 - 1e-6);
    CHECK((found.joints - start).norm() < .5);
    CHECK(distance(arm, found.joints, translation(goal)) < 1e-6);
  }
}

TEST_CASE("inverse_kinematics: a goal inside an obstacle reports obstacle") {
  const chain arm = robots::ur5e().table();
  const vector known = (vector(6) << .3, -1.1, 1.4, -.5, .9, .2).finished();
  scene around = bodies(arm);
  const auto goal = arm.pose(known);
  around.obstacles = {sphere<double>{translation(goal), .2}};
  const auto found =
      inverse_kinematics(arm, goal, known, {.max_restarts = 20}, no_objective{}, around);
  CHECK(found.reason == stop_reason::obstacle);
  CHECK(found.restarts == 20);
  CHECK(found.deviation.translation <= 1e-6);
  // A goal out of reach is reported with or without obstacles, with the nearest pose.
  const auto far = pose(quaternion<double>(1), vector3<double>(3, 0, 0));
  const auto beyond =
      inverse_kinematics(arm, far, known, {.max_restarts = 2}, no_objective{}, around);
  CHECK(beyond.reason == stop_reason::out_of_reach);
  CHECK(beyond.joints == inverse_kinematics(arm, far, known, {.max_restarts = 2}).joints);
}

TEST_CASE("objective: revolute joints move by full turns that lower it") {
  const chain arm = robots::ur5e().table();
  const vector known = (vector(6) << 3, -1.1, 1.4, -.5, .9, -3).finished();
  vector preference = known;
  preference[0] -= 2 * pi;
  preference[5] += 2 * pi;
  const auto found = inverse_kinematics(arm, arm.pose(known), known, {.candidates = 1},
                                        preferred_posture{preference});
  CHECK(found.reason == stop_reason::reached);
  CHECK((found.joints - preference).cwiseAbs().maxCoeff() < 1e-5);
}

/// Smallest value of a preferred posture among all solutions, with any full turns within limits.
double min_preference(const chain& arm, const dual_quaternion<double>& goal,
                      const vector& posture) {
  double minimum = std::numeric_limits<double>::infinity();
  for (const auto& each : all_inverse_kinematics(arm, goal).solutions) {
    double sum = 0;
    for (int i = 0; i < 6; ++i) {
      double nearest = std::numeric_limits<double>::infinity();
      for (int full_turns = -3; full_turns <= 3; ++full_turns) {
        const double x = each.joints[i] + 2 * pi * full_turns, d = x - posture[i];
        if (x >= arm.limits(i).lower - 1e-9 && x <= arm.limits(i).upper + 1e-9) {
          nearest = std::min(nearest, d * d);
        }
      }
      sum += nearest / 2;
    }
    minimum = std::min(minimum, sum);
  }
  return minimum;
}

TEST_CASE("preferred_posture: nearest of all six-joint solutions, including full turns") {
  duet_test::random_source random(88);
  const chain ur5e = robots::ur5e().table();
  const vector far = vector::Constant(6, 3 * pi);
  for (const chain& arm : {ur5e, chain(with_limits(ur5e, vector(-far), far))}) {
    int nearest = 0;
    const int count = 60;
    for (int k = 0; k < count; ++k) {
      vector known = configuration(arm, random), posture = configuration(arm, random);
      if (k % 3 == 0) { // multiples of 15 degrees, except at the wrist's singularity
        known = known.unaryExpr([](double x) { return pi / 12 * std::round(12 / pi * x); });
        posture = posture.unaryExpr([](double x) { return pi / 2 * std::round(2 / pi * x); });
        known[4] = known[4] < 0 ? -pi / 3 : pi / 3;
        known[2] = known[2] < 0 ? -pi / 3 : pi / 3;
      }
      const preferred_posture preference{posture};
      const auto goal = arm.pose(known);
      const auto found = inverse_kinematics(arm, goal, posture, {}, preference);
      CHECK(is_within_limits(arm, found.joints));
      nearest += found.reason == stop_reason::reached &&
                 preference(found.joints) <= min_preference(arm, goal, posture) + 1e-6;
    }
    CHECK(nearest == count);
  }
}

TEST_CASE("preferred_posture: a solution at a limit, several full turns away") {
  const chain ur5e = robots::ur5e().table();
  vector known = (vector(6) << .3, -1.1, 1.4, -.5, .9, .2).finished();
  vector lower = vector::Constant(6, -2 * pi), upper = vector::Constant(6, 2 * pi);
  lower[0] = known[0] + 4 * pi; // the only turn, at the limit
  upper[0] = lower[0] + 1;
  lower[5] = -std::numeric_limits<double>::infinity();
  upper[5] = std::numeric_limits<double>::infinity();
  const chain arm = with_limits(ur5e, lower, upper);
  vector preference = known;
  preference[0] += 4 * pi;
  preference[5] += 22 * pi;
  const auto found =
      inverse_kinematics(arm, ur5e.pose(known), preference, {}, preferred_posture{preference});
  CHECK(found.reason == stop_reason::reached);
  CHECK((found.joints - preference).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("solutions with prismatic joints do not depend on the unit of length") {
  const auto& stanford = duet_test::stanford_arm;
  const auto solution = [&](double unit, int k) {
    const chain arm = stanford(unit);
    duet_test::random_source random(86 + std::uint64_t(k));
    vector known = configuration(stanford(1), random), start = configuration(stanford(1), random);
    known[2] *= unit;
    start[2] *= unit;
    const auto squares = [&](const auto& x) {
      auto sum = (x[2] - known[2]) * (x[2] - known[2]) / (unit * unit);
      for (const int i : {0, 1, 3, 4, 5}) {
        sum += x[i] * x[i];
      }
      return sum;
    };
    const vector3<double> z(0, 0, 1);
    const auto tip = arm.pose(known);
    auto goal = position_and_pointing_goal(translation(tip), z, rotate(rotation(tip), z));
    goal.upper[0] = .05 * unit;
    scene around;
    around.margin = .03 * unit;
    around.influence_distance_offset = .3 * unit;
    around.bodies = {{5, {vector3<double>(0, 0, 0), vector3<double>(0, 0, 0), .04 * unit}}};
    around.obstacles = {
        sphere<double>{translation(tip) + unit * vector3<double>(.05, .1, 0), .05 * unit}};
    // The distance of a point near the tip, and the angle to the vector from the base to the tip.
    const auto features = [&](const auto& a) {
      using S = std::decay_t<decltype(translation(a)[0])>;
      const vector3<S> p = translation(a), y(S(0), S(.3 * unit), S(0)), axis(S(0), S(0), S(1));
      return std::array<S, 2>{(p + rotate(rotation(a), y)).norm(),
                              rotate(rotation(a), axis).dot(p) / p.norm()};
    };
    const auto required = features(tip);
    const equation_goal equations{[&](const auto& a) {
      const auto value = features(a);
      using S = std::decay_t<decltype(value[0] - required[0])>;
      return std::array<S, 6>{value[0] - required[0], S(0), S(0),
                              value[1] - required[1], S(0), S(0)};
    }};
    const inverse_kinematics_options options{.tolerance = {1e-6 * unit, 1e-6}};
    auto found = k % 2 == 0 ? inverse_kinematics(arm, goal, start, options, squares, around)
                            : inverse_kinematics(arm, equations, start, options, squares);
    found.joints[2] /= unit;
    found.deviation.translation /= unit;
    return found;
  };
  int reached = 0;
  for (int k = 0; k < 10; ++k) {
    const auto x = solution(1, k), same = solution(1024, k), close = solution(1000, k);
    reached += x.reason == stop_reason::reached;
    CHECK(x.reason == same.reason);
    CHECK(x.joints == same.joints);
    CHECK(x.deviation.translation == same.deviation.translation);
    CHECK(x.iterations == same.iterations);
    CHECK(x.reason == close.reason);
    CHECK((x.joints - close.joints).cwiseAbs().maxCoeff() < 1e-5);
  }
  CHECK(reached >= 8);
}

TEST_CASE("preferences: invalid options, bounds and postures are rejected") {
  const chain arm = robots::panda().table();
  const vector start = (vector(7) << 0, -.8, 0, -2.4, 0, 1.6, .8).finished();
  DUET_CHECK_REFUSED("duet: inverse_kinematics: candidates is 0 (expected a positive number)",
                     inverse_kinematics(arm, position_goal({.5, 0, .5}), start, {.candidates = 0},
                                        preferred_posture{start}));
  scene none;
  none.margin = -1;
  CHECK_THROWS_AS(
      (void)inverse_kinematics(arm, position_goal({.5, 0, .5}), start, {}, no_objective{}, none),
      invalid_input);
  vector max_change = vector::Constant(7, .1);
  max_change[2] = std::nan("");
  DUET_CHECK_REFUSED("duet: with_limits_about: joint 2: the interval 0 ± nan is not a number",
                     with_limits_about(arm, start, max_change));
  vector beyond = start;
  beyond[3] = .2; // the limit is -0.07
  CHECK_THROWS_AS((void)with_limits_about(arm, beyond, vector(vector::Constant(7, .1))),
                  invalid_input);
  const vector few = vector::Zero(3);
  DUET_CHECK_REFUSED("duet: with_limits_about: 7 coordinates and 3 bounds for 7 moving joints",
                     with_limits_about(arm, start, few));
  CHECK_THROWS_AS((void)inverse_kinematics(arm, position_goal({.5, 0, .5}), few), invalid_input);
  vector unknown = start;
  unknown[2] = std::nan("");
  const auto check_message = [&](const auto& preference, const char* what) {
    DUET_CHECK_REFUSED(what,
                       inverse_kinematics(arm, position_goal({.5, 0, .5}), start, {}, preference));
    DUET_CHECK_REFUSED(what, inverse_kinematics(arm, arm.pose(start), start, {}, preference));
  };
  check_message(preferred_posture{few},
                "duet: preferred_posture: 3 coordinates (expected 7, one per joint)");
  check_message(preferred_posture{vector(vector::Zero(8))},
                "duet: preferred_posture: 8 coordinates (expected 7, one per joint)");
  check_message(preferred_posture{unknown},
                "duet: preferred_posture: joint 2 is nan (expected a finite number)");
  check_message(preferred_posture{start, unknown[2]},
                "duet: preferred_posture: weight is nan (expected a finite number)");
}

TEST_CASE("nan objectives and goals: an error if nan everywhere, otherwise not a solution") {
  const chain arm = robots::panda().table();
  const vector start = (vector(7) << 0, -.75, 0, -2.5, 0, 1.5, .75).finished();
  const auto message = [&](const auto& goal, const auto& preference) {
    return duet_test::message_of<invalid_input>(
        [&] { (void)inverse_kinematics(arm, goal, start, {.max_restarts = 5}, preference); });
  };
  const std::string at_start = " joints (0, -0.75, 0, -2.5, 0, 1.5, 0.75)";
  const std::string all = "duet: inverse_kinematics: the objective is nan at all solutions found, "
                          "for example at the";
  // An objective with value nan and gradient 0, and one with both nan.
  const auto constant = [](const auto& x) { return 0 * x[0] + std::nan(""); };
  const auto root = [](const auto& x) {
    using std::sqrt;
    return sqrt(-1 - x[0] * x[0]);
  };
  CHECK(message(arm.pose(start), constant) == all + at_start);
  CHECK(message(arm.pose(start), root) == all + at_start);
  CHECK(message(position_goal({.5, 0, .5}), root).starts_with(all + " joints ("));
  // Without a solution the objective is not evaluated.
  CHECK(
      inverse_kinematics(arm, position_goal({3, 0, 0}), start, {.max_restarts = 1}, root).reason ==
      stop_reason::out_of_reach);

  const equation_goal nowhere{[]<class S>(const dual_quaternion<S>& a) {
    return std::array<S, 6>{translation(a).norm() * std::nan("")};
  }};
  const std::string goal =
      " is nan at every configuration evaluated, for example at the" + at_start;
  CHECK(message(nowhere, no_objective{}) == "duet: inverse_kinematics: the goal" + goal);
  CHECK(message(nowhere, preferred_posture{start}) == "duet: inverse_kinematics: the goal" + goal);
  std::vector<inverse_kinematics_result> out(2);
  DUET_CHECK_REFUSED(("duet: inverse_kinematics: goal 0" + goal).c_str(),
                     inverse_kinematics(arm, std::vector{nowhere, nowhere}, start, out));

  // Nan on one side: the solution on the other side is found from a start on this one.
  vector other = start;
  other[0] = -.5;
  const auto half = [](const auto& x) {
    using std::sqrt;
    return x[0] + sqrt(x[0]);
  };
  const auto found = inverse_kinematics(arm, position_goal({.45, .1, .25}), other, {}, half);
  CHECK(found.reason == stop_reason::reached);
  CHECK(found.joints[0] >= 0);
  const equation_goal beyond{[]<class S>(const dual_quaternion<S>& a) {
    using std::log;
    return std::array<S, 6>{log(translation(a)[1] / .2)};
  }};
  const auto side = inverse_kinematics(arm, beyond, other);
  CHECK(translation(arm.pose(other))[1] < 0);
  CHECK(side.reason == stop_reason::reached);
  CHECK(std::abs(translation(arm.pose(side.joints))[1] - .2) < 1e-5);
}

} // namespace
} // namespace test_robotics_wanted_solution
