// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: the matrix of a rotation is rotation_matrix\(q\), that of a pose
// within: 4

#include <duet/dual_quaternion/pose.hpp>

#include <Eigen/Core>

int main() {
  const duet::quaternion<double> q(1.0);
  const auto a = duet::pose(q, Eigen::Vector3d(1, 2, 3));
#ifdef DUET_MUST_FAIL
  const Eigen::Matrix4d m = a; // mistake
  const Eigen::Matrix3d r = q; // mistake
#else
  const Eigen::Matrix4d m = duet::transform_matrix(a);
  const Eigen::Matrix3d r = duet::rotation_matrix(q);
#endif
  return m(0, 0) == r(0, 0) ? 0 : 1;
}
