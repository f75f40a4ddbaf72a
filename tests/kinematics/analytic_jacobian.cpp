// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/arms.hpp"
#include "support/shared_tag.hpp"

#include <duet/duet.hpp>

namespace test_kinematics_analytic_jacobian {
namespace {

using namespace duet;
using duet_test::max_abs_difference;

template <euler_sequence Sequence, class Chain, class X>
void check_euler(const Chain& arm, const X& theta) {
  const auto coordinates_of = [](const auto& a) {
    const auto t = translation(a);
    const auto angles = euler<Sequence>(rotation(a));
    return std::array{t[0], t[1], t[2], angles[0], angles[1], angles[2]};
  };
  const auto by_duals = jacobian<duet_test::shared_tag>(
                            [&](const auto& x) { return coordinates_of(arm.pose(x)); }, theta)
                            .jacobian;
  const auto closed = euler_jacobian<Sequence>(arm, theta);
  // Near gimbal lock both grow, and their errors with them.
  const double size = std::max(1.0, by_duals.cwiseAbs().maxCoeff());
  CAPTURE(size);
  CHECK(max_abs_difference(closed, by_duals) < 1e-13 * size * size);
}

template <class Chain>
void check_sequences(const Chain& arm, int count) {
  const auto all = duet_test::configurations(arm, count);
  for (std::size_t i = 5; i < all.size(); ++i) { // without those in gimbal lock
    const auto& theta = all[i];
    check_euler<xyz>(arm, theta);
    check_euler<yzx>(arm, theta);
    check_euler<zxy>(arm, theta);
    check_euler<xzy>(arm, theta);
    check_euler<yxz>(arm, theta);
    check_euler<zyx>(arm, theta);
    check_euler<xyx>(arm, theta);
    check_euler<yzy>(arm, theta);
    check_euler<zxz>(arm, theta);
    check_euler<xzx>(arm, theta);
    check_euler<yxy>(arm, theta);
    check_euler<zyz>(arm, theta);
  }
}

TEST_CASE("pose_coordinates_jacobian: equals dual numbers, and J2 times it is the spatial Jacobian "
          "(N20, N21)") {
  duet_test::for_each_arm([](const auto& arm) {
    const auto point = arm.link(4).at_point({.3, -.2, .5});
    for (const auto& theta : duet_test::configurations(arm, 20)) {
      const auto check = [&](const auto&... at) {
        const auto closed = pose_coordinates_jacobian(arm, theta, at...);
        const auto by_duals =
            jacobian<duet_test::shared_tag>(
                [&](const auto& x) { return pose_coordinates(arm.pose(x, at...)); }, theta)
                .jacobian;
        CHECK(max_abs_difference(closed, by_duals) < 1e-13);
        CHECK(max_abs_difference(pose_rate_matrix(arm.pose(theta, at...)) * closed,
                                 jacobian(arm, theta, frame::spatial, at...)) < 1e-13);
      };
      check();
      check(point);
    }
  });
}

TEST_CASE("euler_jacobian: equals dual numbers for all twelve sequences") {
  check_sequences(duet_test::every_joint(), 8);
}

} // namespace
} // namespace test_kinematics_analytic_jacobian
