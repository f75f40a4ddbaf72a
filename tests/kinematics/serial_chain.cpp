// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/arms.hpp"
#include "support/message.hpp"

#include <duet/duet.hpp>
#include <duet/interop/multiprecision.hpp>

#include <Eigen/Geometry>

namespace test_kinematics_serial_chain {
namespace {

using namespace duet;
using duet_test::coordinates;
using duet_test::max_abs_difference;

using std::numbers::pi;

double pose_difference(const dual_quaternion<double>& a, const dual_quaternion<double>& b) {
  return max_abs_difference(transform_matrix(a), transform_matrix(b));
}

/// Transform of a chain as a product of Eigen's matrices.
struct by_matrices {
  Eigen::Isometry3d value = Eigen::Isometry3d::Identity();

  by_matrices& rotate(const Eigen::Vector3d& axis, double angle) {
    value = value * Eigen::AngleAxisd(angle, axis);
    return *this;
  }
  by_matrices& shift(double x, double y, double z) {
    value = value * Eigen::Translation3d(x, y, z);
    return *this;
  }
};

const Eigen::Vector3d x_axis = Eigen::Vector3d::UnitX();
const Eigen::Vector3d z_axis = Eigen::Vector3d::UnitZ();

static_assert(robots::panda().size() == 7);
static_assert(robots::ur5e().size() == 6);
static_assert(robots::panda().limits(3).upper == -.0698);
static_assert(robots::iiwa14().tip().link == 7);
static_assert(std::is_empty_v<decltype(robots::panda())>);

TEST_CASE("robots: tips are at the positions of the manufacturers' drawings") {
  coordinates<7> theta = coordinates<7>::Zero();
  CHECK(max_abs_difference(translation(robots::iiwa14().pose(theta)),
                           Eigen::Vector3d(0, 0, 1.306)) < 4e-15);
  CHECK(max_abs_difference(
            translation(robots::baxter_left().pose(theta)),
            Eigen::Vector3d(.069 + .36442 + .37429 + .229525, 0, .27035 - .069 - .01)) < 4e-15);
  theta[3] = -pi / 2;
  const auto a = robots::panda().pose(theta);
  CHECK(max_abs_difference(translation(a), Eigen::Vector3d(.3595, 0, .6435)) < 1e-15);
  CHECK(max_abs_difference(transform_direction(a, z_axis), -x_axis) < 4e-15);
  CHECK(max_abs_difference(translation(robots::ur5e().pose(coordinates<6>(coordinates<6>::Zero()))),
                           Eigen::Vector3d(-.8172, -.2329, .0628)) < 1e-15);
}

TEST_CASE("from_dh, from_modified_dh: poses equal products of matrices") {
  const std::array<dh_row<>, 3> rows{
      {{.a = .3, .d = .1, .alpha = .4, .theta = .2},
       {.a = -.2, .d = .5, .alpha = -1.1, .kind = joint_kind::prismatic},
       {.a = .7, .d = -.3, .alpha = 2.5, .theta = -1}}};
  const auto standard = from_dh(rows);
  const auto modified = from_modified_dh(rows, {quaternion<double>(1), {0, 0, .5}});
  for (const auto& theta : duet_test::configurations(standard, 20)) {
    by_matrices a, b;
    for (int i = 0; i < 3; ++i) {
      const dh_row<>& row = rows[std::size_t(i)];
      const bool is_prismatic = row.kind == joint_kind::prismatic;
      const double angle = row.theta + (is_prismatic ? 0 : theta[i]);
      const double d = row.d + (is_prismatic ? theta[i] : 0);
      a.rotate(z_axis, angle).shift(0, 0, d).shift(row.a, 0, 0).rotate(x_axis, row.alpha);
      b.rotate(x_axis, row.alpha).shift(row.a, 0, 0).rotate(z_axis, angle).shift(0, 0, d);
      CHECK(max_abs_difference(transform_matrix(standard.pose(theta, i + 1)), a.value.matrix()) <
            1e-14);
      CHECK(max_abs_difference(transform_matrix(modified.pose(theta, i + 1)), b.value.matrix()) <
            1e-14);
    }
    b.shift(0, 0, .5);
    CHECK(max_abs_difference(transform_matrix(standard.pose(theta)), a.value.matrix()) < 1e-14);
    CHECK(max_abs_difference(transform_matrix(modified.pose(theta)), b.value.matrix()) < 1e-14);
  }
}

TEST_CASE("from_screws: poses equal the product of exponentials") {
  // Screws at the zero configuration: the spatial twists of the links, from derivatives of poses.
  const auto arm = duet_test::every_joint();
  const coordinates<7> zero = coordinates<7>::Zero();
  std::vector<joint_screw<>> screws;
  for (int i = 0; i < 7; ++i) {
    const auto [a, a_dot] = derivative(
        [&](const auto& t) {
          Eigen::Matrix<std::decay_t<decltype(t)>, 7, 1> theta;
          theta.setZero();
          theta[i] = t;
          return arm.pose(theta);
        },
        0.0);
    screws.push_back(dual_vector_of(twist(a, a_dot, frame::spatial)));
  }
  const auto product = from_screws(
      std::array{screws[0], screws[1], screws[2], screws[3], screws[4], screws[5], screws[6]},
      placement<double>(arm.pose(zero)));
  CHECK(product.kind(1) == joint_kind::prismatic);
  CHECK(product.kind(2) == joint_kind::helical);
  CHECK(product.kind(6) == joint_kind::revolute);
  // Translations are in metres: rounding errors are proportional to the distance.
  const auto rounding = [](const dual_quaternion<double>& a) {
    return 1e-14 * (1 + translation(a).norm());
  };
  for (const auto& theta : duet_test::configurations(arm, 20)) {
    dual_quaternion<double> expected(1);
    for (int i = 0; i < 7; ++i) {
      const auto& s = screws[std::size_t(i)];
      vector6<double> twist;
      twist << s.moment[0], s.moment[1], s.moment[2], s.direction[0], s.direction[1],
          s.direction[2];
      expected = expected * exp(dual_vector<double>(dual_vector_of(twist) * (theta[i] / 2)));
      CHECK(pose_difference(product.pose(theta, i + 1), expected) < rounding(expected));
    }
    const double bound = rounding(arm.pose(theta));
    CHECK(pose_difference(product.pose(theta), arm.pose(theta)) < bound);
    CHECK(pose_difference(product.pose(theta), expected * arm.pose(zero)) < bound);
  }
}

TEST_CASE("static_chain: poses equal those of its table") {
  duet_test::for_each_known_arm([](const auto& arm) {
    // Fused operations differ: one rounding per joint, proportional to the distance.
    const auto close = [&](const dual_quaternion<double>& a, const dual_quaternion<double>& b) {
      const double rounding = std::numeric_limits<double>::epsilon();
      return pose_difference(a, b) < double(arm.size()) * rounding * (1 + translation(b).norm());
    };
    for (const auto& theta : duet_test::configurations(arm, 20)) {
      CHECK(close(arm.pose(theta), arm.table().pose(theta)));
      for (int i = 0; i <= arm.size(); ++i) {
        CHECK(close(arm.pose(theta, i), arm.table().pose(theta, i)));
      }
    }
  });
}

TEST_CASE("serial_chain: poses agree with 50 digits and are unit") {
  using wide = real_50;
  duet_test::for_each_arm([](const auto& arm) {
    constexpr int n = std::decay_t<decltype(arm)>::joints;
    for (const auto& theta : duet_test::configurations(arm, 20)) {
      const auto a = arm.pose(theta);
      const Eigen::Matrix<wide, n, 1> exact = theta.template cast<wide>();
      const auto b = arm.pose(exact);
      CHECK(max_abs_difference(transform_matrix(a), transform_matrix(b).template cast<double>()) <
            1e-14);
      CHECK(is_unit(a, 1e-14));
    }
  });
}

TEST_CASE("from_dh: a table in 50 digits has exact right angles") {
  using wide = real_50;
  const wide quarter = constant::pi<wide>() / 2;
  const std::array<dh_row<wide>, 2> rows{
      {{.alpha = quarter}, {.d = wide(1) / 10, .alpha = -3 * quarter}}};
  const auto chain = from_dh(rows);
  const auto m = transform_matrix(chain.pose(Eigen::Matrix<wide, 2, 1>::Zero().eval()));
  CHECK(abs(m(1, 3) + wide(1) / 10) < 1e-49);
  CHECK(abs(m(0, 0) - 1) < 1e-49);
  CHECK(abs(m(1, 1) + 1) < 1e-49);
}

TEST_CASE("serial_chain: at_point displaces the frame of a link") {
  const auto arm = robots::panda().table();
  for (const auto& theta : duet_test::configurations(arm, 5)) {
    const auto at = arm.link(4).at_point({.1, -.2, .3});
    CHECK(max_abs_difference(translation(arm.pose(theta, at)),
                             transform_point(arm.pose(theta, 4), Eigen::Vector3d(.1, -.2, .3))) <
          1e-15);
    CHECK(pose_difference(arm.pose(theta, 0), dual_quaternion<double>(1)) == 0);
  }
}

TEST_CASE("bounded_chain: fixed joints are merged") {
  using wide_chain = bounded_chain<4>;
  std::vector<joint<>> joints(3);
  joints[0].origin.translation = {1, 0, 0};
  joints[1].kind = joint_kind::fixed;
  joints[1].origin.translation = {0, 2, 0};
  joints[2].origin.translation = {0, 0, 3};
  const wide_chain chain{std::span<const joint<>>(joints)};
  CHECK(chain.size() == 2);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(2);
  CHECK(max_abs_difference(translation(chain.pose(zero)), Eigen::Vector3d(1, 2, 3)) == 0);
  const std::array<double, 2> quarter{pi / 2, 0};
  CHECK(max_abs_difference(translation(chain.pose(quarter)), Eigen::Vector3d(-1, 0, 3)) < 1e-15);
}

TEST_CASE("bounded_chain: conversion from serial_chain keeps poses, limits and types") {
  const auto table = robots::baxter_left().table(); // its link frames are not those of its joints
  const bounded_chain<16> chain = table;
  static_assert(!std::is_convertible_v<serial_chain<7>, bounded_chain<6>>);
  for (const auto& theta : duet_test::configurations(table, 3)) {
    CHECK(pose_difference(chain.pose(theta), table.pose(theta)) == 0);
    CHECK(pose_difference(chain.pose(theta, 4), table.pose(theta, 4)) == 0);
  }
  CHECK(chain.limits(3).upper == table.limits(3).upper);
  CHECK(chain.kind(6) == joint_kind::revolute);
}

TEST_CASE("serial_chain: errors name the joint and the value") {
  const auto message = [](const auto& make) { return duet_test::message_of(make); };
  std::array<joint<>, 2> joints;
  joints[1].axis = {0, 0, 2};
  CHECK(message([&] { serial_chain chain(joints); }) ==
        "duet: serial_chain: joint 1: the axis (0, 0, 2) is not a unit vector");
  joints[1].axis = {0, 0, std::nan("")};
  CHECK(message([&] { serial_chain chain(joints); }).find("joint 1: the axis") !=
        std::string::npos);
  joints[1] = {};
  joints[0].limits = {1, -1};
  CHECK(message([&] { serial_chain chain(joints); }) ==
        "duet: serial_chain: joint 0: the limits 1 to -1 contain no coordinate");
  joints[0].limits = {.velocity = -1};
  CHECK(message([&] { serial_chain chain(joints); }) ==
        "duet: serial_chain: joint 0: the velocity limit is -1 (expected >= 0)");
  joints[0] = {};
  joints[1].kind = joint_kind::fixed;
  CHECK(message([&] { serial_chain chain(joints); }) ==
        "duet: serial_chain<2>: 1 moving joints (expected 2)");
  joints[1] = {};
  CHECK(message([&] { bounded_chain<1> chain(joints); }) ==
        "duet: serial_chain: joint 1: the chain has capacity for 1 moving joints");
  joints[1].origin.translation[2] = INFINITY;
  CHECK(message([&] { serial_chain chain(joints); }) ==
        "duet: serial_chain: joint 1: the origin is not finite");
  joints[1].origin = {};
  joints[1].origin.rotation = quaternion<double>(2);
  CHECK(message([&] { serial_chain chain(joints); }) ==
        "duet: serial_chain: joint 1: the rotation (2, 0, 0, 0) of the origin is not a unit "
        "quaternion: normalized(q)");
  const auto arm = robots::panda();
  CHECK(message([&] { (void)arm.pose(Eigen::VectorXd::Zero(6).eval()); }) ==
        "duet: serial_chain: 6 coordinates (expected 7)");
  CHECK(message([&] { (void)arm.pose(coordinates<7>(coordinates<7>::Zero()), 8); }) ==
        "duet: serial_chain: link 8 does not exist, the chain has 7 joints");
  CHECK(message([&] { (void)from_dh(std::array<dh_row<>, 1>{{{.d = std::nan("")}}}); }) ==
        "duet: serial_chain: joint 0: the parameter nan is not a number up to 1e6");
  CHECK(message([&] { (void)from_dh(std::array<dh_row<>, 1>{{{.alpha = 90}}}); }) ==
        "duet: serial_chain: joint 0: the angle 90 exceeds a full turn (expected radians)");
  CHECK(message([] {
          placement<>(quaternion<double>(1, 1, 0, 0), {0, 0, 0});
        }) == "duet: placement: the rotation (1, 1, 0, 0) is not a unit quaternion: normalized(q)");
}

TEST_CASE("serial_chain: rotations with few digits are normalised") {
  joint<> fixed{.kind = joint_kind::fixed, .origin = {{.707, .707, 0, 0}, {0, 0, 0}}};
  joint<> revolute{.origin = {quaternion<double>(1), {0, 1, 0}}};
  const serial_chain<1> chain(std::array{fixed, revolute}, {{.707, 0, .707, 0}, {1, 0, 0}});
  const auto a = chain.pose(std::array{0.0});
  CHECK(is_unit(a));
  CHECK(max_abs_difference(translation(a), Eigen::Vector3d(1, 0, 1)) < 1e-15);
}

TEST_CASE("serial_chain: vectorised sines give the derivatives of long double") {
  const auto arm = duet_test::every_joint();
  const bounded_chain<9> unsized = arm;
  // Joint 3 is beyond the vector sine; all coordinates are the same in both precisions.
  const auto height = [&](const auto& chain, const auto& t, const auto& u) {
    using T = std::decay_t<decltype(t + u)>;
    std::array<T, 7> theta;
    for (std::size_t i = 0; i < 7; ++i) {
      theta[i] = T(double(i) / 8) + t * (1 + double(i) / 4) + u * double(i % 3);
    }
    theta[3] = theta[3] * 4 + 1e7;
    const auto a = chain.pose(theta);
    return T(translation(a)[2] + rotation(a).w());
  };
  const auto check = [&](const auto& chain) {
    const auto along = [&](const auto& t) { return height(chain, t, t); };
    const auto y = derivatives<3>(along, .5);
    const auto expected = derivatives<3>(along, .5L);
    for (std::size_t k = 0; k <= 3; ++k) {
      CHECK(std::abs(double(y[k] - expected[k])) < 2e-14 * std::pow(12, double(k)));
    }
    const auto at = [&](const auto& x) { return height(chain, x[0], x[1]); };
    const auto h = hessian(at, Eigen::Vector2d(.5, -.25));
    const auto h_expected = hessian(at, Eigen::Matrix<long double, 2, 1>(.5L, -.25L));
    CHECK(max_abs_difference(h.hessian, h_expected.hessian.template cast<double>()) < 2e-12);
    const auto derivative_of = [&](const auto& t) {
      return derivative<struct inner>([&](const auto& u) { return height(chain, t, u); }, t)
          .derivative;
    };
    CHECK(std::abs(double(derivative(derivative_of, .5).derivative -
                          derivative(derivative_of, .5L).derivative)) < 2e-12);
  };
  check(arm);
  check(unsized);
  const auto panda = robots::panda();
  check(panda);
  // A NaN only affects the joints after it.
  coordinates<7> broken = coordinates<7>::Constant(.5);
  broken[5] = std::nan("");
  const auto expected = pose_coordinates(panda.pose(coordinates<7>::Constant(.5).eval(), 5));
  CHECK(max_abs_difference(pose_coordinates(panda.pose(broken, 5)), expected) < 1e-15);
  CHECK(std::isnan(panda.pose(broken).w().value()));
}

} // namespace
} // namespace test_kinematics_serial_chain
