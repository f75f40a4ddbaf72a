// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: the frame is missing
// within: 5
// forms: 2

#include <duet/spline/rotation_vector_spline.hpp>

#include <iostream>
#include <vector>

int main() {
  const std::vector<duet::quaternion<double>> rows(2, duet::quaternion<double>(1));
  const std::vector<duet::vector3<double>> velocities(2, duet::vector3<double>::Zero());
#if DUET_MUST_FAIL == 1
  const auto s = duet::hermite_spline({0, 1}, rows, velocities);
#elif DUET_MUST_FAIL == 2
  std::cout << duet::hermite_spline({0, 1}, rows, velocities)(0.5) << "\n";
#else
  std::cout << duet::hermite_spline({0, 1}, rows, velocities, duet::frame::body)(0.5) << "\n";
#endif
}
