// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Mistakes that must not compile, see check.cmake.

#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/average.hpp>
#include <duet/quaternion/curves.hpp>
#include <duet/quaternion/euler.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Geometry>

#include <array>
#include <iostream>
#include <vector>

//// average_of_two
// expect: duet: average(: rows| takes a (list or )?vector)
// within: 2

const duet::quaternion<double> q(1), p(1);
std::cout << average(p, q) << "\n";                                       // wrong
std::cout << average(std::array{p, q}) << "\n";                           // wrong
std::cout << duet::average(std::vector<Eigen::Quaterniond>(3)) << "\n";   // wrong
std::cout << average(std::vector{p, q}) << duet::average({p, q}) << "\n"; // right

//// euler_without_sequence
// expect: duet: the Euler sequence is missing
// within: 2

using namespace duet;

int main() {
  const auto q = from_euler(0.1, 0.2, 0.3);              // wrong
  std::cout << from_euler(zyx, 0.1, 0.2, 0.3) << "\n";   // wrong
  std::cout << euler(quaternion<double>(1))[0] << "\n";  // wrong
  const Eigen::Matrix3d a = euler_rate_matrix(0.1, 0.2); // wrong
  std::cout << euler<zyx>(from_euler<zyx>(0.1, 0.2, 0.3))[0]
            << euler_rate_matrix<zyx>(0.1, 0.2); // right
}

//// hybrid_frame
// expect: duet: an angular velocity is expressed in frame::spatial or frame::body

const duet::quaternion<double> q(1), q_dot;
const auto omega = angular_velocity(q, q_dot, duet::frame::hybrid); // wrong
const auto omega = angular_velocity(q, q_dot, duet::frame::body);   // right
return omega[0] == 0 ? 0 : 1;

//// of_eigen
// expect: duet: .*from_eigen
// within: 5

#include <duet/interop/eigen.hpp>

using namespace duet;

int main() {
  const Eigen::Quaterniond p(1, 0, 0, 0);
  const Eigen::Vector3d v(1, 2, 3);
  const quaternion<double> q(1);
  const Eigen::Vector3d rotated = rotate(p, v);                       // wrong
  std::cout << rotate(p, v) << "\n";                                  // wrong
  std::cout << slerp(p, p, 0.5) << "\n";                              // wrong
  std::cout << q * p << "\n";                                         // wrong
  std::cout << p * q << "\n";                                         // wrong
  const quaternion<double> r = p;                                     // wrong
  std::cout << pose(p, v) << "\n";                                    // wrong
  const dual_quaternion<double> a = Eigen::Isometry3d::Identity();    // wrong
  const quaternion<double> r = from_eigen(p);                         // right
  const dual_quaternion<double> a = from_eigen(Eigen::Isometry3d(p)); // right
  std::cout << rotate(r, v) << slerp(r, r, 0.5) << q * r << r * q << pose(r, v) << a
            << "\n"; // right
}

//// of_integers
// expect: duet: a quaternion<T> needs
// within: 5

const duet::quaternion<int> q(1, 0, 0, 0);                                             // wrong
std::cout << duet::quaternion<int>(1, 0, 0, 0) << "\n";                                // wrong
std::cout << duet::quaternion(1, 0, 0, 0) << "\n";                                     // wrong
std::cout << rotate(duet::quaternion<int>(1), duet::vector3<double>(1, 2, 3)) << "\n"; // wrong
std::cout << duet::quaternion<double>(1, 0, 0, 0) << duet::quaternion(1., 0., 0., 0.)
          << "\n"; // right

//// product_with_vector
// expect: duet: a (quaternion|vector|matrix) times a (quaternion|vector|matrix):
// within: 2

const duet::quaternion<double> q(1);
const duet::dual_quaternion<double> a(duet::screw_dual<double>(1));
const Eigen::Vector3d v(1, 2, 3);
const Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
std::cout << q * v << "\n";                                                           // wrong
const Eigen::Vector3d rotated = q * v;                                                // wrong
std::cout << q * (v + v) << "\n";                                                     // wrong
std::cout << v * q << "\n";                                                           // wrong
const Eigen::Vector3d moved = a * v;                                                  // wrong
std::cout << q * r << "\n";                                                           // wrong
const Eigen::Matrix3d rotated = r * q;                                                // wrong
std::cout << rotate(q, v) << transform_point(a, v) << rotation_matrix(q) * r << "\n"; // right

//// rate_without_frame
// expect: duet: the frame is missing
// within: 5

#include <duet/duet.hpp>

const duet::quaternion<double> q(1), q_dot;
const duet::vector3<double> omega(1, 2, 3);
angular_velocity(q, q_dot);                                    // wrong
std::cout << angular_velocity(q, q_dot).transpose() << "\n";   // wrong
const auto rate = quaternion_rate(q, omega);                   // wrong
std::cout << quaternion_rate(q, omega) << "\n";                // wrong
std::cout << duet::quaternion_rate_matrix(q) << "\n";          // wrong
std::cout << angular_acceleration(q, q_dot, q_dot) << "\n";    // wrong
std::cout << quaternion_acceleration(q, omega, omega) << "\n"; // wrong
std::cout << angular_velocity(q, q_dot, duet::frame::body).transpose() << "\n"
          << quaternion_rate(q, omega, duet::frame::body) << "\n"
          << duet::quaternion_rate_matrix(q, duet::frame::body) << "\n"
          << angular_acceleration(q, q_dot, q_dot, duet::frame::body) << "\n"
          << quaternion_acceleration(q, omega, omega, duet::frame::body) << "\n"; // right
