// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: a function returns an expression of Eigen

#include <duet/kinematics/robots.hpp>
#include <duet/robotics/follow_path.hpp>
#include <duet/robotics/plan_screw_motion.hpp>

namespace {

struct posture {
  Eigen::Matrix<double, 7, 1> wanted;
  auto operator()(const auto& theta) const { return (theta - wanted).squaredNorm(); }
#ifdef DUET_MUST_FAIL
  auto gradient(const auto& theta) const { return 2 * (theta - wanted); }
#else
  auto gradient(const auto& theta) const { return (2 * (theta - wanted)).eval(); }
#endif
};

} // namespace

int main() {
  using namespace duet;
  const auto arm = robots::panda();
  const Eigen::Matrix<double, 7, 1> start = Eigen::Matrix<double, 7, 1>::Zero();
  const auto goal = arm.pose(start);
  const posture preference{start};
#ifdef DUET_MUST_FAIL
  const auto square = [](const auto& theta) { return theta.transpose() * theta; };
  const auto path = [&](double) { return goal; };
  static_cast<void>(plan_screw_motion(arm, start, goal, {}, preference)); // mistake
  static_cast<void>(follow_path(arm, start, path, 0, 1, {}, square));     // mistake
#else
  static_cast<void>(plan_screw_motion(arm, start, goal, {}, preference));
#endif
}
