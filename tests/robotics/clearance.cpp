// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/arms.hpp"

#include <duet/kinematics/jacobian.hpp>
#include <duet/robotics/clearance.hpp>

#include <Eigen/Core>

#include <variant>

namespace test_robotics_clearance {
namespace {

using namespace duet;
using point = Eigen::Vector3d;

/// A capsule along every link of the Panda, a ball at its wrist, and obstacles around it.
scene cage() {
  return {{{0, capsule<>({0, 0, 0}, {0, 0, .2}, .06)},
           {1, capsule<>({0, 0, -.2}, {0, 0, 0}, .06)},
           {3, capsule<>({0, 0, -.2}, {.08, 0, 0}, .06)},
           {5, capsule<>({0, .05, -.3}, {0, 0, 0}, .05)},
           {6, sphere<>{{.08, 0, 0}, .07}},
           {7, capsule<>({0, 0, 0}, {0, 0, .1}, .04)}},
          {sphere<>{{.4, .3, .5}, .1},
           box<>{pose(from_rotation_vector(point(.3, -.2, 1)), point(-.4, .2, .4)), {.1, .2, .3}},
           half_space<>{{0, 0, 1}, -.1}}};
}

TEST_CASE("clearance: smallest distance, and its gradient nᵀ J at the closest point") {
  const auto arm = robots::panda().table();
  const scene s = cage();
  require_scene(arm, s);
  double min_distance = INFINITY, max_distance = -INFINITY;
  for (const auto& theta : duet_test::configurations(arm, 20)) {
    const auto c = clearance(arm, theta, s);
    min_distance = std::min(min_distance, c.distance);
    max_distance = std::max(max_distance, c.distance);
    for (std::size_t b = 0; b < s.bodies.size(); ++b) {
      for (std::size_t o = 0; o < s.obstacles.size(); ++o) {
        const auto p = closest_points(arm, theta, s.bodies[b], s.obstacles[o]);
        CHECK(p.distance >= c.distance);
        CHECK((p.distance == c.distance) == (b == c.body && o == c.other));
        const auto [d, g] = distance_and_gradient(arm, theta, s.bodies[b], s.obstacles[o]);
        CHECK(std::abs(d - p.distance) < 1e-14);
        const bool is_edge_inside = o == 1 && d < 0; // there one face takes over from another
        if (!is_edge_inside) {
          const auto j = jacobian(arm, theta, frame::spatial, s.bodies[b].link);
          for (Eigen::Index i = 0; i < 7; ++i) {
            const point v = j.col(i).head<3>(), w = j.col(i).tail<3>();
            CHECK(std::abs(g[i] - p.normal.dot(v + w.cross(p.on_body))) < 1e-12);
          }
        }
      }
    }
    CHECK(c.points.distance == c.distance);
    // The same over dual numbers throughout.
    const auto by_duals =
        gradient([&](const auto& x) { return clearance(arm, x, s).distance; }, theta);
    CHECK(by_duals.gradient ==
          distance_and_gradient(arm, theta, s.bodies[c.body], s.obstacles[c.other]).gradient);
  }
  // Both sides were seen.
  CHECK(min_distance < -.05);
  CHECK(max_distance > 0);
}

TEST_CASE("clearance: infinite without obstacles; invalid scenes are rejected") {
  const auto arm = robots::panda().table();
  const duet_test::coordinates<7> theta = duet_test::coordinates<7>::Zero();
  scene s = cage();
  CHECK(clearance(arm, theta, scene{s.bodies, {}}).distance == INFINITY);
  CHECK(clearance(arm, theta, scene{{}, s.obstacles}).distance == INFINITY);
  std::get<sphere<>>(s.obstacles[0]).radius = std::nan("");
  DUET_CHECK_REFUSED("duet: the radius of obstacle 0 is nan (expected a non-negative number)",
                     require_scene(arm, s));
  DUET_CHECK_REFUSED("duet: the radius of obstacle 0 is nan (expected a non-negative number)",
                     clearance(arm, theta, s));
  scene slanted = cage();
  slanted.obstacles.push_back(half_space<>{{0, 0, 2}, -1});
  DUET_CHECK_REFUSED("duet: the normal of obstacle 3 is not a unit vector",
                     clearance(arm, theta, slanted));
  s.bodies[4].link = 8;
  DUET_CHECK_REFUSED("duet: serial_chain: link 8 does not exist, the chain has 7 joints",
                     require_scene(arm, s));
}

TEST_CASE("clearance: nan coordinates give a nan distance, independent of the order of obstacles") {
  const auto arm = robots::panda().table();
  duet_test::coordinates<7> theta = duet_test::coordinates<7>::Zero();
  theta[6] = std::nan(""); // only link 7 is nowhere
  const collision_body upper{3, sphere<>{{0, 0, 0}, .1}}, hand{7, sphere<>{{0, 0, .1}, .1}};
  const std::vector<obstacle> obstacles = {
      sphere<>{{1, 0, 0}, .1}, capsule<>({1, 0, 0}, {1, 1, 0}, .1), half_space<>{{0, 0, 1}, -1},
      box<>{pose(quaternion<double>(1), vector3<double>(1, 0, 0)), {.1, .1, .1}}};
  for (const auto& bodies : {std::vector{upper, hand}, std::vector{hand, upper}}) {
    for (const obstacle& each : obstacles) {
      CHECK(std::isnan(clearance(arm, theta, scene{bodies, {each}}).distance));
    }
    CHECK(std::isnan(clearance(arm, theta, scene{bodies, obstacles}).distance));
    scene pair_only{bodies, {}};
    pair_only.pairs = {{0, 1}};
    CHECK(std::isnan(clearance(arm, theta, pair_only).distance));
  }
  CHECK(clearance(arm, theta, scene{{upper}, obstacles}).distance < 1);
}

} // namespace
} // namespace test_robotics_clearance
