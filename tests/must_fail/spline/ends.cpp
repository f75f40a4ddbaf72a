// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: (interpolate: the end conditions are natural|rates at the ends are vectors)
// forms: 3

#include <duet/spline/interpolate.hpp>

#include <vector>

int main() {
  const std::vector<double> u{0, 1, 2, 3};
  const std::vector<duet::quaternion<double>> q(4, duet::quaternion<double>(1.0));
  const duet::vector3<double> none = duet::vector3<double>::Zero();
  const duet::fully_clamped both{duet::clamped{none, none}, duet::end_acceleration{none, none}};
#if DUET_MUST_FAIL == 1
  static_cast<void>(duet::interpolate<duet::cumulative_bspline<double>>(u, q, none));
#elif DUET_MUST_FAIL == 2
  static_cast<void>(duet::clamped{0.0, 0.0});
#elif DUET_MUST_FAIL == 3
  static_cast<void>(duet::end_acceleration{0.0, 1.0});
#else
  static_cast<void>(duet::interpolate<duet::cumulative_bspline<double>>(u, q, duet::clamped{}));
  static_cast<void>(duet::interpolate<duet::cumulative_bspline<double>>(u, q));
  static_cast<void>(duet::interpolate<duet::rotation_vector_spline<double, 6>>(u, q, both));
#endif
}
