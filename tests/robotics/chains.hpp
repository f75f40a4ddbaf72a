// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "kinematics/arms.hpp"
#include "robotics/limits.hpp"
#include "support/test.hpp"

/// \file
/// Chains of any number of joints, so that what searches on them is compiled once.

namespace duet_test {

using any_chain = duet::bounded_chain<16>;
using any_joints = duet::detail::joint_vector<double, -16>;

/// Panda, iiwa14, UR5e and the Baxter's left arm.
inline std::vector<any_chain> known_arms() {
  using namespace duet::robots;
  return {panda().table(), iiwa14().table(), ur5e().table(), baxter_left().table()};
}

/// Three prismatic and three revolute joints whose axes meet in one point.
inline any_chain portal(const duet::joint_limits<>& lengths, const duet::joint_limits<>& angles) {
  std::array<duet::joint<>, 6> joints;
  for (std::size_t i = 0; i < 6; ++i) {
    joints[i].kind = i < 3 ? duet::joint_kind::prismatic : duet::joint_kind::revolute;
    joints[i].axis = {double(i % 3 == 0), double(i % 3 == 1), double(i % 3 == 2)};
    joints[i].limits = i < 3 ? lengths : angles;
  }
  return duet::serial_chain<6>(joints);
}

/// Uniform within the limits and one full turn.
inline any_joints configuration(const any_chain& arm, random_source& random) {
  using std::numbers::pi;
  any_joints theta(arm.size());
  for (int i = 0; i < arm.size(); ++i) {
    theta[i] =
        random.uniform(std::max(arm.limits(i).lower, -pi), std::min(arm.limits(i).upper, pi));
  }
  return theta;
}

/// Arm with a prismatic third joint, with a metre of `unit` units.
inline duet::serial_chain<6> stanford_arm(double unit) {
  using std::numbers::pi;
  return duet::from_dh(std::array<duet::dh_row<>, 6>{
      {{.d = .412 * unit, .alpha = -pi / 2, .limits = {-2.9, 2.9}},
       {.d = .154 * unit, .alpha = pi / 2, .limits = {-2.9, 2.9}},
       {.limits = {.3048 * unit, 1.27 * unit}, .kind = duet::joint_kind::prismatic},
       {.alpha = -pi / 2, .limits = {-2.9, 2.9}},
       {.alpha = pi / 2, .limits = {-1.5, 1.5}},
       {.d = .263 * unit, .limits = {-2.9, 2.9}}}});
}

/// Three revolute joints with parallel axes and a prismatic one.
inline any_chain scara() {
  return duet::from_dh(
      std::array<duet::dh_row<>, 4>{{{.a = .4, .d = .2},
                                     {.a = .3, .alpha = std::numbers::pi},
                                     {.limits = {0, .2}, .kind = duet::joint_kind::prismatic},
                                     {}}});
}

} // namespace duet_test
