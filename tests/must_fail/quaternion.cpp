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
// forms: 3

int main() {
  const duet::quaternion<double> q(1), p(1);
#if DUET_MUST_FAIL == 1
  std::cout << average(p, q) << "\n";
#elif DUET_MUST_FAIL == 2
  std::cout << average(std::array{p, q}) << "\n";
#elif DUET_MUST_FAIL == 3
  std::cout << duet::average(std::vector<Eigen::Quaterniond>(3)) << "\n";
#else
  std::cout << average(std::vector{p, q}) << duet::average({p, q}) << "\n";
#endif
}

//// euler_without_sequence
// expect: duet: the Euler sequence is missing
// within: 2
// forms: 4

using namespace duet;

int main() {
#if DUET_MUST_FAIL == 1
  const auto q = from_euler(0.1, 0.2, 0.3);
#elif DUET_MUST_FAIL == 2
  std::cout << from_euler(zyx, 0.1, 0.2, 0.3) << "\n";
#elif DUET_MUST_FAIL == 3
  std::cout << euler(quaternion<double>(1))[0] << "\n";
#elif DUET_MUST_FAIL == 4
  const Eigen::Matrix3d a = euler_rate_matrix(0.1, 0.2);
#else
  std::cout << euler<zyx>(from_euler<zyx>(0.1, 0.2, 0.3))[0] << euler_rate_matrix<zyx>(0.1, 0.2);
#endif
}

//// hybrid_frame
// expect: duet: an angular velocity is expressed in frame::spatial or frame::body

int main() {
  const duet::quaternion<double> q(1), q_dot;
#ifdef DUET_MUST_FAIL
  const auto omega = angular_velocity(q, q_dot, duet::frame::hybrid);
#else
  const auto omega = angular_velocity(q, q_dot, duet::frame::body);
#endif
  return omega[0] == 0 ? 0 : 1;
}

//// of_eigen
// expect: duet: .*from_eigen
// within: 5
// forms: 8

#include <duet/interop/eigen.hpp>

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

//// of_integers
// expect: duet: a quaternion<T> needs
// within: 5
// forms: 4

int main() {
#if DUET_MUST_FAIL == 1
  const duet::quaternion<int> q(1, 0, 0, 0);
#elif DUET_MUST_FAIL == 2
  std::cout << duet::quaternion<int>(1, 0, 0, 0) << "\n";
#elif DUET_MUST_FAIL == 3
  std::cout << duet::quaternion(1, 0, 0, 0) << "\n";
#elif DUET_MUST_FAIL == 4
  std::cout << rotate(duet::quaternion<int>(1), duet::vector3<double>(1, 2, 3)) << "\n";
#else
  std::cout << duet::quaternion<double>(1, 0, 0, 0) << duet::quaternion(1., 0., 0., 0.) << "\n";
#endif
}

//// product_with_vector
// expect: duet: a (quaternion|vector|matrix) times a (quaternion|vector|matrix):
// within: 2
// forms: 7

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

//// rate_without_frame
// expect: duet: the frame is missing
// within: 5
// forms: 7

#include <duet/duet.hpp>

int main() {
  const duet::quaternion<double> q(1), q_dot;
  const duet::vector3<double> omega(1, 2, 3);
#if DUET_MUST_FAIL == 1
  angular_velocity(q, q_dot);
#elif DUET_MUST_FAIL == 2
  std::cout << angular_velocity(q, q_dot).transpose() << "\n";
#elif DUET_MUST_FAIL == 3
  const auto rate = quaternion_rate(q, omega);
#elif DUET_MUST_FAIL == 4
  std::cout << quaternion_rate(q, omega) << "\n";
#elif DUET_MUST_FAIL == 5
  std::cout << duet::quaternion_rate_matrix(q) << "\n";
#elif DUET_MUST_FAIL == 6
  std::cout << angular_acceleration(q, q_dot, q_dot) << "\n";
#elif DUET_MUST_FAIL == 7
  std::cout << quaternion_acceleration(q, omega, omega) << "\n";
#else
  std::cout << angular_velocity(q, q_dot, duet::frame::body).transpose() << "\n"
            << quaternion_rate(q, omega, duet::frame::body) << "\n"
            << duet::quaternion_rate_matrix(q, duet::frame::body) << "\n"
            << angular_acceleration(q, q_dot, q_dot, duet::frame::body) << "\n"
            << quaternion_acceleration(q, omega, omega, duet::frame::body) << "\n";
#endif
}
