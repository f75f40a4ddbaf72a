// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: .*from_eigen
// within: 5
// forms: 8

#include <duet/interop/eigen.hpp>
#include <duet/quaternion/curves.hpp>

#include <Eigen/Geometry>

#include <iostream>

using namespace duet;

int main() {
  const Eigen::Quaterniond p(1, 0, 0, 0);
  const Eigen::Vector3d v(1, 2, 3);
  const quaternion<double> q(1);
#if DUET_MUST_FAIL == 1
  const Eigen::Vector3d rotated = rotate(p, v);
#elif DUET_MUST_FAIL == 2
  std::cout << rotate(p, v) << "\n";
#elif DUET_MUST_FAIL == 3
  std::cout << slerp(p, p, 0.5) << "\n";
#elif DUET_MUST_FAIL == 4
  std::cout << q * p << "\n";
#elif DUET_MUST_FAIL == 5
  std::cout << p * q << "\n";
#elif DUET_MUST_FAIL == 6
  const quaternion<double> r = p;
#elif DUET_MUST_FAIL == 7
  std::cout << pose(p, v) << "\n";
#elif DUET_MUST_FAIL == 8
  const dual_quaternion<double> a = Eigen::Isometry3d::Identity();
#else
  const quaternion<double> r = from_eigen(p);
  const dual_quaternion<double> a = from_eigen(Eigen::Isometry3d(p));
  std::cout << rotate(r, v) << slerp(r, r, 0.5) << q * r << r * q << pose(r, v) << a << "\n";
#endif
}
