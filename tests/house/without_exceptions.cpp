// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Arithmetic, rotations, curves, arms and robot descriptions compile without exceptions and without
// RTTI, and give known results; errors end in the handler. See without_exceptions.cmake.
//
// usage: without_exceptions [handled|unhandled|returns <error>]

#include <duet/duet.hpp>
#include <duet/io/urdf.hpp>
#include <duet/robotics/inverse_kinematics.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <vector>

using namespace duet;

namespace {

void check(bool holds, const char* what) {
  if (!holds) {
    std::printf("wrong: %s\n", what);
    std::exit(1);
  }
}

template <class A, class B>
bool are_close(const A& a, const B& b) {
  return (a - b).norm() <= 1e-12;
}

void check_arithmetic_and_rotations() {
  const auto [value, slope] = derivative([](auto x) { return x * exp(x * x); }, .3);
  check(std::abs(slope - (1 + 2 * .09) * std::exp(.09)) < 1e-14 && value > 0, "derivative");

  const auto p = from_axis_angle(vector3<double>(0, 0, 1), .2);
  const auto q = from_euler<zyx>(.9, -.4, 1.1);
  const auto [r, r_dot] = derivative([&](auto t) { return slerp(p, q, t * t); }, .5);
  check(are_close(angular_velocity(r, r_dot, frame::spatial),
                  rotate(p, rotation_vector(conj(p) * q))),
        "angular velocity");
  const auto A = pose(p, vector3<double>(1, 2, 3));
  const auto B = pose(q, vector3<double>(0, 1, 2));
  check(are_close(translation(sclerp(A, B, 1.)), translation(B)), "sclerp");
}

auto a_curve() {
  const std::vector<double> u = {0, 1, 2.5, 4};
  std::vector<quaternion<double>> rows;
  for (const double x : u) {
    rows.push_back(from_rotation_vector(vector3<double>(.4 * x, .1 * x * x, .3)));
  }
  return interpolate<cumulative_bspline<double>>(u, rows, natural{});
}

void check_curves() {
  const auto curve = a_curve();
  const std::array<double, 3> u = {.3, 1.7, 3.9};
  std::array<quaternion<double>, 3> values;
  evaluate<cumulative_bspline<double>>(curve, u, values, all_cores);
  for (std::size_t i = 0; i < u.size(); ++i) {
    check(norm(values[i] - curve(u[i])) < 1e-14, "evaluate");
    const auto [q, q_dot] = derivative([&](auto t) { return curve(t); }, u[i]);
    check(are_close(curve.motion(u[i], frame::body).velocity,
                    angular_velocity(q, q_dot, frame::body)),
          "velocity of a curve");
  }
}

void check_arms() {
  const auto arm = robots::panda();
  const std::array<double, 7> theta = {.3, -.7, .1, -2.3, 0, 1.6, .8};
  const auto J = jacobian(arm, theta, frame::hybrid);
  const auto by_duals = jacobian([&](const auto& x) { return arm.pose(x); }, theta, frame::hybrid);
  check(are_close(J, by_duals.jacobian), "Jacobian");
  const auto goal = arm.pose(theta) * pose(from_euler<xyz>(0, .2, 0), vector3<double>(0, 0, .05));
  const auto result = inverse_kinematics(arm, goal, theta);
  check(result.reason == stop_reason::reached, "inverse kinematics");
  check((translation(arm.pose(result.joints)) - translation(goal)).norm() < 1e-6,
        "pose of the resulting joints");
}

void check_descriptions() {
  std::ofstream("without_exceptions.urdf") << R"(<robot><link name="a"/><link name="b"/>
    <joint name="q" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="2"/></joint></robot>)";
  const auto arm = read_urdf("without_exceptions.urdf", "a", "b");
  check(are_close(translation(arm.pose(std::vector<double>{.5})), vector3<double>(0, 0, .5)) &&
            arm.limits(0).upper == 2,
        "an arm from a file");
}

void make(std::string_view error) {
  if (error == "zero") {
    (void)normalized(quaternion<double>(0, 0, 0, 0));
  } else if (error == "row") {
    const std::array<double, 2> u = {1, 9};
    std::array<quaternion<double>, 2> values;
    evaluate<cumulative_bspline<double>>(a_curve(), u, values);
  } else if (error == "joints") {
    (void)robots::panda().pose(std::vector<double>{1, 2});
  } else if (error == "file") {
    std::ofstream("without_exceptions.urdf") << "<robot><link name='a'>\n</robot>";
    (void)read_urdf("without_exceptions.urdf", "a", "a");
  }
}

} // namespace

int main(int count, char** words) {
  if (count == 3) {
    const std::string_view how = words[1];
    if (how == "handled") {
      set_error_handler([](const char* message) {
        std::printf("handled: %s\n", message);
        std::exit(0);
      });
    } else if (how == "returns") {
      set_error_handler([](const char* message) { std::printf("handled: %s\n", message); });
    }
    make(words[2]);
    std::printf("the error went by\n");
    return 0;
  }
  check_arithmetic_and_rotations();
  check_curves();
  check_arms();
  check_descriptions();
  std::printf("all as expected\n");
}
