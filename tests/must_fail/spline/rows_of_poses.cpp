// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: interpolate: the curve is over another scalar than the rows

#include <duet/spline/interpolate.hpp>

#include <vector>

int main() {
  const std::vector<duet::dual_quaternion<double>> poses(3);
#ifdef DUET_MUST_FAIL
  using curve = duet::cumulative_bspline<double>;
#else
  using curve = duet::cumulative_bspline<duet::dual<double, 1, duet::screw_tag>>;
#endif
  const auto s = duet::interpolate<curve>({0, 1, 2}, poses);
  return s.controls().empty() ? 1 : 0;
}
