// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: [a-z]*: rows of rotations and poses are those of duet
// within: 2
// forms: 5

#include <duet/interop/eigen.hpp>
#include <duet/spline/fit.hpp>

#include <Eigen/Geometry>

#include <iostream>
#include <vector>

using namespace duet;

int main() {
  using curve = cumulative_bspline<double>;
  const std::vector<double> u{0, 1, 2};
#if DUET_MUST_FAIL == 1
  const auto s = interpolate<curve>(u, std::vector<Eigen::Quaterniond>(3));
#elif DUET_MUST_FAIL == 2
  std::cout << interpolate<curve>(u, std::vector<Eigen::Matrix3d>(3))(0.5) << "\n";
#elif DUET_MUST_FAIL == 3
  std::cout << interpolate<curve>(u, std::vector<Eigen::Isometry3d>(3), natural{})(0.5) << "\n";
#elif DUET_MUST_FAIL == 4
  std::cout << fit<curve>(u, std::vector<Eigen::Quaterniond>(3), u).rms << "\n";
#elif DUET_MUST_FAIL == 5
  const auto near = fit<curve>(u, std::vector<Eigen::Matrix3d>(3), u);
#else
  std::vector<quaternion<double>> rows;
  for (const auto& q : std::vector<Eigen::Quaterniond>(3)) {
    rows.push_back(from_eigen(q));
  }
  std::cout << interpolate<curve>(u, rows)(0.5) << fit<curve>(u, rows, u).rms << "\n";
#endif
}
