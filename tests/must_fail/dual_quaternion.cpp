// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Mistakes that must not compile, see check.cmake.

#include <duet/dual_quaternion/distance.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/euler.hpp>

#include <Eigen/Core>

#include <array>
#include <iostream>
#include <vector>

//// distance_without_length
// expect: duet: the characteristic length is missing

int main() {
  const duet::dual_quaternion<double> a(1);
#ifdef DUET_MUST_FAIL
  const double length = distance(a, a);         // mistake
  const double square = squared_distance(a, a); // mistake
#else
  const double length = distance(a, a, 0.5);
  const double square = squared_distance(a, a, 0.5);
#endif
  return length == 0 && square == 0 ? 0 : 1;
}

//// matrix_of_pose
// expect: duet: the matrix of a rotation is rotation_matrix\(q\), that of a pose
// within: 4

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

//// order_of_arguments
// expect: duet: (.*the first argument|the parameter is missing|(transform_point|from_euler) takes)
// within: 2
// forms: 7

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

//// twist_without_frame
// expect: duet: the frame is missing
// within: 5
// forms: 3

int main() {
  const duet::dual_quaternion<double> a(duet::screw_dual<double>(1)), a_dot;
  const duet::vector6<double> v = duet::vector6<double>::Zero();
#if DUET_MUST_FAIL == 1
  const duet::vector6<double> twist = duet::twist(a, a_dot);
#elif DUET_MUST_FAIL == 2
  std::cout << twist(a, a_dot).transpose() << "\n";
#elif DUET_MUST_FAIL == 3
  std::cout << pose_rate(a, v) << "\n";
#else
  std::cout << twist(a, a_dot, duet::frame::hybrid).transpose() << "\n"
            << pose_rate(a, v, duet::frame::body) << "\n";
#endif
}

//// vector_of_others
// expect: duet: [a-z_]* takes rotations, poses and vectors of duet
// within: 5
// forms: 9

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
