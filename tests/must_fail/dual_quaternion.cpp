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
  const double length = distance(a, a);              // mistake
  const double square = squared_distance(a, a);      // mistake
  const double length = distance(a, a, 0.5);         // right
  const double square = squared_distance(a, a, 0.5); // right
  return length == 0 && square == 0 ? 0 : 1;
}

//// matrix_of_pose
// expect: duet: the matrix of a rotation is rotation_matrix\(q\), that of a pose
// within: 4

int main() {
  const duet::quaternion<double> q(1.0);
  const auto a = duet::pose(q, Eigen::Vector3d(1, 2, 3));
  const Eigen::Matrix4d m = a;                         // mistake
  const Eigen::Matrix3d r = q;                         // mistake
  const Eigen::Matrix4d m = duet::transform_matrix(a); // right
  const Eigen::Matrix3d r = duet::rotation_matrix(q);  // right
  return m(0, 0) == r(0, 0) ? 0 : 1;
}

//// order_of_arguments
// expect: duet: (.*the first argument|the parameter is missing|(transform_point|from_euler) takes)
// within: 2

using namespace duet;

int main() {
  const quaternion<double> p(1), q(1);
  const Eigen::Vector3d v(1, 2, 3);
  std::cout << rotate(v, q) << "\n";                     // wrong
  const auto rotation_by_half = from_axis_angle(0.5, v); // wrong
  std::cout << slerp(p, q) << "\n";                      // wrong
  std::cout << slerp(0.5, p, q) << "\n";                 // wrong
  std::cout << pose(v, q) << "\n";                       // wrong
  const Eigen::Vector3d moved = transform_point(q, v);   // wrong
  std::cout << from_euler<zyx>(v) << "\n";               // wrong
  std::cout << rotate(q, v) << from_axis_angle(v, 0.5) << slerp(p, q, 0.5)
            << transform_point(pose(q, v), v) << from_euler<zyx>(v[0], v[1], v[2]) << "\n"; // right
}

//// twist_without_frame
// expect: duet: the frame is missing
// within: 5

const duet::dual_quaternion<double> a(duet::screw_dual<double>(1)), a_dot;
const duet::vector6<double> v = duet::vector6<double>::Zero();
const duet::vector6<double> twist = duet::twist(a, a_dot); // wrong
std::cout << twist(a, a_dot).transpose() << "\n";          // wrong
std::cout << pose_rate(a, v) << "\n";                      // wrong
std::cout << twist(a, a_dot, duet::frame::hybrid).transpose() << "\n"
          << pose_rate(a, v, duet::frame::body) << "\n"; // right

//// vector_of_others
// expect: duet: [a-z_]* takes rotations, poses and vectors of duet
// within: 5

using namespace duet;

int main() {
  const quaternion<double> q(1);
  const Eigen::Vector3d a(1, 2, 3), b(3, 2, 1);
  const std::vector<double> c{1, 2, 3};
  const dual_quaternion<double> p = pose(q, a);
  const auto moved = pose(q, c);                      // wrong
  std::cout << pose(q, c) << "\n";                    // wrong
  const auto moved = pose(q, a + b);                  // wrong
  std::cout << pose(q, a + b) << "\n";                // wrong
  std::cout << rotate(q, a + b) << "\n";              // wrong
  std::cout << transform_point(p, c) << "\n";         // wrong
  std::cout << from_rotation_vector(2 * a) << "\n";   // wrong
  std::cout << rotate(q, Eigen::VectorXd(a)) << "\n"; // wrong
  std::cout << rotation(c) << "\n";                   // wrong
  std::cout << pose(q, (a + b).eval()) << rotate(q, vector3<double>(c[0], c[1], c[2]))
            << "\n"; // right
}
