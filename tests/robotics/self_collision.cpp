// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/trees.hpp"
#include "robotics/paths.hpp"

#include <duet/robotics.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace test_robotics_self_collision {
namespace {

using namespace duet;
using vector = duet_test::coordinates<7>;
using point = Eigen::Vector3d;

const auto arm = robots::panda().table();

/// The Panda's base, upper arm, forearm and hand.
scene panda_bodies() {
  scene result{{{0, capsule<>({0, 0, 0}, {0, 0, .18}, .07), "base"},
                {2, capsule<>({0, 0, 0}, {0, -.2, 0}, .06), "upper arm"},
                {4, capsule<>({-.0825, .12, 0}, {-.0825, .28, 0}, .06), "forearm"},
                {7, capsule<>({0, 0, .06}, {0, 0, .16}, .05), "hand"}},
               {},
               .02};
  result.pairs = self_collision_pairs(arm, result.bodies, {{"upper arm", "base"}});
  return result;
}

bool has(const std::vector<collision_pair>& pairs, std::size_t first, std::size_t second) {
  return std::any_of(pairs.begin(), pairs.end(), [&](const collision_pair& each) {
    return each.first == first && each.second == second;
  });
}

/// The gradient of the distance of a pair: nᵀ of the difference of the Jacobians of its two points.
template <class M, class X>
void check_gradient(const M& mechanism, const X& theta, const collision_body& a,
                    const collision_body& b) {
  const auto p = closest_points(mechanism, theta, a, b);
  const auto [d, g] = distance_and_gradient(mechanism, theta, a, b);
  CHECK(std::abs(d - p.distance) < 1e-14);
  CHECK((p.on_obstacle + d * p.normal - p.on_body).norm() < 1e-14);
  const auto rates = [&](const collision_body& body, const point& x) {
    const auto j = jacobian(mechanism, theta, frame::spatial, body.link);
    Eigen::Matrix3Xd result(3, j.cols());
    for (Eigen::Index i = 0; i < j.cols(); ++i) {
      const point v = j.col(i).template head<3>(), w = j.col(i).template tail<3>();
      result.col(i) = v + w.cross(x);
    }
    return result;
  };
  const Eigen::VectorXd expected =
      (rates(a, p.on_body) - rates(b, p.on_obstacle)).transpose() * p.normal;
  CHECK((g - expected).norm() < 1e-10);
}

template <class M, class X>
void check_gradients(const M& mechanism, const X& theta, const scene& s) {
  for (const auto [first, second] : s.pairs) {
    const collision_body &a = s.bodies[first], &b = s.bodies[second];
    check_gradient(mechanism, theta, a, b);
    check_gradient(mechanism, theta, b, a);
    CHECK(std::abs(closest_points(mechanism, theta, a, b).distance -
                   closest_points(mechanism, theta, b, a).distance) < 1e-14);
  }
}

TEST_CASE("self_collision_pairs: omits the same link, neighbours and excluded names") {
  const scene s = panda_bodies();
  CHECK(s.pairs.size() == 5);
  CHECK(!has(s.pairs, 0, 1));
  CHECK(has(s.pairs, 0, 2));
  CHECK(self_collision_pairs(arm, s.bodies).size() == 6);
  CHECK(self_collision_pairs(arm, s.bodies, {{"hand", "forearm"}, {"hand", "foot"}}).size() == 5);
  const std::vector<collision_body> near = {
      {3, sphere<>{}}, {3, sphere<>{}}, {4, sphere<>{}}, {5, sphere<>{}}};
  const auto pairs = self_collision_pairs(arm, near);
  CHECK(pairs.size() == 2);
  CHECK(has(pairs, 0, 3));
  CHECK(has(pairs, 1, 3));
  DUET_CHECK_REFUSED("duet: serial_chain: link 9 does not exist, the chain has 7 joints",
                     self_collision_pairs(arm, {{9, sphere<>{}}}));
}

TEST_CASE("clearance: smallest distance of a chain from itself, and its gradient") {
  const scene s = panda_bodies();
  double min_distance = INFINITY, max_distance = -INFINITY;
  for (const auto& theta : duet_test::configurations(arm, 100)) {
    check_gradients(arm, theta, s);
    const auto c = clearance(arm, theta, s);
    double expected = INFINITY;
    for (const auto [first, second] : s.pairs) {
      expected = std::min(expected,
                          closest_points(arm, theta, s.bodies[first], s.bodies[second]).distance);
    }
    CHECK(c.distance == expected);
    CHECK(c.is_self);
    CHECK(has(s.pairs, c.body, c.other));
    CHECK(c.points.distance == c.distance);
    const auto by_duals =
        gradient([&](const auto& x) { return clearance(arm, x, s).distance; }, theta);
    CHECK(by_duals.gradient ==
          distance_and_gradient(arm, theta, s.bodies[c.body], s.bodies[c.other]).gradient);
    min_distance = std::min(min_distance, c.distance);
    max_distance = std::max(max_distance, c.distance);
  }
  CHECK(min_distance < -.05); // both sides were seen
  CHECK(max_distance > .05);
}

TEST_CASE("self_collision_pairs: links of a tree that are fixed to each other count as one") {
  const kinematic_tree tree(duet_test::all_joints());
  scene s;
  duet_test::random_source random(3);
  const auto at = [&] {
    return point(random.uniform(-.1, .1), random.uniform(-.1, .1), random.uniform(-.1, .1));
  };
  for (std::size_t i = 0; i < tree.links().size(); ++i) {
    s.bodies.push_back({int(i), capsule<>(at(), at(), .02), tree.links()[i].name});
  }
  s.pairs = self_collision_pairs(tree, s.bodies, {{"finger", "flange"}});
  const auto is_pair = [&](const char* a, const char* b) {
    const auto i = std::size_t(tree.link(a).link), k = std::size_t(tree.link(b).link);
    return has(s.pairs, std::min(i, k), std::max(i, k));
  };
  CHECK(!is_pair("hand", "tool"));    // fixed to it
  CHECK(!is_pair("elbow", "tool"));   // adjacent, by the joint of the hand
  CHECK(!is_pair("finger", "tool"));  // on the hand
  CHECK(!is_pair("world", "flange")); // fixed to it
  CHECK(!is_pair("flange", "cart"));
  CHECK(!is_pair("finger", "flange")); // excluded
  CHECK(is_pair("finger", "thumb"));
  CHECK(is_pair("screw", "flange"));
  CHECK(is_pair("shoulder", "hand"));
  Eigen::VectorXd q(tree.size());
  for (int k = 0; k < 20; ++k) {
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      q[i] = random.uniform(-1, 1);
    }
    check_gradients(tree, q, s);
    const auto c = clearance(tree, q, s);
    CHECK(c.distance == closest_points(tree, q, s.bodies[c.body], s.bodies[c.other]).distance);
  }
}

TEST_CASE("plan_screw_motion: the elbow avoids the base") {
  vector start, end;
  start << 0, 1.2, -.4, -2.6, .65, 2.5, 1;
  end << -.6, 1.7, -.9, -3, -.55, 1.95, 1.7;
  const scene around = panda_bodies();
  const auto goal = arm.pose(end);
  const auto plain = plan_screw_motion(arm, start, goal);
  REQUIRE(plain.reason == stop_reason::reached);
  double min_distance = INFINITY;
  for (const auto& theta : plain.joints) {
    min_distance = std::min(min_distance, clearance(arm, theta, around).distance);
  }
  CHECK(min_distance < -.01);
  const auto plan = plan_screw_motion(arm, start, goal, {}, {}, around);
  CHECK(plan.reason == stop_reason::reached);
  CHECK(plan.smallest_clearance < .0201); // it does come to the margin
  duet_test::check_clear_screw(arm, plan, goal, around);
  // The order of the two bodies of a pair does not matter.
  scene reversed = around;
  for (collision_pair& each : reversed.pairs) {
    std::swap(each.first, each.second);
  }
  const auto other = plan_screw_motion(arm, start, goal, {}, {}, reversed);
  CHECK(other.reason == stop_reason::reached);
  REQUIRE(other.joints.size() == plan.joints.size());
  CHECK((other.joints.back() - plan.joints.back()).norm() < 1e-6);
}

TEST_CASE(
    "plan_screw_motion: a hand moved into the base stops at the margin with reason obstacle") {
  vector start, end;
  start << -.24, 1.05, -.43, -2.6, 2.17, 3.05, 1.38;
  end << .23, 1.71, .55, -2.54, 1.3, 2.77, 1.43;
  const scene around = panda_bodies();
  const auto goal = arm.pose(end);
  const auto plan = plan_screw_motion(arm, start, goal, {.search_step = .2}, {}, around);
  CHECK(plan.reason == stop_reason::obstacle);
  CHECK(plan.tau.back() > .1);
  CHECK(plan.smallest_clearance == doctest::Approx(.02).epsilon(1e-3));
  duet_test::check_clear_screw(arm, plan, goal, around);
}

TEST_CASE("plan_screw_motion: starts in self-collision and invalid pairs are rejected") {
  scene s = panda_bodies();
  vector start;
  start << 0, 1.7, 0, -3, 0, 3.2, .8;
  const auto c = clearance(arm, start, s);
  REQUIRE(c.distance < .02);
  REQUIRE(c.is_self);
  const auto fails = [&](const std::string& what) {
    DUET_CHECK_REFUSED(doctest::Contains(what.c_str()),
                       plan_screw_motion(arm, start, arm.pose(start), {}, {}, s));
  };
  fails("duet: follow_path: at the start body " + std::to_string(c.body) + " (" +
        s.bodies[c.body].name + ") is ");
  fails(" from body " + std::to_string(c.other) + " (" + s.bodies[c.other].name +
        "), closer than the margin of 0.02");
  s.pairs.push_back({2, 4});
  fails("duet: scene: pair 5 consists of bodies 2 and 4 (expected two different indices below 4)");
  s.pairs.back() = {1, 1};
  fails("duet: scene: pair 5 consists of bodies 1 and 1 (expected two different indices below 4)");
}

} // namespace
} // namespace test_robotics_self_collision
