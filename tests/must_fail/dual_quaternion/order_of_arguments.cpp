// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: (.*the first argument|the parameter is missing|(transform_point|from_euler) takes)
// within: 2
// forms: 7

#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/euler.hpp>

#include <iostream>

using namespace duet;

int main() {
  const quaternion<double> p(1), q(1);
  const Eigen::Vector3d v(1, 2, 3);
#if DUET_MUST_FAIL == 1
  std::cout << rotate(v, q) << "\n";
#elif DUET_MUST_FAIL == 2
  const auto rotation_by_half = from_axis_angle(0.5, v);
#elif DUET_MUST_FAIL == 3
  std::cout << slerp(p, q) << "\n";
#elif DUET_MUST_FAIL == 4
  std::cout << slerp(0.5, p, q) << "\n";
#elif DUET_MUST_FAIL == 5
  std::cout << pose(v, q) << "\n";
#elif DUET_MUST_FAIL == 6
  const Eigen::Vector3d moved = transform_point(q, v);
#elif DUET_MUST_FAIL == 7
  std::cout << from_euler<zyx>(v) << "\n";
#else
  std::cout << rotate(q, v) << from_axis_angle(v, 0.5) << slerp(p, q, 0.5)
            << transform_point(pose(q, v), v) << from_euler<zyx>(v[0], v[1], v[2]) << "\n";
#endif
}
