// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: the Euler sequence is missing
// within: 2
// forms: 4

#include <duet/quaternion/euler.hpp>

#include <iostream>

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
