// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/mixed_arguments.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>

namespace test_kinematics_mixed_arguments {

using namespace test_support::mixed;

TEST_CASE("arms and equations: constant and differentiated arguments can be mixed") {
  const auto arm = robots::panda();
  using joints = Eigen::Matrix<double, 7, 1>;
  const joints theta = joints::LinSpaced(-0.5, 0.9), rates = joints::LinSpaced(0.7, -0.3);
  check(
      "joint_efforts",
      [&](const auto& at, const auto& wrench) {
        return joint_efforts(arm, at, wrench, frame::spatial);
      },
      theta, xi);
  check(
      "jacobian_rate",
      [&](const auto& at, const auto& moving) {
        return jacobian_rate(arm, at, moving, frame::hybrid);
      },
      theta, rates);
  Eigen::Matrix3d m;
  m << 2, 0.3, -0.4, 0.1, 3, 0.2, -0.5, 0.6, 4;
  check(
      "solve", [](const auto& a, const auto& b) { return solve(a, b); }, m, u);
  check(
      "least_squares", [](const auto& a, const auto& b) { return least_squares(a, b); },
      Eigen::Matrix<double, 3, 2>(m.leftCols<2>()), u);
  const auto f = [](const auto& x) { return x[0] * x[0] * x[1] + x[2] * x[1]; };
  check(
      "directional_derivative",
      [&](const auto& x, const auto& direction) {
        return directional_derivative(f, x, direction).derivative;
      },
      u, v);
  check(
      "hessian_vector_product",
      [&](const auto& x, const auto& direction) {
        return hessian_vector_product(f, x, direction).product;
      },
      u, v);
}

} // namespace test_kinematics_mixed_arguments
