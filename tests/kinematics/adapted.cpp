// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/arms.hpp"
#include "support/message.hpp"
#include "support/multiprecision.hpp"
#include "support/shared_tag.hpp"

#include <duet/duet.hpp>
#include <duet/io/urdf.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

#include <cstdio>
#include <fstream>

namespace test_kinematics_adapted {
namespace {

using namespace duet;
using duet_test::max_abs_difference;

const auto base =
    pose(from_rotation_vector(Eigen::Vector3d(.4, -1.2, 2)), Eigen::Vector3d(.3, -.7, 1.1));
const auto tool =
    pose(from_rotation_vector(Eigen::Vector3d(-1, .2, .5)), Eigen::Vector3d(.05, .1, -.2));

/// The coordinates except for the i-th.
template <int N>
duet_test::coordinates<N - 1> without(const duet_test::coordinates<N>& theta, int i) {
  duet_test::coordinates<N - 1> result;
  result << theta.head(i), theta.tail(N - 1 - i);
  return result;
}

/// A fixed, a prismatic, a fixed, two revolute joints and another fixed one.
urdf_chain<16> from_file() {
  const std::string path = "test_kinematics_adapted.urdf";
  const auto joint = [](const std::string& name, const std::string& type, char from, char to) {
    return "<link name=\"" + std::string(1, to) + "\"/><joint name=\"" + name + "\" type=\"" +
           type + "\"><parent link=\"" + from + "\"/><child link=\"" + to +
           "\"/><origin xyz=\".1 .2 .3\" rpy=\".3 .2 .1\"/><axis xyz=\"0 .6 .8\"/>"
           "<limit lower=\"-1\" upper=\"2\"/></joint>";
  };
  std::ofstream(path) << "<robot name=\"r\"><link name=\"a\"/>" << joint("f", "fixed", 'a', 'b')
                      << joint("slide", "prismatic", 'b', 'c') << joint("g", "fixed", 'c', 'd')
                      << joint("shoulder", "revolute", 'd', 'e')
                      << joint("elbow", "revolute", 'e', 'g') << joint("h", "fixed", 'g', 'h')
                      << "</robot>";
  auto chain = read_urdf(path, "a", "h");
  std::remove(path.c_str());
  return chain;
}

TEST_CASE("with_tool, with_base: poses, link frames and Jacobians equal the products") {
  duet_test::for_each_arm([](const auto& arm) {
    const auto equipped = with_tool(arm, tool);
    const auto standing = with_base(arm, base);
    static_assert(std::is_same_v<decltype(equipped), const std::decay_t<decltype(arm)>>);
    static_assert(std::is_same_v<decltype(standing), const std::decay_t<decltype(arm)>>);
    const auto both = with_tool(standing, tool);
    for (const auto& theta : duet_test::configurations(arm, 5)) {
      CHECK(max_abs_difference(transform_matrix(equipped.pose(theta)),
                               transform_matrix(arm.pose(theta) * tool)) < 4e-15);
      CHECK(max_abs_difference(transform_matrix(standing.pose(theta)),
                               transform_matrix(base * arm.pose(theta))) < 8e-15);
      for (int i = 1; i <= arm.size(); ++i) {
        CHECK(max_abs_difference(transform_matrix(equipped.pose(theta, i)),
                                 transform_matrix(arm.pose(theta, i))) == 0);
        CHECK(max_abs_difference(transform_matrix(standing.pose(theta, i)),
                                 transform_matrix(base * arm.pose(theta, i))) < 8e-15);
      }
      CHECK(transform_matrix(standing.pose(theta, 0)) == Eigen::Matrix4d::Identity());
      duet_test::for_each_frame([&](auto frame) {
        const auto by_duals = jacobian<duet_test::shared_tag>(
            [&](const auto& x) { return base * arm.pose(x) * tool; }, theta, frame);
        CHECK(max_abs_difference(jacobian(both, theta, frame), by_duals.jacobian) < 4e-14);
      });
    }
    CHECK(lower_limits(both) == lower_limits(arm));
  });
}

TEST_CASE(
    "with_locked_joint: the remaining joints give the poses and Jacobians of the full chain") {
  duet_test::for_each_arm([](const auto& arm) {
    constexpr int n = std::decay_t<decltype(arm)>::joints;
    for (const auto& theta : duet_test::configurations(arm, 5)) {
      for (int i = 0; i < n; ++i) {
        if (!(arm.limits(i).lower <= theta[i] && theta[i] <= arm.limits(i).upper)) {
          continue;
        }
        const auto locked = with_locked_joint(arm, i, theta[i]);
        static_assert(std::is_same_v<decltype(locked), const serial_chain<n - 1>>);
        const auto rest = without<n>(theta, i);
        CHECK(max_abs_difference(transform_matrix(locked.pose(rest)),
                                 transform_matrix(arm.pose(theta))) < 8e-15);
        for (int link = 0; link < n; ++link) {
          CHECK(max_abs_difference(transform_matrix(locked.pose(rest, link)),
                                   transform_matrix(arm.pose(theta, link <= i ? link : link + 1))) <
                8e-15);
          if (link != i) {
            CHECK(locked.limits(link - (link > i)).lower == arm.limits(link).lower);
            CHECK(locked.kind(link - (link > i)) == arm.kind(link));
          }
        }
        duet_test::for_each_frame([&](auto frame) {
          const auto all = jacobian(arm, theta, frame);
          Eigen::Matrix<double, 6, n - 1> expected;
          expected << all.leftCols(i), all.rightCols(n - 1 - i);
          CHECK(max_abs_difference(jacobian(locked, rest, frame), expected) < 2e-14);
        });
      }
    }
  });
}

TEST_CASE(
    "with_tool, with_base, with_locked_joint: results of static chains are constant expressions") {
  constexpr auto arm = robots::panda();
  constexpr auto six =
      with_locked_joint(with_tool(arm, {quaternion<double>(1), {0, 0, .1}}), 2, .5);
  static_assert(std::is_same_v<decltype(six), const serial_chain<6>>);
  static_assert(six.limits(2).upper == arm.limits(3).upper);
  struct on_a_wall {
    static constexpr auto chain() {
      return with_base(robots::panda(), {quaternion<double>(0, 1, 0, 0), {0, 0, 2}});
    }
  };
  constexpr auto hanging = on_a_wall::chain();
  static_assert(std::is_same_v<decltype(hanging), const serial_chain<7>>);
  const Eigen::Matrix<double, 7, 1> theta(.3, -.7, .5, -2.3, .2, 1.6, .8);
  const auto expected = arm.pose(theta) * pose(quaternion<double>(1), Eigen::Vector3d(0, 0, .1));
  CHECK(max_abs_difference(transform_matrix(six.pose(without<7>(theta, 2))),
                           transform_matrix(expected)) < 4e-15);
  CHECK(max_abs_difference(
            translation(hanging.pose(theta)),
            Eigen::Vector3d(
                Eigen::Vector3d(0, 0, 2) +
                translation(arm.pose(theta)).cwiseProduct(Eigen::Vector3d(1, -1, -1)))) < 4e-15);
  // inverse_kinematics of the modified chain reaches the pose of its tool.
  const auto result = inverse_kinematics(six, expected, Eigen::Matrix<double, 6, 1>::Zero().eval());
  CHECK(result.reason == stop_reason::reached);
  CHECK(max_abs_difference(translation(six.pose(result.joints)), translation(expected)) < 1e-6);
}

TEST_CASE(
    "with_locked_joint: poses agree with the full chain to 47 digits in 50-digit arithmetic") {
  using real = duet_test::real_50;
  duet_test::for_each_arm([](const auto& arm_in_double) {
    constexpr int n = std::decay_t<decltype(arm_in_double)>::joints;
    std::array<joint<real>, n> joints;
    for (int i = 0; i < n; ++i) {
      auto& each = joints[std::size_t(i)];
      each.kind = arm_in_double.kind(i);
      const auto axis = normalized(quaternion<real>(0, i + 1, 2 - i, real(1) / 3));
      each.axis = {axis.x(), axis.y(), axis.z()};
      each.origin = {normalized(quaternion<real>(1, i, 2, -i)), {real(i) / 7, 1, real(2) / 3}};
      each.pitch = real(1) / 9;
    }
    const serial_chain<n, real> arm(joints);
    Eigen::Matrix<real, n, 1> theta;
    for (int i = 0; i < n; ++i) {
      theta[i] = real(i - 2) / 3;
    }
    for (int i = 0; i < n; ++i) {
      Eigen::Matrix<real, n - 1, 1> rest;
      rest << theta.head(i), theta.tail(n - 1 - i);
      const auto locked = with_locked_joint(arm, i, theta[i]);
      const auto difference =
          (transform_matrix(locked.pose(rest)) - transform_matrix(arm.pose(theta))).eval();
      CHECK(difference.norm() < real("1e-47"));
    }
  });
}

TEST_CASE("with_tool, with_base, with_locked_joint: a chain from a file keeps its names and link "
          "frames") {
  const auto chain = from_file();
  REQUIRE(chain.size() == 3);
  const std::vector<double> theta{.3, -.6, .8};
  const auto check = [&](const auto& changed, const std::vector<double>& rest, const auto& before) {
    static_assert(std::is_same_v<std::decay_t<decltype(changed)>, urdf_chain<16>>);
    REQUIRE(changed.links().size() == chain.links().size());
    for (const urdf_link& each : chain.links()) {
      const auto expected = before * chain.pose(theta, each.frame);
      CHECK(max_abs_difference(transform_matrix(changed.pose(rest, changed.link(each.name))),
                               transform_matrix(expected)) < 4e-15);
    }
  };
  const dual_quaternion<double> none(1);
  check(with_base(chain, base), theta, base);
  check(with_tool(chain, tool), theta, none);
  check(with_locked_joint(chain, "slide", .3), {-.6, .8}, none);
  check(with_locked_joint(chain, std::string("shoulder"), -.6), {.3, .8}, none);
  check(with_locked_joint(chain, 2, .8), {.3, -.6}, none);
  check(with_base(with_locked_joint(with_locked_joint(chain, 2, .8), "slide", .3), base), {-.6},
        base);
  CHECK(max_abs_difference(transform_matrix(with_tool(chain, tool).pose(theta)),
                           transform_matrix(chain.pose(theta) * tool)) < 4e-15);
  const auto locked = with_locked_joint(chain, "shoulder", -.6);
  CHECK(locked.joint_names() == std::vector<std::string>{"slide", "elbow"});
  const auto still = with_locked_joint(with_locked_joint(locked, 1, .8), 0, .3);
  CHECK(still.size() == 0);
  check(with_base(still, base), {}, base);
  // Limits by name.
  CHECK(with_limits(chain, "elbow", {-.1, .2}).limits(2).upper == .2);
}

TEST_CASE("with_locked_joint: coordinates of any size") {
  const serial_chain<2> chain(std::array<joint<>, 2>{joint<>{.kind = joint_kind::continuous},
                                                     joint<>{.kind = joint_kind::prismatic}});
  const Eigen::Matrix<double, 1, 1> zero(0.);
  for (const double theta : {-1e30, -1e10, -2e9, 1e9, 1e19, 1e300}) {
    CHECK(
        max_abs_difference(rotation_matrix(rotation(with_locked_joint(chain, 0, theta).pose(zero))),
                           rotation_matrix(rotation(chain.pose(Eigen::Vector2d(theta, 0))))) <
        1e-15 + 1e-16 * (std::abs(theta) < 1e10 ? std::abs(theta) : 0));
    CHECK(translation(with_locked_joint(chain, 1, theta).pose(zero))[2] == theta);
  }
}

TEST_CASE("with_locked_joint, with_limits, with_tool: errors name the joint and the value") {
  const auto arm = robots::ur5e();
  const auto chain = from_file();
  const auto message = [](const auto& f) { return duet_test::message_of(f); };
  CHECK(message([&] { (void)with_locked_joint(arm, 2, 4); }) ==
        "duet: with_locked_joint: joint 2: the coordinate 4 is outside the limits -3.14159 to "
        "3.14159");
  CHECK(message([&] { (void)with_locked_joint(arm, 2, std::nan("")); }) ==
        "duet: with_locked_joint: joint 2: the coordinate nan is outside the limits -3.14159 to "
        "3.14159");
  CHECK(message([&] {
          (void)with_locked_joint(serial_chain<2>(std::array<joint<>, 2>{}), 1,
                                  std::numeric_limits<double>::infinity());
        }) ==
        "duet: with_locked_joint: joint 1: the coordinate inf is outside the limits -inf to inf");
  CHECK(
      message([&] { (void)with_locked_joint(chain, "elbow", 4); }) ==
      "duet: with_locked_joint: joint 2 \"elbow\": the coordinate 4 is outside the limits -1 to 2");
  CHECK(
      message([&] { (void)with_locked_joint(chain, 2, 4); }) ==
      "duet: with_locked_joint: joint 2 \"elbow\": the coordinate 4 is outside the limits -1 to 2");
  CHECK(message([&] { (void)with_locked_joint(chain, "elbw", 0); }) ==
        "duet: with_locked_joint: no joint \"elbw\": there are \"elbow\", \"slide\", \"shoulder\"");
  for (const int none : {-1, 6}) {
    CHECK(message([&] { (void)with_locked_joint(arm, none, 0); }) ==
          "duet: with_locked_joint: joint " + std::to_string(none) +
              " does not exist, the chain has 6 moving joints");
  }
  CHECK(message([&] {
          (void)with_limits(chain, "slide", {2, 1});
        }) == "duet: with_limits: joint 0 \"slide\": the limits 2 to 1 contain no coordinate");
  CHECK(message([&] {
          (void)with_limits(chain, "\x1b", {0, 1});
        }) ==
        "duet: with_limits: no joint \"\\x1b\": there are \"slide\", \"elbow\", \"shoulder\"");
  CHECK(message([&] {
          (void)with_limits(chain, std::vector<double>{0, 3, 0}, std::vector<double>{1, 2, 1});
        }) == "duet: with_limits: joint 1 \"shoulder\": the limits 3 to 2 contain no coordinate");
  CHECK(message([&] {
          (void)with_tool(arm, {quaternion<double>(1), {0, std::nan(""), 0}});
        }) == "duet: with_tool: the translation (0, nan, 0) is not finite");
  CHECK(message([&] {
          (void)with_base(arm, {quaternion<double>(1), {HUGE_VAL, 0, 0}});
        }) == "duet: with_base: the translation (inf, 0, 0) is not finite");
  CHECK(message([&] {
          (void)with_tool(arm, {quaternion<double>(1, 1, 0, 0), {0, 0, 0}});
        }).find("not a unit quaternion") != std::string::npos);
}

} // namespace
} // namespace test_kinematics_adapted
