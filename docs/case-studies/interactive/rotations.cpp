// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A curve through rotations in the browser: the cubic cumulative B-spline, its rates by the correct
// formula and as printed. Rotations are w, x, y, z; rows are at 0, 1, 2 …; spatial axes.

#include "live.hpp"

#include <duet/quaternion/euler.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/interpolate.hpp>
#include <duet/spline/printed.hpp>

#include <cmath>
#include <vector>

namespace {

using rotation = duet::quaternion<double>;
using spline = duet::cumulative_bspline<double>;
using vector3 = duet::vector3<double>;

/// A point of the body, whose path is drawn.
const vector3 mark(1, 0, 0);

rotation rotation_from(const double* q) { return {q[0], q[1], q[2], q[3]}; }

live::writer& operator<<(live::writer& out, const rotation& q) {
  return out << q.w() << q.x() << q.y() << q.z();
}

spline curve_through(int count, const double* rows, int ends) {
  std::vector<double> u;
  std::vector<rotation> q;
  for (int i = 0; i < count; ++i) {
    u.push_back(i);
    q.push_back(rotation_from(rows + 4 * i));
  }
  return ends == 0 ? duet::interpolate<spline>(u, q, duet::not_a_knot{})
                   : duet::interpolate<spline>(u, q, duet::natural{});
}

/// Q′ and Q″ as printed: 0 with functions from B_0, 1 from B_{−1}, 2 with the basis corrected.
void printed_rates(const spline& s, double u, int reading, const rotation& q, live::writer& out) {
  const auto p = duet::printed_derivative(s, u);
  const rotation& first = reading == 0   ? p.from_zero_first
                          : reading == 1 ? p.literal_first
                                         : p.commuting_first;
  const rotation& second = reading == 0   ? p.from_zero_second
                           : reading == 1 ? p.literal_second
                                          : p.commuting_second;
  // 2 vec(q″ q* + q′ q′*), of which the second term is a scalar.
  out << vector3(2 * (first * conj(q)).vec()) << vector3(2 * (second * conj(q)).vec());
}

void write_motion(const spline& s, double u, int reading, live::writer& out) {
  const rotation q = s(u);
  const auto m = s.motion(u, duet::frame::spatial);
  out << u << q << vector3(duet::rotate(q, mark)) << vector3(m.velocity) << vector3(m.acceleration);
  printed_rates(s, u, reading, q, out);
}

} // namespace

/// The initial rows: those of examples/printed_velocity, about one radian apart.
/// \param out  6 rotations
DUET_LIVE void first_rows(double* out) {
  live::writer to(out);
  to << duet::from_euler<duet::zyx>(-1.15, 0.35, 0.0)
     << duet::from_euler<duet::zyx>(-0.75, -0.45, 0.9)
     << duet::from_euler<duet::zyx>(-0.15, -0.65, 1.7)
     << duet::from_euler<duet::zyx>(0.35, 0.1, 2.2) << duet::from_euler<duet::zyx>(0.7, 0.5, 3.0)
     << duet::from_euler<duet::zyx>(1.2, -0.1, 3.8);
}

/// The motion at one parameter.
/// \param rows     `count` rotations
/// \param ends     0 not-a-knot, 1 natural
/// \param reading  of the printed formula: 0 functions from B_0, 1 from B_{−1}, 2 basis corrected
/// \param out      u, Q (4), the mark (3), ω (3), α (3), ω and α as printed (6): 20 numbers
DUET_LIVE void motion_at(int count, const double* rows, int ends, int reading, double u,
                         double* out) {
  live::writer to(out);
  write_motion(curve_through(count, rows, ends), u, reading, to);
}

/// The motion at `samples` even parameters from the first row to the last: as many times 20
/// numbers.
DUET_LIVE void motion_of_curve(int count, const double* rows, int ends, int reading, int samples,
                               double* out) {
  live::writer to(out);
  const spline s = curve_through(count, rows, ends);
  for (int i = 0; i < samples; ++i) {
    const double u = i + 1 == samples ? count - 1 : (count - 1) * double(i) / (samples - 1);
    write_motion(s, u, reading, to);
  }
}

/// The rotation q, rotated by the smallest angle that takes its mark to a direction.
/// \param direction  of any length except 0
/// \param out        a rotation
DUET_LIVE void rotated_to(const double* q, const double* direction, double* out) {
  live::writer to(out);
  const rotation from = rotation_from(q);
  const vector3 a = duet::rotate(from, mark);
  const vector3 b = vector3(direction[0], direction[1], direction[2]).normalized();
  const vector3 axis = a.cross(b);
  const double sine = axis.norm();
  const vector3 rotation_vector =
      sine > 0 ? vector3(axis * (std::atan2(sine, a.dot(b)) / sine)) : vector3(vector3::Zero());
  to << normalized(duet::from_rotation_vector(rotation_vector) * from);
}

/// The rotation q, rotated by an angle about its mark.
/// \param out  a rotation
DUET_LIVE void rotated_about_mark(const double* q, double angle, double* out) {
  live::writer to(out);
  to << normalized(rotation_from(q) * duet::from_rotation_vector(vector3(angle * mark)));
}
