// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/arms.hpp"
#include "support/lanes.hpp"

#include <duet/kinematics/jacobian.hpp>
#include <duet/motion/resolved_motion.hpp>

#include <Eigen/LU>

namespace test_motion_resolved_motion {
namespace {

using namespace duet;
using duet_test::max_abs_difference;

TEST_CASE("N22: B γ̇ moves the tip by γ̇ with least-norm joint rates") {
  const auto arm = robots::panda();
  const auto all = duet_test::configurations(arm.table(), 20);
  for (std::size_t i = 5; i < all.size(); ++i) { // the others are singular
    const auto& theta = all[i];
    const auto b = resolved_rate_matrix(arm, theta);
    const auto m = jacobian(arm, theta, frame::spatial);
    const auto j2 = pose_rate_matrix(arm.pose(theta));
    CHECK(max_abs_difference(m * b, j2) < 1e-10);
    // ∂γ/∂Θ B is the projection onto the rates of unit quaternions.
    const auto by_gamma = pose_coordinates_jacobian(arm, theta);
    const Eigen::Matrix<double, 7, 7> projection = by_gamma * b;
    CHECK(max_abs_difference(projection * projection, projection) < 1e-10);
    CHECK(max_abs_difference(projection * by_gamma, by_gamma) < 1e-10);
    // Least norm: the rates B have no component in the null space of m, which has one dimension.
    Eigen::Matrix<double, 7, 1> in_place;
    for (int k = 0; k < 7; ++k) { // minors, with alternating signs
      Eigen::Matrix<double, 6, 6> minor;
      minor << m.leftCols(k), m.rightCols(6 - k);
      in_place[k] = (k % 2 == 0 ? 1 : -1) * minor.determinant();
    }
    in_place.normalize();
    CHECK(max_abs_difference(m * in_place, vector6<double>::Zero()) < 1e-12);
    CHECK(max_abs_difference(in_place.transpose() * b, Eigen::Matrix<double, 1, 7>::Zero()) <
          1e-10);
  }
}

TEST_CASE("N23: a step leaves an error of second order, for either sign of the pose") {
  const auto arm = robots::panda();
  const auto theta = duet_test::configurations(arm.table(), 1).back();
  const auto current = arm.pose(theta);
  double before = 0;
  for (const double h : {1e-2, 1e-3, 1e-4}) {
    const vector6<double> small = h * vector6<double>(1, -.5, .3, .8, -.2, .4);
    const auto next = manifold<dual_quaternion<double>>::plus(current, small, frame::body);
    const auto step = resolved_step(arm, theta, next, 1);
    CHECK(max_abs_difference(step, resolved_step(arm, theta, dual_quaternion<double>(-next), 1)) ==
          0);
    const double error =
        max_abs_difference(transform_matrix(arm.pose(step)), transform_matrix(next));
    if (before > 0) {
      CHECK(error / before == doctest::Approx(1e-2).epsilon(.1));
    }
    before = error;
    const auto half = resolved_step(arm, theta, next, .5);
    CHECK(max_abs_difference(half - theta, (step - theta) / 2) < 1e-15);
  }
}

TEST_CASE("N22: a rank-deficient Jacobian is rejected") {
  const std::array<joint<>, 6> joints{}; // all about one axis
  CHECK_THROWS_AS((void)resolved_rate_matrix(serial_chain<6>(joints),
                                             Eigen::Matrix<double, 6, 1>::Zero().eval()),
                  invalid_input);
}

TEST_CASE("N22, N23: lanes agree with scalar results, also for nearly singular Jacobians") {
  const auto arm = robots::panda();
  auto all = duet_test::configurations(arm.table(), 8);
  all.erase(all.begin(), all.begin() + 5); // those of no full rank
  all.push_back(all[0]);
  all.back()[3] = -1e-3; // the elbow nearly stretched
  std::vector<dual_quaternion<double>> next;
  std::vector<Eigen::Matrix<dual<double>, 7, 1>> moving;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const vector6<double> small = 1e-2 * vector6<double>(1, -.5, .3, .8, -.2, double(i) - 4);
    const auto pose = arm.pose(all[i]);
    next.push_back(manifold<dual_quaternion<double>>::plus(pose, small, frame::body));
    if (i % 3 == 0) { // the sign further away
      next.back() = dual_quaternion<double>(-next.back());
    }
    moving.emplace_back();
    for (int j = 0; j < 7; ++j) {
      moving.back()[j] = dual<double>(all[i][j], 1 - .3 * j);
    }
  }
  // J Jᵀ is badly conditioned at the last: the more do the last places of sines count.
  const double limit = 1e4;
  duet_test::check_lanes<4>([&](const auto& x) { return resolved_rate_matrix(arm, x); }, limit,
                            all);
  duet_test::check_lanes<4>(
      [&](const auto& x, const auto& a) { return resolved_step(arm, x, a, .7); }, limit, all, next);
  duet_test::check_lanes<8>(
      [&](const auto& x, const auto& a) { return resolved_step(arm.table(), x, a, .7); }, limit,
      all, next);
  duet_test::check_lanes<4>(
      [&](const auto& x, const auto& a) { return resolved_step(arm, x, a, .7); }, limit, moving,
      next);
}

TEST_CASE("N22: a rank-deficient Jacobian in one lane is rejected") {
  using B = batch<double, 4>;
  const auto arm = robots::panda();
  Eigen::Matrix<B, 7, 1> theta;
  for (int j = 0; j < 7; ++j) {
    theta[j] = B(.2 - .3 * j);
  }
  CHECK_NOTHROW((void)resolved_rate_matrix(arm, theta));
  for (int j = 0; j < 7; ++j) {
    theta[j].set(1, 0);
  }
  CHECK_THROWS_AS((void)resolved_rate_matrix(arm, theta), invalid_input);
}

} // namespace
} // namespace test_motion_resolved_motion
