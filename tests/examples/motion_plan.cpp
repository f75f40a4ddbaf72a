// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// The collision bodies of the example motion_plan.

#include "../../examples/motion_plan/options.hpp"
#include "support/test.hpp"

namespace test_examples_motion_plan {

// In every configuration each body extends from one frame to the next, and the last one to the tip:
// for the UR5e (classic Denavit–Hartenberg convention) and for the Panda (modified convention).
TEST_CASE("motion_plan: the capsule of each link extends from its frame to the next one") {
  const example::arm_chain arms[] = {duet::robots::ur5e().table(), duet::robots::panda().table()};
  for (const example::arm_chain& arm : arms) {
    const auto bodies = motion_plan_example::bodies(arm, .05);
    REQUIRE(bodies.size() == std::size_t(arm.size()));
    Eigen::VectorXd theta(arm.size());
    for (int i = 0; i < arm.size(); ++i) {
      theta[i] = .3 + .4 * i;
    }
    for (int i = 0; i < arm.size(); ++i) {
      const duet::collision_body& body = bodies[std::size_t(i)];
      const auto body_in_base = duet::transformed(arm.pose(theta, body.link), body.shape);
      const Eigen::Vector3d from = duet::translation(arm.pose(theta, i + 1));
      const Eigen::Vector3d to =
          duet::translation(i + 1 < arm.size() ? arm.pose(theta, i + 2) : arm.pose(theta));
      const auto ends = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
        return (body_in_base.from - a).norm() + (body_in_base.to - b).norm();
      };
      CHECK(std::min(ends(from, to), ends(to, from)) < 1e-12);
      CHECK(body_in_base.radius == .05);
    }
  }
}

} // namespace test_examples_motion_plan
