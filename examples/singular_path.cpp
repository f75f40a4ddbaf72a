// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A UR5e's tip along screws that lead through a singularity of the wrist, close by one, from one
// and from a stretched elbow: what joint 4 has to do for it, and where waypoints with the tip in
// place are.

#include <duet/mechanism/robots.hpp>
#include <duet/planning/plan_screw_motion.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdio>

namespace {

constexpr auto arm = duet::robots::ur5e();
using joints = Eigen::Matrix<double, 6, 1>;

void show(const char* name, const joints& start, const duet::dual_quaternion<double>& goal) {
  const auto plan = duet::plan_screw_motion(arm, start, goal);
  double least = start[3], most = start[3];
  std::size_t in_place = 0;
  for (std::size_t k = 1; k < plan.joints.size(); ++k) {
    least = std::min(least, plan.joints[k][3]);
    most = std::max(most, plan.joints[k][3]);
    in_place += plan.tau[k] == plan.tau[k - 1];
  }
  std::printf("%-24s %-12s tau %.3f, joint 4 within %.2f rad, %s\n", name, to_text(plan.reason),
              plan.tau.back(), most - least, in_place > 0 ? "moves in place first" : "never stops");
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
  const auto moved = [&](double way) {
    const Eigen::Vector3d arm_way =
        translation(arm.pose(stretched, 2)) - translation(arm.pose(stretched, 1));
    return duet::pose(duet::quaternion<double>(1), Eigen::Vector3d(way * arm_way)) *
           arm.pose(stretched);
  };
  show("from a stretched elbow", stretched, moved(-.3));
  show("outwards from there", stretched, moved(.1));
}
