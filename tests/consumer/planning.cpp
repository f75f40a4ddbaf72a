// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A program that links duet::robotics: it plans, assembles a mechanism, and catches errors by their
// types.

#include <duet/kinematics/robots.hpp>
#include <duet/kinematics/tree_loop.hpp>
#include <duet/robotics/closed_tree.hpp>
#include <duet/robotics/inverse_kinematics.hpp>
#include <duet/robotics/plan_screw_motion.hpp>

#include <cmath>
#include <iostream>

namespace {

bool plans() {
  const auto arm = duet::robots::panda();
  Eigen::Matrix<double, 7, 1> start;
  start << 0, -.4, .2, -2, .1, 1.7, .3;
  const auto displacement = duet::from_axis_angle(duet::vector3<double>(.6, 0, .8), .5);
  const auto goal = duet::pose(displacement, duet::vector3<double>(.05, .1, -.1)) * arm.pose(start);
  const auto found = duet::inverse_kinematics(arm, goal, start);
  const auto plan = duet::plan_screw_motion(arm, start, goal);
  std::cout << duet::to_text(found.reason) << ", " << duet::to_text(plan.reason) << '\n';
  return found.reason == duet::stop_reason::reached && plan.reason == duet::stop_reason::reached;
}

/// A planar four-bar; its ground link has the length 0.8.
duet::closed_chain_mechanism four_bar(double crank, double coupler, double rocker) {
  const auto at = [](double x) { return duet::frame_with_z_axis({x, 0, 0}, {0, 0, 1}); };
  const duet::kinematic_tree tree(
      {.links = {{"ground"}, {"crank"}, {"coupler"}, {"rocker"}},
       .joints = {{"crank", "ground", "crank", {duet::joint_kind::continuous}},
                  {"coupler", "crank", "coupler", {duet::joint_kind::continuous, at(crank)}},
                  {"rocker", "ground", "rocker", {duet::joint_kind::continuous, at(.8)}}}});
  return {tree,
          {{{duet::constraint_kind::revolute, {"coupler", at(coupler)}, {"rocker", at(rocker)}}}}};
}

bool assembles() {
  const auto parallelogram = four_bar(.3, .8, .3);
  const Eigen::Vector3d guess(1, -.9, 1.1);
  const Eigen::VectorXd q = parallelogram.assemble(guess, {0});
  std::cout << "mobility " << duet::mobility(parallelogram, q).mobility << '\n';
  return std::abs(q[1] + 1) < 1e-6 && duet::mobility(parallelogram, q).mobility == 1;
}

/// Whether `action` throws an error of this type.
template <class Error>
bool throws(auto action) {
  try {
    action();
  } catch (const Error& error) {
    std::cout << error.what() << '\n';
    return true;
  } catch (...) {
    std::cout << "an error of another type\n";
  }
  return false;
}

} // namespace

int main() {
  const bool fails = throws<duet::loop_closure_failure>(
                         [] { (void)four_bar(.1, .1, .1).assemble(Eigen::Vector3d(1, 1, 1)); }) &&
                     throws<duet::no_convergence>(
                         [] { (void)four_bar(.1, .1, .1).assemble(Eigen::Vector3d(1, 1, 1)); }) &&
                     throws<duet::invalid_input>([] {
                       (void)duet::mobility(four_bar(.3, .8, .3), Eigen::Vector3d(1, 1, 1));
                     });
  return plans() && assembles() && fails ? 0 : 1;
}
