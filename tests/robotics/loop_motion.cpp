// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/loops.hpp"
#include "support/message.hpp"
#include "support/multiprecision.hpp"

#include <duet/duet.hpp>
#include <duet/robotics.hpp>

namespace test_robotics_loop_motion {
namespace {

using namespace duet;
using duet_test::at_point;
using duet_test::five_bar;
using duet_test::four_bar;
using duet_test::max_abs_difference;
using duet_test::real_100;
using duet_test::revolute_joint;
using duet_test::vector_of;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double degree = std::numbers::pi / 180;

/// The rocker's angle by Freudenstein's equation.
template <class T>
T freudenstein(double a, double b, double c, double d, const T& theta, double side) {
  using std::atan2;
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T k = a * cos(theta) - d, s = a * sin(theta);
  const T q = (T(c) * c + k * k + s * s - T(b) * b) / (2 * T(c));
  return atan2(s, k) + side * atan2(sqrt(T(k * k + s * s - q * q)), q);
}

/// Upper intersection of the circles about the ends of the cranks.
template <class T>
std::array<T, 2> meeting_point(double foot, double crank, double coupler, const T& left,
                               const T& right) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T ax = -foot + crank * cos(left), ay = crank * sin(left);
  const T bx = foot + crank * cos(right), by = crank * sin(right);
  const T dx = bx - ax, dy = by - ay, square = dx * dx + dy * dy;
  const T up = sqrt(T(coupler * coupler / square - .25));
  return {ax + dx / 2 - up * dy, ay + dy / 2 + up * dx};
}

TEST_CASE("driven_motion: a four-bar agrees with Freudenstein's equation over full turns up to "
          "third derivatives") {
  const driven_motion by_crank(four_bar(.2, .5, .4, .55), vector_of({2, -1, 1.7}), {0});
  for (double theta = -700 * degree; theta < 800 * degree; theta += 33 * degree) {
    const auto x = derivatives<3>(by_crank, theta);
    const auto expected =
        derivatives<3>([](const auto& t) { return freudenstein(.2, .5, .4, .55, t, -1.); }, theta);
    CHECK(x[0][0] == theta);
    CHECK(std::abs(std::remainder(x[0][2] - expected[0], 2 * std::numbers::pi)) < 1e-13);
    for (int k = 1; k <= 3; ++k) {
      CHECK(std::abs(x[std::size_t(k)][2] - expected[std::size_t(k)]) < 1e-12);
    }
  }
}

TEST_CASE("driven_motion: derivatives of a spatial four-bar agree with 100-digit differences") {
  // A spatial four-bar: crank, ball, ball, rocker on a skew axis; a rod is its coupler.
  robot_description robot;
  robot.links = {{"ground"}, {"crank"}, {"rocker"}};
  robot.joints = {
      revolute_joint("crank", "ground", {}),
      revolute_joint("rocker", "ground", duet_test::placement_at(.9, .4, 0, .9, .3, .2))};
  const closed_chain_mechanism mechanism(kinematic_tree(robot), {{{constraint_kind::distance,
                                                                   {"crank", at_point(.3, 0, .1)},
                                                                   {"rocker", at_point(.6, .1, 0)},
                                                                   .8}}});
  const driven_motion motion(mechanism, vector_of({.4, 1}), {0});
  // Newton's method with 100 digits, for one unknown.
  const auto exact = [&](const real_100& theta) {
    std::vector<real_100> q{theta, real_100(motion(double(theta))[1])};
    const double slope = mechanism.constraint_jacobian(motion(double(theta)))(0, 1);
    for (int i = 0; i < 9; ++i) {
      q[1] -= mechanism.residuals(q)[0] / slope;
    }
    return q[1];
  };
  for (const double theta : {.4, 1.3, 2.2}) {
    const auto x = derivatives<3>(motion, theta);
    CHECK(std::abs(double(x[0][1] - exact(theta))) < 4e-15);
    for (int k = 1; k <= 3; ++k) {
      const auto expected = double(duet_test::central_difference(exact, real_100(theta), k, .1));
      CHECK(std::abs(x[std::size_t(k)][1] - expected) < 1e-13 * std::max(1.0, std::abs(expected)));
    }
  }
}

TEST_CASE("driven_motion: point, Jacobian and Hessian of a driven five-bar equal the closed form") {
  const double foot = .3, crank = .5, coupler = .7;
  const closed_chain_mechanism mechanism = five_bar(foot, crank, coupler);
  const VectorXd start = vector_of({2, -1, 1.2, 1});
  CHECK(mobility(mechanism, mechanism.assemble(start)).mobility == 2);
  const driven_motion motion(mechanism, start, {0, 2});
  const auto tip = mechanism.tree().link("left_coupler").at_point({coupler, 0, 0});
  const auto pose_at = [&](const auto& u) { return mechanism.tree().pose(motion(u), tip); };
  const auto by_hand = [&](const auto& u) {
    return meeting_point(foot, crank, coupler, u[0], u[1]);
  };
  for (const auto& u : {Vector2d(2, 1.2), Vector2d(1.5, .3), Vector2d(3, 2), Vector2d(2.2, .5)}) {
    const auto expected = jacobian(by_hand, u);
    const auto both = jacobian(pose_at, u, frame::hybrid);
    CHECK((translation(both.value).head<2>() - Vector2d(expected.value[0], expected.value[1]))
              .norm() < 1e-13);
    CHECK(max_abs_difference(both.jacobian.topRows(2), expected.jacobian) < 1e-12);
    for (int j = 0; j < 2; ++j) {
      const Vector2d along = Vector2d::Unit(j);
      const auto second = directional_derivative(
          [&](const auto& x) { return jacobian(pose_at, x, frame::hybrid).jacobian; }, u, along);
      const auto change = directional_derivative(
          [&](const auto& x) { return jacobian(by_hand, x).jacobian; }, u, along);
      CHECK(max_abs_difference(second.derivative.topRows(2), change.derivative) < 1e-11);
    }
  }
}

TEST_CASE("driven_motion: a prismatic drive gives results independent of the unit of length") {
  for (const double mm : {1., 1000.}) {
    robot_description robot;
    robot.links = {{"ground"}, {"slide"}, {"arm"}};
    robot.joints = {{"push", "ground", "slide", {joint_kind::prismatic, {}, {1, 0, 0}}},
                    revolute_joint("arm", "ground", at_point(0, .3 * mm))};
    const closed_chain_mechanism mechanism(kinematic_tree(robot), {{{constraint_kind::distance,
                                                                     {"slide", at_point(0, 0)},
                                                                     {"arm", at_point(.4 * mm, 0)},
                                                                     .5 * mm}}});
    const driven_motion motion(mechanism, vector_of({.5 * mm, .2}), {0});
    const auto x = derivatives<2>(motion, .6 * mm);
    // (u − .4 cos α)² + (.3 + .4 sin α)² = .25
    const double alpha = x[0][1];
    CHECK(std::abs(std::pow(.6 - .4 * std::cos(alpha), 2) + std::pow(.3 + .4 * std::sin(alpha), 2) -
                   .25) < 1e-14);
    const double by_alpha = .4 * std::sin(alpha) * (.6 - .4 * std::cos(alpha)) +
                            .4 * std::cos(alpha) * (.3 + .4 * std::sin(alpha));
    const double slope = -(.6 - .4 * std::cos(alpha)) / by_alpha;
    CHECK(std::abs(x[1][1] * mm - slope) < 1e-12);
  }
}

TEST_CASE("driven_motion, trace: dead points are located, reported and passed") {
  // (b + c)² = a² + d² − 2 a d cos θ: coupler and rocker in a row.
  const double a = .3, b = .25, c = .2, d = .4;
  const double dead = std::acos((a * a + d * d - (b + c) * (b + c)) / (2 * a * d));
  const closed_chain_mechanism mechanism = four_bar(a, b, c, d);
  const driven_motion by_crank(mechanism, vector_of({.5, 1, 2}), {0});
  try {
    (void)by_crank(2.);
    FAIL("closes beyond the dead point");
  } catch (const loop_closure_failure& error) {
    CHECK(std::abs(error.parameter()[0] - dead) < 1e-12);
    const std::string text = error.what();
    CHECK(text.starts_with("duet: driven_motion: the loops do not close beyond crank = 1.3715"));
    CHECK(text.ends_with(" on the line from 0.5 to 2: dead point, coupler, rocker still move"));
  }
  CHECK(std::abs(by_crank(dead - 1e-9)[0] - (dead - 1e-9)) == 0);
  CHECK_THROWS_AS((void)by_crank(dead + 1e-9), loop_closure_failure);

  const motion_trace complete = trace(by_crank);
  CHECK(complete.is_closed);
  CHECK(!complete.stopped_early);
  int of_crank = 0, of_rocker = 0;
  for (const dead_point& each : complete.dead_points) {
    CHECK(mechanism.residuals(each.coordinates).norm() < 1e-13);
    const double rate = each.rates[each.coordinate];
    CHECK(std::abs(rate) < 1e-13);
    const VectorXd& q = each.coordinates;
    if (each.coordinate == 0) { // coupler and rocker in a row: stretched, or folded
      ++of_crank;
      CHECK(each.moving == "coupler, rocker");
      const double theta = std::abs(std::remainder(q[0], 2 * std::numbers::pi));
      const double folded = std::acos((a * a + d * d - (b - c) * (b - c)) / (2 * a * d));
      CHECK(std::min(std::abs(theta - dead), std::abs(theta - folded)) < 1e-12);
    } else if (each.coordinate == 2) { // crank and coupler in a row
      ++of_rocker;
      CHECK(std::abs(std::sin(q[1])) < 1e-13);
    }
  }
  CHECK(of_crank >= 2);
  CHECK(of_rocker >= 2);
  // A crank with full turns has no dead points.
  const motion_trace round =
      trace(driven_motion(four_bar(.2, .5, .4, .55), vector_of({2, -1, 1.7}), {0}));
  CHECK(round.is_closed);
  for (const dead_point& each : round.dead_points) {
    CHECK(each.coordinate != 0);
  }
  CHECK(round.dead_points.size() >= 2);
}

TEST_CASE("driven_motion: 200 random four-bars stop at the dead points of the closed form only") {
  duet::random_source random(2);
  int stopped = 0, arrived = 0;
  for (int i = 0; i < 200; ++i) {
    const double a = random.uniform(.1, 1), b = random.uniform(.1, 1), c = random.uniform(.1, 1),
                 d = random.uniform(.1, 1);
    const double from = random.uniform(-3, 3), to = from + random.uniform(-4, 4);
    const double side = random.sign();
    const double psi = freudenstein(a, b, c, d, from, side);
    if (!(psi - psi == 0)) {
      continue;
    }
    const Vector2d elbow(a * std::cos(from), a * std::sin(from));
    const Vector2d end(d + c * std::cos(psi), c * std::sin(psi));
    const double beta = std::atan2(end[1] - elbow[1], end[0] - elbow[0]);
    const driven_motion motion(four_bar(a, b, c, d), vector_of({from, beta - from, psi}), {0});
    // The first crank angle along the line at which the distance of the free ends is b ± c.
    double first = 2;
    for (const double reach : {b + c, std::abs(b - c)}) {
      const double cosine = (a * a + d * d - reach * reach) / (2 * a * d);
      for (int revolutions = -2; revolutions <= 2 && std::abs(cosine) < 1; ++revolutions) {
        for (const double sign : {-1., 1.}) {
          const double part =
              (sign * std::acos(cosine) + 2 * std::numbers::pi * revolutions - from) / (to - from);
          first = part > 0 ? std::min(first, part) : first;
        }
      }
    }
    CAPTURE(i);
    try {
      const VectorXd q = motion(to);
      ++arrived;
      CHECK(first > 1);
      CHECK(std::abs(std::remainder(q[2] - freudenstein(a, b, c, d, to, side),
                                    2 * std::numbers::pi)) < 1e-10);
    } catch (const loop_closure_failure& error) {
      ++stopped;
      CHECK(first < 1);
      CHECK(std::abs(error.parameter()[0] - (from + first * (to - from))) < 1e-8);
    }
  }
  CHECK(stopped > 20);
  CHECK(arrived > 20);
}

TEST_CASE("driven_motion: singular coordinates and invalid drives are rejected") {
  using duet_test::message_of;
  // A body that rotates about z by a rotation vector, which is singular after a full turn.
  robot_description robot;
  robot.links = {{"base"}, {"body"}};
  robot.joints = {{"ball", "base", "body", {joint_kind::spherical}}};
  const driven_motion about_z(
      closed_chain_mechanism(kinematic_tree(robot),
                             {{{constraint_kind::revolute, {"base", {}}, {"body", {}}}}}),
      vector_of({0, 0, 1}), {2});
  CHECK(max_abs_difference(about_z(6.), vector_of({0, 0, 6})) < 1e-12);
  const std::string text = message_of<loop_closure_failure>([&] { (void)about_z(7.); });
  CHECK(text.starts_with("duet: driven_motion: the loops do not close beyond ball.rz = 6.2831"));
  CHECK(text.ends_with(": continuation fails, branches touch or coordinates are singular"));
  const motion_trace complete = trace(about_z);
  CHECK(complete.stopped_early);
  CHECK(complete.branch_points.empty());

  const closed_chain_mechanism mechanism = four_bar(.2, .5, .4, .55);
  const VectorXd q = mechanism.assemble(vector_of({2, -1, 1.7}), {0});
  DUET_CHECK_REFUSED(
      "duet: driven_motion: 2 driven coordinates (expected 1, the degrees of freedom at "
      "the start)",
      driven_motion(mechanism, q, {0, 1}));
  const closed_chain_mechanism two = five_bar(.3, .5, .7);
  DUET_CHECK_REFUSED(
      "duet: driven_motion: left does not determine the rates of the other coordinates "
      "(dead point)",
      driven_motion(two, vector_of({2, -1, 1.2, 1}), {0}));
  DUET_CHECK_REFUSED(
      "duet: closed_chain_mechanism: coordinate 5 does not exist, the mechanism has 3",
      driven_motion(mechanism, q, {5}));
  const driven_motion motion(mechanism, q, {0});
  DUET_CHECK_REFUSED("duet: driven_motion: 2 numbers (expected 1)", motion(vector_of({1, 2})));
  DUET_CHECK_REFUSED("duet: driven_motion: the driven coordinates are not finite",
                     motion(std::nan("")));
  DUET_CHECK_REFUSED("duet: trace: driven coordinate 1 does not exist, the motion has 1",
                     trace(motion, 1));
  const driven_motion moved = motion.warm_started_at(vector_of({2.5}));
  CHECK(moved.start()[0] == 2.5);
  CHECK(max_abs_difference(moved(3.), motion(3.)) < 1e-13);
}

} // namespace
} // namespace test_robotics_loop_motion
