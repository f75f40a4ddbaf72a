// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/arms.hpp"
#include "support/shared_tag.hpp"

#include <duet/duet.hpp>

#include <span>

namespace test_kinematics_jacobian {
namespace {

using namespace duet;
using duet_test::coordinates;
using duet_test::for_each_frame;
using duet_test::max_abs_difference;

TEST_CASE("jacobian: tip, links and points equal dual numbers (N18, N20)") {
  duet_test::for_each_arm([](const auto& arm) {
    const auto point = arm.link(arm.size() - 2).at_point({.3, -.2, .5});
    for (const auto& theta : duet_test::configurations(arm, 20)) {
      for_each_frame([&](auto frame) {
        const auto tip = jacobian<duet_test::shared_tag>([&](const auto& x) { return arm.pose(x); },
                                                         theta, frame)
                             .jacobian;
        CHECK(max_abs_difference(jacobian(arm, theta, frame), tip) < 1e-13);
        const auto on_link = jacobian<duet_test::shared_tag>(
                                 [&](const auto& x) { return arm.pose(x, point); }, theta, frame)
                                 .jacobian;
        CHECK(max_abs_difference(jacobian(arm, theta, frame, point), on_link) < 1e-13);
      });
    }
    const auto theta = duet_test::configurations(arm, 1).back();
    for (int i = 0; i <= arm.size(); ++i) {
      const auto of_link = jacobian<duet_test::shared_tag>(
                               [&](const auto& x) { return arm.pose(x, i); }, theta, frame::hybrid)
                               .jacobian;
      const auto m = jacobian(arm, theta, frame::hybrid, i);
      CHECK(max_abs_difference(m, of_link) < 1e-13);
      CHECK(m.rightCols(arm.size() - i).isZero(0));
    }
  });
}

TEST_CASE("jacobian: the upper rows of the hybrid one are the derivatives of the position") {
  const auto arm = robots::iiwa14().table();
  const auto point = arm.tip().at_point({.1, .2, .3});
  for (const auto& theta : duet_test::configurations(arm, 5)) {
    const auto of_point = jacobian<duet_test::shared_tag>(
                              [&](const auto& x) { return translation(arm.pose(x, point)); }, theta)
                              .jacobian;
    CHECK(max_abs_difference(jacobian(arm, theta, frame::hybrid, point).topRows<3>(), of_point) <
          1e-13);
  }
}

TEST_CASE("pose_and_jacobian: V^s = Ad(A) V^b, and the pose equals that of pose()") {
  duet_test::for_each_known_arm([](const auto& arm) {
    for (const auto& theta : duet_test::configurations(arm, 10)) {
      const auto [a, body] = pose_and_jacobian(arm, theta, frame::body);
      const auto spatial = jacobian(arm, theta, frame::spatial);
      CHECK(max_abs_difference(spatial, Ad(a) * body) < 1e-14);
      CHECK(max_abs_difference(transform_matrix(a), transform_matrix(arm.pose(theta))) == 0);
    }
  });
}

TEST_CASE("jacobian: a static chain equals its table") {
  duet_test::for_each_known_arm([](const auto& arm) {
    for (const auto& theta : duet_test::configurations(arm, 10)) {
      for_each_frame([&](auto frame) {
        CHECK(max_abs_difference(jacobian(arm, theta, frame), jacobian(arm.table(), theta, frame)) <
              4e-15);
        CHECK(max_abs_difference(jacobian(arm, theta, frame, 3),
                                 jacobian(arm.table(), theta, frame, 3)) < 4e-15);
      });
    }
  });
}

TEST_CASE("jacobian: a bounded_chain equals the serial_chain of the same joints") {
  std::vector<joint<>> joints(3);
  joints[1].axis = {0, 1, 0};
  joints[1].origin.translation = {.4, 0, 0};
  joints[2].kind = joint_kind::prismatic;
  const bounded_chain<16> chain{std::span<const joint<>>(joints),
                                {quaternion<double>(1), {1, 2, 3}}};
  const serial_chain<3> same{std::span<const joint<>>(joints), {quaternion<double>(1), {1, 2, 3}}};
  const Eigen::Vector3d theta(.3, -1.2, .7);
  const auto m = jacobian(chain, Eigen::VectorXd(theta), frame::body);
  CHECK(m.cols() == 3);
  CHECK(max_abs_difference(m, jacobian(same, theta, frame::body)) == 0);
  CHECK(max_abs_difference(m, jacobian(chain, std::array{.3, -1.2, .7}, frame::body)) == 0);
  CHECK(max_abs_difference(m, jacobian(chain, std::vector{.3, -1.2, .7}, frame::body)) == 0);
}

TEST_CASE("joint_efforts: τ = Jᵀ F agrees in all frames and has the power of the wrench") {
  const auto arm = duet_test::every_joint();
  duet_test::random_source random(3);
  for (const auto& theta : duet_test::configurations(arm, 10)) {
    vector6<double> wrench;
    coordinates<7> rates;
    for (int i = 0; i < 7; ++i) {
      rates[i] = random.uniform(-1, 1);
      wrench[i % 6] = random.uniform(-1, 1);
    }
    const auto [a, body] = pose_and_jacobian(arm, theta, frame::body);
    const auto efforts = joint_efforts(arm, theta, wrench, frame::body);
    CHECK(efforts.dot(rates) == doctest::Approx(wrench.dot(body * rates)).epsilon(1e-13));
    const vector6<double> spatial = coAd(a) * wrench;
    CHECK(max_abs_difference(efforts, joint_efforts(arm, theta, spatial, frame::spatial)) < 1e-13);
    const vector6<double> hybrid = coAd(pose(rotation(a), Eigen::Vector3d(0, 0, 0))) * wrench;
    CHECK(max_abs_difference(efforts, joint_efforts(arm, theta, hybrid, frame::hybrid)) < 1e-13);
    // A force that supports a weight at the tip: minus the gradient of its potential.
    vector6<double> force = vector6<double>::Zero();
    force[2] = 5;
    const auto potential = [&](const auto& x) { return 5 * translation(arm.pose(x))[2]; };
    CHECK(max_abs_difference(joint_efforts(arm, theta, force, frame::hybrid),
                             gradient(potential, theta).gradient) < 1e-13);
  }
}

} // namespace
} // namespace test_kinematics_jacobian
