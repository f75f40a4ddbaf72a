// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: the frame is missing
// within: 2
// forms: 2

#include <duet/spline/interpolate.hpp>

#include <iostream>
#include <vector>

using namespace duet;

int main() {
  const std::vector<double> u{0, 1, 2};
  const std::vector<quaternion<double>> rows(3, quaternion<double>(1));
  const auto s = interpolate<cumulative_bspline<double>>(u, rows);
#if DUET_MUST_FAIL == 1
  std::cout << s.motion(0.5).velocity << "\n";
#elif DUET_MUST_FAIL == 2
  const auto m = s.motion(0.5);
#else
  std::cout << s.motion(0.5, frame::body).velocity << "\n";
#endif
}
