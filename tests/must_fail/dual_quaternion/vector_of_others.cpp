// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: [a-z_]* takes rotations, poses and vectors of duet
// within: 5
// forms: 9

#include <duet/dual_quaternion/pose.hpp>

#include <Eigen/Core>

#include <array>
#include <iostream>
#include <vector>

using namespace duet;

int main() {
  const quaternion<double> q(1);
  const Eigen::Vector3d a(1, 2, 3), b(3, 2, 1);
  const std::vector<double> c{1, 2, 3};
  const dual_quaternion<double> p = pose(q, a);
#if DUET_MUST_FAIL == 1
  const auto moved = pose(q, c);
#elif DUET_MUST_FAIL == 2
  std::cout << pose(q, c) << "\n";
#elif DUET_MUST_FAIL == 3
  const auto moved = pose(q, a + b);
#elif DUET_MUST_FAIL == 4
  std::cout << pose(q, a + b) << "\n";
#elif DUET_MUST_FAIL == 5
  std::cout << rotate(q, a + b) << "\n";
#elif DUET_MUST_FAIL == 6
  std::cout << transform_point(p, c) << "\n";
#elif DUET_MUST_FAIL == 7
  std::cout << from_rotation_vector(2 * a) << "\n";
#elif DUET_MUST_FAIL == 8
  std::cout << rotate(q, Eigen::VectorXd(a)) << "\n";
#elif DUET_MUST_FAIL == 9
  std::cout << rotation(c) << "\n";
#else
  std::cout << pose(q, (a + b).eval()) << rotate(q, vector3<double>(c[0], c[1], c[2])) << "\n";
#endif
}
