// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/arms.hpp"
#include "support/message.hpp"

#include <duet/duet.hpp>
#include <duet/io/urdf.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

#include <cstdio>
#include <fstream>

namespace test_kinematics_limits {
namespace {

using namespace duet;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A prismatic joint, then a continuous one.
urdf_chain<16> from_file() {
  const std::string path = "test_kinematics_limits.urdf";
  std::ofstream(path) << "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>"
                         "<joint name=\"p\" type=\"prismatic\"><parent link=\"a\"/>"
                         "<child link=\"b\"/><axis xyz=\"0 0 1\"/>"
                         "<limit lower=\"-1\" upper=\"2\" velocity=\"3\" effort=\"1\"/></joint>"
                         "<joint name=\"q\" type=\"continuous\"><parent link=\"b\"/>"
                         "<child link=\"c\"/></joint></robot>\n";
  auto chain = read_urdf(path, "a", "c");
  std::remove(path.c_str());
  return chain;
}

TEST_CASE("with_limits: changes the limits, but no pose and no velocity limit") {
  duet_test::for_each_arm([](const auto& arm) {
    const auto before = arm;
    auto lower = lower_limits(arm);
    auto upper = upper_limits(arm);
    for (int i = 0; i < arm.size(); ++i) {
      lower[i] = -0.1 - i;
      upper[i] = 0.2 + i;
    }
    const auto changed = with_limits(arm, lower, upper);
    static_assert(std::is_same_v<decltype(changed), const std::decay_t<decltype(arm)>>);
    CHECK(lower_limits(changed) == lower);
    CHECK(upper_limits(changed) == upper);
    CHECK(lower_limits(arm) == lower_limits(before));
    for (const auto& theta : duet_test::configurations(arm, 3)) {
      CHECK(changed.pose(theta) == arm.pose(theta));
      CHECK(changed.pose(theta, 2) == arm.pose(theta, 2));
    }
    for (int i = 0; i < arm.size(); ++i) {
      CHECK(changed.limits(i).velocity == arm.limits(i).velocity);
      const bool is_continuous = arm.kind(i) == joint_kind::continuous;
      CHECK(changed.kind(i) == (is_continuous ? joint_kind::revolute : arm.kind(i)));
    }
    const auto back = with_limits(changed, lower_limits(arm), upper_limits(arm));
    CHECK(lower_limits(back) == lower_limits(arm));
    CHECK(upper_limits(back) == upper_limits(arm));
  });
}

TEST_CASE("with_limits: a single joint of a static chain, respected by inverse_kinematics") {
  constexpr auto arm = robots::panda();
  constexpr auto narrow = with_limits(arm, 3, {.lower = -2, .upper = -1});
  static_assert(std::is_same_v<decltype(narrow), const serial_chain<7>>);
  static_assert(narrow.limits(3).lower == -2 && narrow.limits(3).upper == -1);
  CHECK(narrow.limits(3).velocity == infinity);
  CHECK(narrow.limits(2).lower == arm.limits(2).lower);
  CHECK(narrow.limits(4).upper == arm.limits(4).upper);
  auto limits = arm.limits(6);
  limits.upper = 9;
  CHECK(with_limits(narrow, 6, limits).limits(6).velocity == arm.limits(6).velocity);
  CHECK(with_limits(narrow, 6, limits).limits(3).upper == -1);
  const auto wide =
      with_limits(arm, std::vector<int>(7, -4), std::array<double, 7>{4, 4, 4, 4, 4, 4, 4});
  CHECK(wide.limits(0).lower == -4);
  CHECK(wide.limits(6).upper == 4);

  // inverse_kinematics respects the changed limits.
  const Eigen::Matrix<double, 7, 1> start(0, -.8, 0, -1.5, 0, 1.6, .8),
      target(.3, -.6, .2, -2.4, .1, 1.9, .5);
  const auto goal = arm.pose(target);
  const auto result = inverse_kinematics(narrow, goal, start);
  const auto free = inverse_kinematics(arm, goal, start);
  CHECK(free.reason == stop_reason::reached);
  CHECK(free.joints[3] < -2);
  CHECK(result.joints[3] >= -2);
}

TEST_CASE("with_limits: a chain from a file keeps its names") {
  const auto chain = from_file();
  const auto locked = with_limits(chain, 1, {0, 0});
  static_assert(std::is_same_v<decltype(locked), const urdf_chain<16>>);
  CHECK(locked.joint_names() == std::vector<std::string>{"p", "q"});
  CHECK(locked.link("b").link == chain.link("b").link);
  CHECK(locked.limits(0).velocity == 3);
  CHECK(locked.limits(1).upper == 0);
  CHECK(chain.kind(1) == joint_kind::continuous);
  CHECK(locked.kind(1) == joint_kind::revolute);
  CHECK(with_limits(chain, 1, {.velocity = 2}).kind(1) == joint_kind::continuous);
  CHECK(with_limits(chain, 1, {.upper = 2}).kind(1) == joint_kind::revolute);
  CHECK(with_limits(chain, 1, {.lower = 2}).kind(1) == joint_kind::revolute);
  CHECK(with_limits(chain, 0, {0, 1}).kind(0) == joint_kind::prismatic);
}

TEST_CASE("with_limits: errors name the joint and the value") {
  const auto arm = robots::ur5e();
  const auto message = [&](int i, const joint_limits<>& limits) {
    return duet_test::message_of<invalid_input>([&] { (void)with_limits(arm, i, limits); });
  };
  CHECK(message(2, {1, -1}) ==
        "duet: with_limits: joint 2: the limits 1 to -1 contain no coordinate");
  CHECK(message(2, {std::nan(""), 1}) ==
        "duet: with_limits: joint 2: the limits nan to 1 contain no coordinate");
  CHECK(message(2, {0, std::nan("")}) ==
        "duet: with_limits: joint 2: the limits 0 to nan contain no coordinate");
  CHECK(message(2, {infinity, infinity}) ==
        "duet: with_limits: joint 2: the limits inf to inf contain no coordinate");
  CHECK(message(2, {-infinity, -infinity}) ==
        "duet: with_limits: joint 2: the limits -inf to -inf contain no coordinate");
  CHECK(message(0, {.velocity = -1}) ==
        "duet: with_limits: joint 0: the velocity limit is -1 (expected >= 0)");
  CHECK(message(0, {.velocity = std::nan("")}) ==
        "duet: with_limits: joint 0: the velocity limit is nan (expected >= 0)");
  for (const int none : {-1, 6}) {
    CHECK(message(none, {}) == "duet: with_limits: joint " + std::to_string(none) +
                                   " does not exist, the chain has 6 moving joints");
  }
  const Eigen::VectorXd five = Eigen::VectorXd::Constant(5, -1);
  Eigen::VectorXd six = Eigen::VectorXd::Constant(6, 1);
  CHECK(duet_test::message_of([&] { (void)with_limits(arm, five, six); }) ==
        "duet: with_limits: 5 lower and 6 upper limits for 6 moving joints");
  CHECK(duet_test::message_of([&] { (void)with_limits(arm, six, five); }) ==
        "duet: with_limits: 6 lower and 5 upper limits for 6 moving joints");
  six[4] = 2;
  CHECK(duet_test::message_of([&] {
          (void)with_limits(arm, six, Eigen::VectorXd::Ones(6).eval());
        }) == "duet: with_limits: joint 4: the limits 2 to 1 contain no coordinate");
}

} // namespace
} // namespace test_kinematics_limits
