// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: follow_path: the path must return a dual_quaternion<double>

#include <duet/interop/eigen.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/robotics/follow_path.hpp>

int main() {
  using namespace duet;
  const auto arm = robots::panda();
  const Eigen::Matrix<double, 7, 1> start = Eigen::Matrix<double, 7, 1>::Zero();
  const auto moved = [](double u) { return Eigen::Isometry3d(Eigen::Translation3d(0, 0, u)); };
#ifdef DUET_MUST_FAIL
  static_cast<void>(follow_path(arm, start, moved, 0, 1));
#else
  const auto path = [&](double u) { return from_eigen(moved(u)); };
  static_cast<void>(follow_path(arm, start, path, 0, 1));
#endif
}
