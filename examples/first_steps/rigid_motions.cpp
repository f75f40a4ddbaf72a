// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Rigid motions as unit dual quaternions: the same algebra as rotations, over dual numbers whose ε
// is that of screws.

#include <duet/derivative/derivative.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rotation.hpp>

#include <iostream>

int main() {
  using namespace duet;
  std::cout << std::fixed;
  std::cout.precision(4);

  const auto table = pose(quaternion<double>(1), vector3<double>(1, 0, 0.8));
  const auto cup = pose(from_axis_angle(vector3<double>(0, 0, 1), 0.5),
                        vector3<double>(0.2, 0.1, 0.05)); // in the table's frame
  const auto cup_pose = table * cup;
  std::cout << "the cup is at        " << translation(cup_pose).transpose() << "\n";
  std::cout << "its handle is at     "
            << transform_point(cup_pose, vector3<double>(0.05, 0, 0)).transpose() << "\n";

  // The screw motion from one to the other: a rotation about an axis in space and a translation
  // along it.
  const auto screw = screw_parameters(conj(table) * cup_pose);
  std::cout << "from the table it is rotated by " << screw.angle << " rad and translated by "
            << screw.translation << " m along the axis\n";
  const auto motion = [&](auto t) { return sclerp(table, cup_pose, t); };
  const auto [at, rate] = derivative(motion, 0.5);
  std::cout << "halfway it is at     " << translation(at).transpose() << "\n";
  std::cout << "its twist [v; omega] " << twist(at, rate, frame::hybrid).transpose() << "\n";
}
