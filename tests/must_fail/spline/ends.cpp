// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: interpolate: the ends are natural

#include <duet/spline/interpolate.hpp>

#include <vector>

int main() {
  const std::vector<double> u{0, 1, 2, 3};
  const std::vector<duet::quaternion<double>> q(4, duet::quaternion<double>(1.0));
  const duet::vector3<double> none = duet::vector3<double>::Zero();
  const duet::fully_clamped both{duet::clamped{none, none}, duet::end_acceleration{none, none}};
#ifdef DUET_MUST_FAIL
  static_cast<void>(duet::interpolate<duet::cumulative_bspline<double>>(u, q, none));
#else
  static_cast<void>(duet::interpolate<duet::cumulative_bspline<double>>(u, q));
  static_cast<void>(duet::interpolate<duet::rotation_vector_spline<double, 6>>(u, q, both));
#endif
}
