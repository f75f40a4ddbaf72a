// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "../support/drawing.hpp"

#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/kinematic_tree.hpp>
#include <duet/kinematics/tree_jacobian.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Drawing of a kinematic tree.

namespace robot_tree_example {

using example::point;

/// Configuration in which the robot of this folder is drawn.
inline constexpr std::array<std::pair<const char*, double>, 15> posture{{{"drive.x", .1},
                                                                         {"drive.y", -.05},
                                                                         {"drive.angle", .25},
                                                                         {"lift", .2},
                                                                         {"pan", .3},
                                                                         {"tilt", .3},
                                                                         {"left_swing", -.5},
                                                                         {"left_raise", .5},
                                                                         {"left_elbow", -1.1},
                                                                         {"left_grip", .03},
                                                                         {"right_swing", -.9},
                                                                         {"right_raise", -.9},
                                                                         {"right_elbow", -1.4},
                                                                         {"right_turn", .8},
                                                                         {"right_grip", .05}}};

/// Links as rods from joint to joint; joint axes as arrows, orange for prismatic joints; the centre
/// of mass as a ball with its projection onto the floor.
class picture {
public:
  picture(const duet::kinematic_tree& robot, const Eigen::VectorXd& q, bool has_mass)
      : robot_(robot), poses_(robot.poses(q)), drawing_({3, -2.2, 1.3}) {
    point low = point::Zero(), high = low;
    for (const auto& pose : poses_) {
      low = low.cwiseMin(duet::translation(pose));
      high = high.cwiseMax(duet::translation(pose));
    }
    size_ = std::max(1e-3, (high - low).norm());
    for (const duet::tree_joint& joint : robot.joints()) {
      add(joint);
    }
    for (int i = -3; i <= 3; ++i) { // the floor, through the root
      const double x = .1 * size_ * i, end = .3 * size_;
      drawing_.line({{x, -end, 0}, {x, end, 0}}, "#c4ccd4", "lw 1", -10 * size_);
      drawing_.line({{-end, x, 0}, {end, x, 0}}, "#c4ccd4", "lw 1", -10 * size_);
    }
    if (has_mass) {
      const point c = duet::centre_of_mass(robot, q);
      drawing_.line({c, {c[0], c[1], 0}}, "#24292f", "lw 1.5 dt 2", 10 * size_);
      drawing_.capsule(c, c, .022 * size_, "#24292f", 10 * size_);
      label_ = "set label 'centre of mass' at " + drawing_.at(c) + " offset 2.5,0 front\n";
    }
  }

  [[nodiscard]] std::string csv() const { return drawing_.csv(); }
  [[nodiscard]] std::string script(const std::string& file) const {
    return label_ + drawing_.script(file);
  }

private:
  void add(const duet::tree_joint& joint) {
    const auto& child = poses_[std::size_t(robot_.link(joint.child).link)];
    const auto& parent = poses_[std::size_t(robot_.link(joint.parent).link)];
    const point from = duet::translation(parent), to = duet::translation(child);
    const bool is_base = joint.motion.coordinates() > 1;
    if (!is_base && (to - from).norm() > .001 * size_) {
      drawing_.capsule(from, to, .011 * size_, joint.mimic ? "#9aa5b1" : "#7fa8c9");
    }
    const Eigen::Matrix3d rotation = duet::rotation_matrix(duet::rotation(child));
    const point axis(joint.motion.axis[0], joint.motion.axis[1], joint.motion.axis[2]);
    switch (joint.motion.kind) {
    case duet::joint_kind::fixed:
      return;
    case duet::joint_kind::planar:
    case duet::joint_kind::spherical:
    case duet::joint_kind::floating:
      for (int k = 0; k < 3; ++k) {
        arrow(to, rotation.col(k), "#a8497c");
      }
      return;
    default:
      arrow(to, rotation * axis, joint.motion.is_translational() ? "#b37700" : "#d55e00");
    }
  }
  void arrow(const point& at, const point& along, const std::string& colour) {
    drawing_.arrow(at, at + .07 * size_ * along, colour, "lw 2");
  }

  const duet::kinematic_tree& robot_;
  std::vector<duet::dual_quaternion<double>> poses_;
  example::drawing drawing_;
  double size_ = 1;
  std::string label_;
};

} // namespace robot_tree_example
