// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: interpolate makes cumulative_bspline<T>, a cubic, and rotation_vector_spline

#include <duet/spline/interpolate.hpp>

#include <vector>

int main() {
  const std::vector<double> u{0, 1, 2, 3};
  const std::vector<duet::quaternion<double>> q(4, duet::quaternion<double>(1.0));
#ifdef DUET_MUST_FAIL
  static_cast<void>(duet::interpolate<duet::cumulative_bspline<double, 6>>(u, q));
#else
  static_cast<void>(duet::interpolate<duet::cumulative_bspline<double>>(u, q));
#endif
}
