// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Prints every bit of the results of the library's functions.

#include <duet/comparison/compare.hpp>
#include <duet/io/urdf.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/robotics/inverse_kinematics.hpp>
#include <duet/robotics/loop_positions.hpp>
#include <duet/robotics/loop_trace.hpp>
#include <duet/robotics/mobility.hpp>
#include <duet/robotics/plan_screw_motion.hpp>
#include <duet/spline/fit.hpp>

#include <cstddef>
#include <cstdio>
#include <fstream>
#include <vector>

namespace {

void print(const char* what, const auto& numbers, std::ptrdiff_t count) {
  std::printf("%s", what);
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    std::printf(" %a", double(numbers[i]));
  }
  std::printf("\n");
}

void print(const char* what, const duet::quaternion<double>& q) {
  const double numbers[] = {q.w(), q.x(), q.y(), q.z()};
  print(what, numbers, 4);
}

void move_an_arm() {
  const auto arm = duet::robots::panda();
  Eigen::Matrix<double, 7, 1> start;
  start << 0, -.4, .2, -2, .1, 1.7, .3;
  const auto displacement = duet::from_axis_angle(duet::vector3<double>(.6, 0, .8), .5);
  const auto goal = duet::pose(displacement, duet::vector3<double>(.05, .1, -.1)) * arm.pose(start);
  const auto found = duet::inverse_kinematics(arm, goal, start);
  print(duet::to_text(found.reason), found.joints, 7);
  const auto plan = duet::plan_screw_motion(arm, start, goal);
  std::printf("%s, %d waypoints\n", duet::to_text(plan.reason), int(plan.joints.size()));
  for (const auto& joints : plan.joints) {
    print("waypoint", joints, 7);
  }
}

void read_an_arm() {
  std::ofstream("arm.urdf") << R"(<robot name="arm"><link name="a"/><link name="b"/><link name="c"/>
    <joint name="turn" type="continuous"><parent link="a"/><child link="b"/>
      <origin xyz=".1 .2 .3" rpy=".4 .5 .6"/><axis xyz="0 .6 .8"/></joint>
    <joint name="slide" type="prismatic"><parent link="b"/><child link="c"/>
      <limit lower="-.5" upper="1" effort="1" velocity="1"/></joint></robot>)";
  const auto arm = duet::read_urdf("arm.urdf", "a", "c");
  const Eigen::Vector2d joints(.7, .3);
  print(arm.joint_names()[1].c_str(), rotation(arm.pose(joints)));
}

void move_a_mechanism() {
  const auto at = [](double x) { return duet::frame_with_z_axis({x, 0, 0}, {0, 0, 1}); };
  const duet::kinematic_tree tree(
      {.links = {{"ground"}, {"crank"}, {"coupler"}, {"rocker"}},
       .joints = {{"crank", "ground", "crank", {duet::joint_kind::continuous}},
                  {"coupler", "crank", "coupler", {duet::joint_kind::continuous, at(.3)}},
                  {"rocker", "ground", "rocker", {duet::joint_kind::continuous, at(.8)}}}});
  // A parallelogram.
  const duet::closed_chain_mechanism mechanism(
      tree, {{{duet::constraint_kind::revolute, {"coupler", at(.8)}, {"rocker", at(.3)}}}});
  const auto assemblies =
      duet::find_assembly_configurations(mechanism, {0}, Eigen::VectorXd::Constant(1, 1));
  for (const duet::assembly_configuration& each : assemblies.positions) {
    std::printf("found %d times, mobility %d\n", each.hits,
                duet::mobility(mechanism, each.coordinates).mobility);
    print("position", each.coordinates, 3);
    const duet::driven_motion motion(mechanism, each.coordinates, {0});
    print("on", motion(1.3), 3);
    const auto curve = duet::trace(motion);
    print("traced", curve.positions.back(), 3);
    std::printf("%d dead points\n", int(curve.dead_points.size()));
  }
  print("independent", mechanism.independent_coordinates(assemblies.positions[0].coordinates), 1);
}

void draw_curves() {
  std::vector<double> times;
  std::vector<duet::quaternion<double>> rows;
  for (int i = 0; i <= 12; ++i) {
    const double u = .25 * i;
    times.push_back(u + .01 * u * u);
    rows.push_back(duet::exp(duet::vector3<double>(.3 * u, .1 * u * u, .2 - .05 * u * u * u)));
  }
  const auto through =
      duet::interpolate<duet::rotation_vector_spline<double>>(times, rows, duet::not_a_knot{});
  const auto near = duet::fit<duet::cumulative_bspline<double>>(
      times, rows, duet::clamped_knots(std::vector<double>{times[0], times[6], times[12]}, 4));
  for (double u = .1; u < times.back(); u += .37) {
    print("through", through(u));
    print("near", near.curve(u));
  }
}

void judge_a_formula() {
  const auto found = duet::compare(
      "sine",
      [](auto x) {
        using std::sin;
        return sin(x);
      },
      [](auto x) { return x - x * x * x / 6; }, duet::sampler(duet::real_numbers{-1, 1}));
  std::printf("%s%a\n", to_text(found).c_str(), found.errors[0].ulps);
}

} // namespace

int main() {
  judge_a_formula();
  move_an_arm();
  read_an_arm();
  move_a_mechanism();
  draw_curves();
}
