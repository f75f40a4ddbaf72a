// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>
#include <duet/kinematics/joined_chain.hpp>

#include <Eigen/Core>

namespace test_kinematics_joined_chain {
namespace {

using namespace duet;

/// A carriage on a helix of radius ½, which rotates twice as fast as it runs around it.
const auto on_helix = [](const auto& x) {
  using std::cos;
  using std::sin;
  using T = std::decay_t<decltype(x)>;
  return pose(from_rotation_vector(vector3<T>(T(0), T(0), T(2 * x))),
              vector3<T>(T(cos(x) / 2), T(sin(x) / 2), T(x * x / 10)));
};
const auto arm = join_chains(robots::ur5e(), custom_joint{on_helix, {.lower = -1, .upper = 2}},
                             robots::panda().table());
using configuration = Eigen::Matrix<double, 14, 1>;

configuration some() {
  configuration theta;
  theta << .1, -.7, .9, -1.3, .4, 1.6, .8, .3, -.7, .1, -2.3, 0, 1.6, .8;
  return theta;
}

template <class Frame>
void check_jacobian(Frame frame) {
  const configuration theta = some();
  const auto by_duals = jacobian([](const auto& x) { return arm.pose(x); }, theta, frame);
  CHECK(jacobian(arm, theta, frame).isApprox(by_duals.jacobian, 1e-14));
}

TEST_CASE("joined_chain: the pose is the product of the parts, the Jacobian that of dual numbers") {
  const configuration theta = some();
  const auto product = robots::ur5e().pose(theta.head<6>().eval()) * on_helix(theta[6]) *
                       robots::panda().pose(theta.tail<7>().eval());
  CHECK(norm(real_part(arm.pose(theta) - product)) < 1e-15);
  CHECK(norm(dual_part(arm.pose(theta) - product)) < 1e-15);
  check_jacobian(frame::spatial);
  check_jacobian(frame::body);
  check_jacobian(frame::hybrid);
}

TEST_CASE("joined_chain: derivatives of the Jacobian") {
  const configuration theta = some();
  const double h = 1e-6;
  const auto slope = derivative(
      [&](const auto& t) {
        using T = std::decay_t<decltype(t)>;
        Eigen::Matrix<T, 14, 1> x = theta.cast<T>();
        x[6] += t;
        return jacobian(arm, x, frame::hybrid);
      },
      0.0);
  configuration low = theta, high = theta;
  low[6] -= h;
  high[6] += h;
  const auto difference =
      ((jacobian(arm, high, frame::hybrid) - jacobian(arm, low, frame::hybrid)) / (2 * h)).eval();
  CHECK((slope.derivative - difference).norm() < 1e-8);
}

TEST_CASE("joined_chain: limits, and inputs of the wrong size") {
  CHECK(arm.limits(6).upper == 2);
  CHECK(arm.limits(7).upper == robots::panda().limits(0).upper);
  CHECK(lower_limits(arm)[6] == -1);
  CHECK(join_chains(custom_joint{on_helix}).limits(0).upper ==
        std::numeric_limits<double>::infinity());
  CHECK(duet_test::message_of<invalid_input>([] { (void)arm.limits(14); }) ==
        "duet: joined_chain: joint 14 does not exist, the chain has 14 joints");
  CHECK(duet_test::message_of<invalid_input>([] {
          (void)arm.pose(std::vector<double>(3));
        }).find("3 coordinates (expected 14)") != std::string::npos);
}

} // namespace
} // namespace test_kinematics_joined_chain
