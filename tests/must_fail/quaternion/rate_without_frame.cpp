// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: the frame is missing
// within: 5
// forms: 7

#include <duet/duet.hpp>

#include <iostream>

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
