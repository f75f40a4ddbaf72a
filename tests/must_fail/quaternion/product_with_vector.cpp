// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: a (quaternion|vector|matrix) times a (quaternion|vector|matrix):
// within: 2
// forms: 7

#include <duet/dual_quaternion/pose.hpp>

#include <iostream>

int main() {
  const duet::quaternion<double> q(1);
  const duet::dual_quaternion<double> a(duet::screw_dual<double>(1));
  const Eigen::Vector3d v(1, 2, 3);
  const Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
#if DUET_MUST_FAIL == 1
  std::cout << q * v << "\n";
#elif DUET_MUST_FAIL == 2
  const Eigen::Vector3d rotated = q * v;
#elif DUET_MUST_FAIL == 3
  std::cout << q * (v + v) << "\n";
#elif DUET_MUST_FAIL == 4
  std::cout << v * q << "\n";
#elif DUET_MUST_FAIL == 5
  const Eigen::Vector3d moved = a * v;
#elif DUET_MUST_FAIL == 6
  std::cout << q * r << "\n";
#elif DUET_MUST_FAIL == 7
  const Eigen::Matrix3d rotated = r * q;
#else
  std::cout << rotate(q, v) << transform_point(a, v) << rotation_matrix(q) * r << "\n";
#endif
}
