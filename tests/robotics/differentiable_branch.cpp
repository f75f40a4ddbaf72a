// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/duet.hpp>
#include <duet/robotics.hpp>

#include <Eigen/LU>

namespace test_robotics_differentiable_branch {
namespace {

using namespace duet;
using six = Eigen::Matrix<double, 6, 1>;

const auto& arm = robots::ur5e().table();

dual_quaternion<double> example_goal() {
  return pose(from_rotation_vector(Eigen::Vector3d(2, .3, -.4)), Eigen::Vector3d(.3, .2, .35));
}

/// θ̇ = J⁻¹ [v; ω]
six by_jacobian(const six& theta, const six& twist) {
  return Eigen::Matrix<double, 6, 6>(jacobian(arm, theta, frame::hybrid)).lu().solve(twist);
}

TEST_CASE("differentiable_branch: derivatives with respect to the goal, for every branch") {
  const auto goal = example_goal();
  const auto branches = all_inverse_kinematics(arm, goal);
  REQUIRE(branches.solutions.size() == 8);
  for (const auto& s : branches.solutions) {
    const six theta = s.joints;
    const auto moving = [&](const auto& t) {
      using S = std::decay_t<decltype(t)>;
      return dual_quaternion<S>(
          pose(from_rotation_vector(vector3<S>(S(0), t, S(0))), vector3<S>(t, 2 * t, 3 * t)) *
          goal);
    };
    // Spatial twist: the point of the body that is in the base's origin moves by (1, 2, 3).
    const Eigen::Vector3d omega(0, 1, 0);
    six twist;
    twist << Eigen::Vector3d(1, 2, 3) + omega.cross(translation(goal)), omega;
    const auto along = [&](const auto& t) { return differentiable_branch(arm, theta, moving(t)); };
    const auto x = derivatives<2>(along, 0.);
    CHECK((x[0] - theta).norm() < 1e-12);
    CHECK((x[1] - by_jacobian(theta, twist)).norm() < 1e-9 * x[1].norm());
    // The tip moves as the goal does, in the second order too.
    const auto tip = derivatives<2>([&](const auto& t) { return arm.pose(along(t)); }, 0.);
    const auto expected = derivatives<2>(moving, 0.);
    const double sign = real_part(tip[0]).w() * real_part(expected[0]).w() < 0 ? -1 : 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto p = real_part(tip[k]) - sign * real_part(expected[k]);
      const auto q = dual_part(tip[k]) - sign * dual_part(expected[k]);
      CHECK(std::sqrt(squared_norm(p) + squared_norm(q)) < 1e-8 * (1 + x[k].norm()));
    }
  }
}

TEST_CASE("differentiable_branch: derivatives with respect to the geometry of the arm") {
  const auto goal = example_goal();
  const auto branches = all_inverse_kinematics(arm, goal);
  for (const auto& s : branches.solutions) {
    const six theta = s.joints;
    const auto with_tool = [&](const auto& length) {
      using S = std::decay_t<decltype(length)>;
      const auto forward = [&](const auto& x) {
        return arm.pose(x) * pose(quaternion<S>(S(1)), vector3<S>(length, S(0), S(0)));
      };
      return differentiable_branch(forward, theta, goal);
    };
    const auto x = derivatives<1>(with_tool, 0.);
    six twist = six::Zero(); // the flange goes back as the tool gets longer
    twist.head<3>() = -(rotation_matrix(rotation(goal)) * Eigen::Vector3d(1, 0, 0));
    CHECK((x[1] - by_jacobian(theta, twist)).norm() < 1e-9 * x[1].norm());
  }
}

TEST_CASE("differentiable_branch: throws no_convergence where branches meet") {
  six theta;
  theta << .3, -1.1, 1.4, -.5, 0, .2;
  CHECK_THROWS_AS((void)differentiable_branch(arm, theta, arm.pose(theta)), no_convergence);
  DUET_CHECK_REFUSED(
      "duet: differentiable_branch: 7 coordinates (expected 6)",
      differentiable_branch(arm, Eigen::VectorXd(Eigen::VectorXd::Zero(7)), arm.pose(theta)));
}

} // namespace
} // namespace test_robotics_differentiable_branch
