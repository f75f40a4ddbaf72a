// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: the frame is missing
// within: 5
// forms: 3

#include <duet/dual_quaternion/twist.hpp>

#include <iostream>

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
