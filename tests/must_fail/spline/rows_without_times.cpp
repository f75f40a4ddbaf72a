// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: (interpolate|fit)(: | takes standard vectors)

#include <duet/spline/fit.hpp>

#include <Eigen/Core>

#include <array>
#include <iostream>
#include <vector>

using namespace duet;

int main() {
  using curve = cumulative_bspline<double>;
  const std::vector<double> u{0, 1, 2};
  const std::vector<quaternion<double>> rows(3, quaternion<double>(1));
#if DUET_MUST_FAIL == 1
  const auto s = interpolate<curve>(rows);
#elif DUET_MUST_FAIL == 2
  std::cout << interpolate<curve>(rows, u)(0.5) << "\n";
#elif DUET_MUST_FAIL == 3
  std::cout << interpolate(u, rows)(0.5) << "\n";
#elif DUET_MUST_FAIL == 4
  std::cout << interpolate<cumulative_bspline>(u, rows)(0.5) << "\n";
#elif DUET_MUST_FAIL == 5
  std::cout << interpolate<curve>(u, std::array{rows[0], rows[1]})(0.5) << "\n";
#elif DUET_MUST_FAIL == 6
  std::cout << interpolate<curve>(Eigen::VectorXd(3), rows)(0.5) << "\n";
#elif DUET_MUST_FAIL == 7
  std::cout << fit<curve>(rows, u, u).rms << "\n";
#elif DUET_MUST_FAIL == 8
  std::cout << fit(u, rows, u).rms << "\n";
#elif DUET_MUST_FAIL == 9
  std::cout << fit<curve>(u, rows).rms << "\n";
#elif DUET_MUST_FAIL == 10
  std::cout << fit<curve>(u, rows, fit_options{}).rms << "\n";
#else
  std::cout << interpolate<curve>(u, rows)(0.5) << fit<curve>(u, rows, u, fit_options{}).rms
            << "\n";
#endif
}
