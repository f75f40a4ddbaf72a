// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Screw motions of a UR5e through a wrist singularity, from one and from a stretched elbow: the
// range of joint 4, and whether the plan begins with a self-motion.

#include <duet/kinematics/robots.hpp>
#include <duet/robotics/plan_screw_motion.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdio>

namespace {

constexpr auto arm = duet::robots::ur5e();
using joints = Eigen::Matrix<double, 6, 1>;

void show(const char* name, const joints& start, const duet::dual_quaternion<double>& goal) {
  const auto plan = duet::plan_screw_motion(arm, start, goal);
  double lowest = start[3], highest = start[3];
  std::size_t self_motion_steps = 0;
  for (std::size_t k = 1; k < plan.joints.size(); ++k) {
    lowest = std::min(lowest, plan.joints[k][3]);
    highest = std::max(highest, plan.joints[k][3]);
    self_motion_steps += plan.tau[k] == plan.tau[k - 1];
  }
  std::printf("%-24s %-12s tau %.3f, joint 4 within %.2f rad, %s\n", name, to_text(plan.reason),
              plan.tau.back(), highest - lowest,
              self_motion_steps > 0 ? "self-motion first" : "no self-motion");
}

} // namespace

int main() {
  joints start;
  start << .3, -1.2, 1.4, -.6, .5, .2;
  joints end = start;
  end[4] = -.5;
  show("through the wrist", start, arm.pose(end));

  joints singular = start;
  singular[4] = 0;
  end << .4, -1.1, 1.3, -.7, .4, .1;
  show("from the wrist", singular, arm.pose(end));

  joints stretched = start;
  stretched[2] = 0;
  const auto moved = [&](double fraction) {
    const Eigen::Vector3d upper_arm =
        translation(arm.pose(stretched, 2)) - translation(arm.pose(stretched, 1));
    return duet::pose(duet::quaternion<double>(1), Eigen::Vector3d(fraction * upper_arm)) *
           arm.pose(stretched);
  };
  show("from a stretched elbow", stretched, moved(-.3));
  show("outwards from there", stretched, moved(.1));
}
