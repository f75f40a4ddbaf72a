// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/loops.hpp"
#include "support/multiprecision.hpp"
#include "support/samples.hpp"

#include <duet/duet.hpp>
#include <duet/robotics.hpp>

namespace test_robotics_loop_branches {
namespace {

using namespace duet;
using duet_test::at_point;
using duet_test::four_bar;
using duet_test::real_100;
using duet_test::revolute_joint;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double pi = std::numbers::pi;

/// First-order terms for a four-bar with all joints on a line, where the terms of
/// a exp(iθ) + b exp(i(θ + β)) − c exp(iψ) = d vanish for rates (θ, β, ψ) along a motion.
double first_order(const std::array<double, 4>& bar, const VectorXd& q, const VectorXd& v) {
  const double a = bar[0] * std::cos(q[0]), b = bar[1] * std::cos(q[0] + q[1]),
               c = bar[2] * std::cos(q[2]);
  return a * v[0] + b * (v[0] + v[1]) - c * v[2];
}
double second_order(const std::array<double, 4>& bar, const VectorXd& q, const VectorXd& v) {
  const double a = bar[0] * std::cos(q[0]), b = bar[1] * std::cos(q[0] + q[1]),
               c = bar[2] * std::cos(q[2]);
  return a * v[0] * v[0] + b * (v[0] + v[1]) * (v[0] + v[1]) - c * v[2] * v[2];
}

closed_chain_mechanism bars(const std::array<double, 4>& bar) {
  return four_bar(bar[0], bar[1], bar[2], bar[3]);
}

/// Checks a crossing of two lines: four tangents, straight on first and back last.
void check_crossing(const std::array<double, 4>& bar, const branch_point& at) {
  for (int i = 0; i < 3; ++i) { // all joints on a line
    CHECK(std::abs(std::sin(at.coordinates[i])) < 1e-13);
  }
  REQUIRE(at.tangents.size() == 4);
  CHECK((at.tangents[0] + at.tangents[3]).norm() < 1e-14);
  CHECK((at.tangents[1] + at.tangents[2]).norm() < 1e-14);
  CHECK(std::abs(at.tangents[0].dot(at.tangents[1])) < .999);
  const double first = at.tangents[1][0]; // increases along the first tangent of a pair
  CHECK((std::abs(first) < 1e-13 ? at.tangents[1][1] : first) > 0);
  for (const VectorXd& tangent : at.tangents) {
    CHECK(std::abs(tangent.norm() - 1) < 1e-14);
    CHECK(std::abs(first_order(bar, at.coordinates, tangent)) < 1e-13);
    CHECK(std::abs(second_order(bar, at.coordinates, tangent)) < 1e-13);
  }
}

/// Bar lengths of a foldable four-bar: two bars have the sum or the difference of the others.
std::array<double, 4> change_point(duet::random_source& random) {
  for (;;) {
    const double a = random.uniform(.2, 1), c = random.uniform(.2, 1), d = random.uniform(.2, 1);
    const std::array b{a + d - c, c + d - a, a + c - d};
    const double length = b[std::size_t(random.uniform(0, 3))];
    if (length > .1) {
      return {a, length, c, d};
    }
  }
}

/// One of the positions with the crank at an angle that allows some.
VectorXd some_position(const closed_chain_mechanism& mechanism, duet::random_source& random) {
  for (;;) {
    const auto result = find_assembly_configurations(
        mechanism, {0}, VectorXd::Constant(1, random.uniform(-3, 3)), {.random_starts = 20});
    for (const assembly_configuration& each : result.positions) {
      if (each.smallest_singular_value > .05) {
        return each.coordinates;
      }
    }
  }
}

/// Trace of a motion, checked to close and to have a number of branch points.
motion_trace closed_trace(const driven_motion& motion, std::size_t branch_points,
                          const trace_options& options = {}) {
  motion_trace result = trace(motion, 0, options);
  CHECK(result.is_closed);
  CHECK(!result.stopped_early);
  REQUIRE(result.branch_points.size() == branch_points);
  return result;
}

TEST_CASE("trace: a flat parallelogram continues as parallelogram or antiparallelogram") {
  const std::array bar{.3, .8, .3, .8};
  const driven_motion motion(bars(bar), Vector3d(1, -1, 1), {0});
  const motion_trace straight = closed_trace(motion, 2);
  CHECK(straight.dead_points.empty());
  for (const VectorXd& q : straight.positions) {
    CHECK(std::abs(q[0] - q[2]) < 1e-12);
  }
  for (const branch_point& at : straight.branch_points) {
    check_crossing(bar, at);
    CHECK(at.chosen == 0);
    CHECK(std::abs(at.tangents[0][0] - at.tangents[0][2]) < 1e-14);
    // tan(θ/2) / tan(ψ/2) = (a − d) / (a + d), at θ = ψ = 0 or π
    const double ratio = (.3 - .8) / (.3 + .8);
    const double cosine = std::cos(at.coordinates[0]);
    CHECK(std::abs(at.tangents[1][0] / at.tangents[1][2] - (cosine > 0 ? ratio : 1 / ratio)) <
          1e-13);
  }

  for (const std::size_t tangent : {1, 2}) {
    const motion_trace other =
        closed_trace(motion, 3, {.branches = {tangent}}); // back through the first one
    CHECK(other.branch_points[0].chosen == tangent);
    CHECK(other.branch_points[1].chosen == 0);
    int crossed = 0;
    for (const VectorXd& q : other.positions) {
      if (std::abs(q[0] - q[2]) > 1e-9) {
        ++crossed;
        CHECK(std::abs(std::sin(q[0] / 2) * std::cos(q[2] / 2) * 1.1 +
                       std::cos(q[0] / 2) * std::sin(q[2] / 2) * .5) < 1e-12);
      }
    }
    CHECK(crossed > 40);
  }
  // The last tangent leads back along the motion.
  const motion_trace back = trace(motion, 0, {.branches = {3}});
  CHECK(back.branch_points[0].chosen == 3);
  CHECK(std::abs(back.positions.back()[0] - back.positions.back()[2]) < 1e-12);
  DUET_CHECK_REFUSED("duet: trace: branch 4 does not exist, branch point 0 has 4",
                     trace(motion, 0, {.branches = {4}}));
}

TEST_CASE("trace: tangents at branch points of random foldable four-bars agree with 100 digits") {
  duet::random_source random(7);
  for (int k = 0; k < duet_test::sample_count(10); ++k) {
    CAPTURE(k);
    const std::array<double, 4> bar = change_point(random);
    closed_chain_mechanism mechanism = bars(bar);
    robot_description robot = mechanism.tree().description();
    const auto base =
        duet_test::placement_at(random.uniform(-3, 3), random.uniform(-1, 1), random.uniform(-3, 3),
                                random.uniform(-1, 1), .3, -.2);
    for (tree_joint& joint : robot.joints) {
      if (joint.parent == "ground") {
        joint.motion.origin = base * joint.motion.origin;
      }
    }
    mechanism = closed_chain_mechanism(kinematic_tree(robot), {mechanism.loops()});
    const driven_motion motion(mechanism, some_position(mechanism, random), {0});
    const motion_trace complete = closed_trace(motion, 2); // once on each branch
    for (const branch_point& at : complete.branch_points) {
      check_crossing(bar, at);
    }
    for (const std::size_t tangent : {1, 2, 3}) {
      const motion_trace other = trace(motion, 0, {.branches = {tangent}});
      CHECK(other.is_closed);
      CHECK(!other.stopped_early);
      for (const VectorXd& q : other.positions) {
        CHECK(mechanism.residuals(q).norm() < 1e-11);
      }
    }
    // Newton's method with 100 digits, so near to the crossing that chords equal tangents.
    const branch_point& at = complete.branch_points[0];
    for (const VectorXd& tangent : at.tangents) {
      const real_100 step("1e-25");
      std::vector<real_100> flat, q;
      for (int i = 0; i < 3; ++i) {
        flat.push_back(boost::math::constants::pi<real_100>() *
                       std::lround(at.coordinates[i] / pi));
        q.push_back(flat.back() + step * tangent[i]);
      }
      const int fixed = std::abs(tangent[0]) > .5 ? 0 : std::abs(tangent[1]) > .5 ? 1 : 2;
      const int i = fixed == 0 ? 1 : 0, j = fixed == 2 ? 1 : 2;
      const real_100 a = bar[0], b = bar[1], c = bar[2], d = bar[3];
      // b of the exact crossing, as the lengths of the bars are rounded
      const auto sign = [&](int n) { return cos(flat[std::size_t(n)]); };
      const real_100 exact_b = (d - a * sign(0) + c * sign(2)) / cos(flat[0] + flat[1]);
      CHECK(abs(exact_b - b) < 1e-15);
      for (int n = 0; n < 8; ++n) {
        const real_100 phi = q[0] + q[1];
        const real_100 x = a * cos(q[0]) + exact_b * cos(phi) - c * cos(q[2]) - d;
        const real_100 y = a * sin(q[0]) + exact_b * sin(phi) - c * sin(q[2]);
        const std::array<real_100, 3> by_x{-a * sin(q[0]) - exact_b * sin(phi), -exact_b * sin(phi),
                                           c * sin(q[2])};
        const std::array<real_100, 3> by_y{a * cos(q[0]) + exact_b * cos(phi), exact_b * cos(phi),
                                           -c * cos(q[2])};
        const auto m = std::size_t(i), l = std::size_t(j);
        const real_100 det = by_x[m] * by_y[l] - by_x[l] * by_y[m];
        q[m] -= (x * by_y[l] - by_x[l] * y) / det;
        q[l] -= (by_x[m] * y - x * by_y[m]) / det;
      }
      for (std::size_t n = 0; n < 3; ++n) {
        CHECK(std::abs(double((q[n] - flat[n]) / step) - tangent[Eigen::Index(n)]) < 2e-13);
      }
    }
  }
}

TEST_CASE("trace: a kite and a five-bar have their branch points") {
  const std::array bar{.8, .5, .5, .8};
  const driven_motion motion(bars(bar), Vector3d(1, 2, 2), {0});
  const motion_trace complete = closed_trace(motion, 2);
  for (const branch_point& at : complete.branch_points) {
    check_crossing(bar, at);
    CHECK(std::abs(at.tangents[1][0]) < 1e-14); // coupler and rocker rotate together
  }
  const motion_trace folded = trace(motion, 0, {.branches = {1}});
  CHECK(folded.is_closed);
  CHECK(std::abs(folded.positions.back()[0]) < 1e-12);

  // A five-bar whose right crank is fixed with its end one crank length from the left pivot.
  const double fixed = std::acos(-.6); // from (.3, 0) by .5 to the point above (0, 0)
  VectorXd guess(4);
  guess << 2, -1, fixed, 1;
  const motion_trace five = trace(driven_motion(duet_test::five_bar(.3, .5, .7), guess, {0, 2}));
  CHECK(five.is_closed);
  REQUIRE(!five.branch_points.empty());
  int cranks_meet = 0;
  for (const branch_point& at : five.branch_points) {
    CHECK(at.coordinates[2] == doctest::Approx(fixed).epsilon(1e-14));
    CHECK(at.tangents.size() == 4);
    const double x = -.3 + .5 * std::cos(at.coordinates[0]), y = .5 * std::sin(at.coordinates[0]);
    cranks_meet += std::hypot(x, y - .4) < 1e-12 ? 1 : 0; // both cranks end at (0, .4)
  }
  CHECK(cranks_meet == int(five.branch_points.size()));
}

TEST_CASE("trace: nearly foldable four-bars have no branch point") {
  duet::random_source random(11);
  for (int k = 0; k < duet_test::sample_count(12); ++k) {
    const std::array<double, 4> flat = change_point(random);
    for (const double miss : {1e-3, -1e-3, 1e-6, -1e-6, 1e-9, -1e-9}) {
      CAPTURE(k);
      CAPTURE(miss);
      const double a = flat[0], b = flat[1], c = flat[2], d = flat[3];
      const closed_chain_mechanism mechanism = four_bar(a, b + miss, c, d);
      const motion_trace complete =
          closed_trace(driven_motion(mechanism, some_position(mechanism, random), {0}), 0);
      for (const dead_point& each : complete.dead_points) {
        if (each.coordinate == 0) { // coupler and rocker in a row
          const double theta = std::abs(std::remainder(each.coordinates[0], 2 * pi));
          const auto distance =
              [&](double reach) { // of squares: angles are known to half the digits
                return std::abs(a * a + d * d - 2 * a * d * std::cos(theta) - reach * reach);
              };
          CHECK(std::min(distance(b + miss + c), distance(b + miss - c)) < 1e-13);
        }
      }
    }
  }
}

TEST_CASE("trace: two coupled parallelograms have four branches in a kernel of dimension three") {
  robot_description robot;
  robot.links = {{"ground"}, {"crank"}, {"c1"}, {"r1"}, {"c2"}, {"r2"}};
  robot.joints = {revolute_joint("crank", "ground", {}),
                  revolute_joint("c1", "crank", at_point(.3, 0)),
                  revolute_joint("r1", "ground", at_point(.8, 0)),
                  revolute_joint("c2", "crank", at_point(.3, 0)),
                  revolute_joint("r2", "ground", at_point(-.6, 0))};
  const closed_chain_mechanism both(
      kinematic_tree(robot),
      {{{constraint_kind::revolute, {"c1", at_point(.8, 0)}, {"r1", at_point(.3, 0)}},
        {constraint_kind::revolute, {"c2", at_point(-.6, 0)}, {"r2", at_point(.3, 0)}}}});
  for (const double start : {.8, 1., 1.234, 1.7}) {
    VectorXd q(5);
    q << start, -start, start, -start, start;
    const motion_trace complete = closed_trace(driven_motion(both, q, {0}), 2);
    for (const branch_point& at : complete.branch_points) {
      REQUIRE(at.tangents.size() == 8);
      for (const VectorXd& tangent : at.tangents) {
        CHECK(std::abs(first_order({.3, .8, .3, .8}, at.coordinates, tangent)) < 1e-11);
        CHECK(std::abs(second_order({.3, .8, .3, .8}, at.coordinates, tangent)) < 1e-11);
        VectorXd second = at.coordinates, v = tangent;
        second.segment(1, 2) = at.coordinates.tail(2);
        v.segment(1, 2) = tangent.tail(2);
        CHECK(std::abs(first_order({.3, -.6, .3, -.6}, second, v)) < 1e-11);
        CHECK(std::abs(second_order({.3, -.6, .3, -.6}, second, v)) < 1e-11);
        for (const VectorXd& other : at.tangents) {
          CHECK((&tangent == &other || tangent.dot(other) < .999));
        }
      }
    }
  }

  // A parallelogram with a third crank stays a parallelogram: flat, it is first-order flexible, but
  // has one branch.
  robot.links = {{"ground"}, {"crank"}, {"coupler"}, {"rocker"}, {"third"}};
  robot.joints = {revolute_joint("crank", "ground", {}),
                  revolute_joint("coupler", "crank", at_point(.3, 0)),
                  revolute_joint("rocker", "ground", at_point(.8, 0)),
                  revolute_joint("third", "ground", at_point(.5, 0))};
  const closed_chain_mechanism three(
      kinematic_tree(robot),
      {{{constraint_kind::revolute, {"coupler", at_point(.8, 0)}, {"rocker", at_point(.3, 0)}},
        {constraint_kind::revolute, {"coupler", at_point(.5, 0)}, {"third", at_point(.3, 0)}}}});
  const motion_trace complete =
      closed_trace(driven_motion(three, Eigen::Vector4d(1, -1, 1, 1), {0}), 2);
  for (const branch_point& at : complete.branch_points) {
    REQUIRE(at.tangents.size() == 2);
    CHECK((at.tangents[0] - Eigen::Vector4d(.5, -.5, .5, .5)).norm() < 1e-13);
  }
}

TEST_CASE("trace: branch points of slider-cranks in both units and of a spherical four-bar") {
  for (const double mm : {1., 1000.}) {
    // Crank and coupler of equal length: x = 2 r cos θ, β = −2 θ, or folded with the slider at
    // rest.
    const double r = .3 * mm;
    robot_description robot;
    robot.links = {{"ground"}, {"crank"}, {"coupler"}, {"slide"}};
    robot.joints = {revolute_joint("crank", "ground", {}),
                    revolute_joint("coupler", "crank", at_point(r, 0)),
                    {"slide", "ground", "slide", {joint_kind::prismatic, {}, {1, 0, 0}}}};
    const closed_chain_mechanism mechanism(
        kinematic_tree(robot),
        {{{constraint_kind::revolute, {"coupler", at_point(r, 0)}, {"slide", {}}}}});
    const motion_trace complete =
        closed_trace(driven_motion(mechanism, Vector3d(1, -2, 2 * r * std::cos(1)), {0}), 2);
    for (const branch_point& at : complete.branch_points) {
      const double sine = std::sin(at.coordinates[0]);
      CHECK(std::abs(std::abs(sine) - 1) < 1e-15);
      CHECK(std::abs(at.coordinates[2]) < 1e-14 * mm);
      REQUIRE(at.tangents.size() == 4);
      Vector3d along(1, -2, -2 * sine), folded(1, 0, 0);
      along /= 3; // unit length, in radians and relative to r
      CHECK((at.tangents[0].cwiseQuotient(mechanism.units()) - along).norm() < 1e-13);
      CHECK((at.tangents[1].cwiseQuotient(mechanism.units()) - folded).norm() < 1e-13);
    }
  }
  // All axes meet in a point, opposite sides are equal: tan(θ₁/2) tan(θ₂/2) is one of two
  // constants.
  const double a = .4, b = .9;
  const closed_chain_mechanism sphere = duet_test::ring({{0, a}, {0, b}, {0, a}, {0, b}});
  const std::array constants{std::cos((a + b) / 2) / std::cos((b - a) / 2),
                             std::sin((a + b) / 2) / std::sin((b - a) / 2)};
  const assembly_search_result result =
      find_assembly_configurations(sphere, {0}, VectorXd::Constant(1, .8), {.random_starts = 60});
  REQUIRE(result.positions.size() == 2);
  for (const assembly_configuration& each : result.positions) {
    const motion_trace complete = closed_trace(driven_motion(sphere, each.coordinates, {0}), 2);
    for (const branch_point& at : complete.branch_points) {
      REQUIRE(at.tangents.size() == 4);
      const bool first_is_straight = std::cos(at.coordinates[0]) > 0;
      std::array<double, 2> ratios{};
      for (std::size_t k = 0; k < 2; ++k) { // θ₂' = −K θ₁' at θ₁ = π, θ₂ = 0, and vice versa
        const double ratio = -at.tangents[k][1] / at.tangents[k][0];
        ratios[k] = first_is_straight ? 1 / ratio : ratio;
      }
      std::sort(ratios.begin(), ratios.end());
      CHECK(std::abs(ratios[0] - constants[0]) < 1e-12);
      CHECK(std::abs(ratios[1] - constants[1]) < 1e-12);
    }
  }
}

TEST_CASE("trace: tangents that are not isolated are omitted") {
  // Two cranks with couplers of equal length move one slider. With the slider at rest both rotate
  // freely.
  robot_description robot;
  robot.links = {{"ground"}, {"a"}, {"b"}, {"c"}, {"d"}, {"slide"}};
  robot.joints = {revolute_joint("a", "ground", {}),
                  revolute_joint("b", "a", at_point(.3, 0)),
                  revolute_joint("c", "ground", {}),
                  revolute_joint("d", "c", at_point(.3, 0)),
                  {"slide", "ground", "slide", {joint_kind::prismatic, {}, {1, 0, 0}}}};
  const closed_chain_mechanism mechanism(
      kinematic_tree(robot),
      {{{constraint_kind::revolute, {"b", at_point(.3, 0)}, {"slide", {}}},
        {constraint_kind::revolute, {"d", at_point(.3, 0)}, {"slide", {}}}}});
  VectorXd start(5);
  start << 1, -2, -1, 2, .6 * std::cos(1);
  const motion_trace complete = closed_trace(driven_motion(mechanism, start, {0}), 4);
  for (std::size_t i = 0; i < 4; ++i) {
    const branch_point& at = complete.branch_points[i];
    if (i % 2 == 0) { // both are folded
      CHECK(std::abs(at.coordinates[4]) < 1e-14);
      CHECK(at.tangents.size() == 2);
    } else { // both are stretched: cranks continue in equal or opposite directions
      CHECK(std::abs(std::abs(at.coordinates[4]) - .6) < 1e-14);
      CHECK(at.tangents.size() == 4);
    }
  }
}

TEST_CASE("trace: starts near a branch point and large steps find both branch points") {
  const closed_chain_mechanism mechanism = bars({.3, .8, .3, .8});
  for (const double start : {1e-2, 2e-3, 1e-3, 5e-4, 1e-4, 1e-5}) {
    closed_trace(driven_motion(mechanism, Vector3d(start, -start, start), {0}), 2);
  }
  for (const double step : {.03, .5, 1.5}) {
    closed_trace(driven_motion(mechanism, Vector3d(1, -1, 1), {0}), 2, {.largest_step = step});
  }
}

TEST_CASE("driven_motion: continues straight through branch points") {
  const driven_motion flat(bars({.3, .8, .3, .8}), Vector3d(1, -1, 1), {0});
  for (const double u : {.5, 1e-3, 1e-5, 1e-7, 1e-10, 0., -1e-12, -1e-9, -1e-7, -1e-4, -1., -4.}) {
    CHECK((flat(u) - u * Vector3d(1, -1, 1)).norm() < 1e-12);
  }
  const auto q = derivatives<2>(flat, -.5);
  CHECK((q[1] - Vector3d(1, -1, 1)).norm() < 1e-12);
  CHECK(q[2].norm() < 1e-11);
  DUET_CHECK_REFUSED(
      "duet: driven_motion: crank does not determine the rates of the other coordinates (dead "
      "point)",
      derivatives<1>(flat, 0.));
  // The same test for an antiparallelogram.
  const Vector3d crossed(1, 0, -2 * std::atan(std::tan(.5) * 1.1 / .5));
  const closed_chain_mechanism mechanism = bars({.3, .8, .3, .8});
  const driven_motion anti(mechanism, mechanism.assemble(crossed, {0}), {0});
  for (const double u : {.3, -.3, -2.}) {
    CHECK(std::abs(std::tan(anti(u)[2] / 2) * .5 + std::tan(u / 2) * 1.1) < 1e-12);
  }
}

} // namespace
} // namespace test_robotics_loop_branches
