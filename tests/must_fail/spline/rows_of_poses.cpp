// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: [a-z]*: the scalar of the curve differs from that of the samples
// within: 5
// forms: 4

#include <duet/spline/fit.hpp>

#include <iostream>
#include <vector>

using namespace duet;

int main() {
  const std::vector<double> u{0, 1, 2};
  const std::vector<dual_quaternion<double>> poses(3);
  using of_rotations = cumulative_bspline<double>;
  using of_poses = cumulative_bspline<screw_dual<double>>;
#if DUET_MUST_FAIL == 1
  const auto s = interpolate<of_rotations>({0, 1, 2}, poses);
#elif DUET_MUST_FAIL == 2
  std::cout << interpolate<of_rotations>(u, poses).control_points().size() << "\n";
#elif DUET_MUST_FAIL == 3
  std::cout << interpolate<of_poses>(u, std::vector<quaternion<double>>(3)).control_points().size();
#elif DUET_MUST_FAIL == 4
  std::cout << fit<of_rotations>(u, poses, u).rms << "\n";
#else
  std::cout
      << interpolate<of_poses>({0, 1, 2}, poses).control_points().size() << "\n"
      << interpolate<of_rotations>(u, std::vector<quaternion<double>>(3)).control_points().size()
      << fit<of_poses>(u, poses, u).rms << "\n";
#endif
}
