// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// One header suffices for interpolation: it has every curve and end condition, rotations and poses.

#include <duet/spline/interpolate.hpp>

#include <vector>

namespace {

using namespace duet;

/// Every curve through samples over T, with every end condition.
template <class T, class V>
void interpolate_all(const std::vector<double>& u, const std::vector<quaternion<T>>& rows,
                     const V& v) {
  const clamped velocity{v, v};
  const end_acceleration acceleration{v, v};
  const std::vector<curve_ends<T>> of_all{natural{}, velocity, acceleration, not_a_knot{},
                                          periodic{}};
  for (const curve_ends<T>& ends : of_all) {
    static_cast<void>(interpolate<cumulative_bspline<T>>(u, rows, ends));
    static_cast<void>(interpolate<rotation_vector_spline<T>>(u, rows, ends));
    static_cast<void>(interpolate<rotation_vector_spline<T, 6>>(u, rows, ends));
  }
  const fully_clamped both{velocity, acceleration};
  static_cast<void>(interpolate<rotation_vector_spline<T, 6>>(u, rows, both));
}

} // namespace

int main() {
  const std::vector<double> u{0, 1, 2, 3, 4, 5};
  const vector3<double> omega(0, 0, 1);
  const vector6<double> twist = vector6<double>::Zero();
  const std::vector rotations(u.size(), from_axis_angle(omega, .1));
  const std::vector poses(u.size(), pose(rotations[0], omega));
  interpolate_all(u, rotations, omega);
  interpolate_all(u, poses, twist);

  interpolation_report report;
  const auto curve = interpolate<rotation_vector_spline<double>>(u, rotations, natural{}, report);
  const motion<double> midpoint_motion = curve.motion(.5, frame::spatial);
  static_cast<void>(
      hermite_spline(u, rotations, std::vector(u.size(), midpoint_motion.velocity), frame::body));
}
