// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A smooth curve through rotations of a table, with its angular velocity, acceleration and jerk.

#include <duet/quaternion/euler.hpp>
#include <duet/spline/interpolate.hpp>

#include <iostream>
#include <vector>

int main() {
  using rotation = duet::quaternion<double>;

  const std::vector<double> times{0, 1, 2, 3.5, 4, 5}; // they need not be even
  std::vector<rotation> rows;
  for (const double t : times) {
    rows.push_back(duet::from_euler<duet::zyx>(0.5 * t, 0.3 * t * (5 - t) / 5, 0.1));
  }
  using curve = duet::rotation_vector_spline<double>;
  const auto s = duet::interpolate<curve>(times, rows, duet::not_a_knot{});

  std::cout << "     t  yaw      pitch    roll     |omega|  |alpha|\n" << std::fixed;
  std::cout.precision(4);
  for (double t = 0; t <= 5; t += 0.5) {
    const auto m = s.motion(t, duet::frame::spatial);
    std::cout << t;
    for (const double angle : duet::euler<duet::zyx>(s(t))) {
      std::cout << "  " << angle;
    }
    std::cout << "  " << m.velocity.norm() << "  " << m.acceleration.norm() << "\n";
  }
}
