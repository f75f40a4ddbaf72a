// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Rotations as unit quaternions: active, Hamilton's product, scalar first. Angular velocities come
// from the derivative of the motion; the axes, fixed or moving, must be specified.

#include <duet/derivative/derivative.hpp>
#include <duet/quaternion/euler.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>

#include <iostream>

int main() {
  using namespace duet;
  std::cout << std::fixed;
  std::cout.precision(4);

  const auto q = from_axis_angle(vector3<double>(0, 0, 1), 1.5);
  const auto p = from_euler<zyx>(0.3, -0.2, 0.1); // yaw, pitch, roll
  std::cout << "first p, then q, rotate x to "
            << rotate(q * p, vector3<double>(1, 0, 0)).transpose() << "\n";
  std::cout << "the angle from p to q is     " << rotation_vector(conj(p) * q).norm() << " rad\n";

  // A motion: any function of time that returns a quaternion.
  const auto motion = [&](auto t) { return slerp(p, q, t); };
  const auto [at, rate] = derivative(motion, 0.5);
  std::cout << "angular velocity, fixed axes "
            << angular_velocity(at, rate, frame::spatial).transpose() << "\n";
  std::cout << "the same, in moving axes     "
            << angular_velocity(at, rate, frame::body).transpose() << "\n";
  std::cout << "yaw, pitch, roll             ";
  for (const double angle : euler<zyx>(at)) {
    std::cout << angle << " ";
  }
  std::cout << "\n";
}
