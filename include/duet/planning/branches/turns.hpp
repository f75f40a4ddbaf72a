// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/vector_sine_cosine.hpp>
#include <duet/planning/branches/angle_pairs.hpp>
#include <duet/planning/branches/joint_loop.hpp>
#include <duet/planning/planning_model.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <cmath>

/// \file
/// Turns about given axes that take vectors, or all of them, to given ones.

namespace duet::detail {

using vector3d = three_vector<double>;

/// R v of a rotation by θ about a unit vector n is `along` + cos θ `across` + sin θ `beside`.
struct turned_vector {
  vector3d along, across, beside;

  turned_vector(const vector3d& n, const vector3d& v)
      : along(dot(n, v) * n), across(v - along), beside(cross(n, v)) {}

  [[nodiscard]] vector3d at(double theta) const {
    return along + std::cos(theta) * across + std::sin(theta) * beside;
  }
};

/// The angle by which a turn about n takes u to v; 0 where u is on n.
[[nodiscard]] inline double angle_about(const vector3d& n, const vector3d& u, const vector3d& v) {
  const double sine = dot(n, cross(u, v)), cosine = dot(u, v) - dot(n, u) * dot(n, v);
  return sine * sine + cosine * cosine > 1e-40 ? std::atan2(sine, cosine) : 0.;
}
[[nodiscard]] inline bool is_on(const vector3d& n, const vector3d& v) {
  constexpr double rounding = 1e-9;
  return length_of(cross(n, v)) < rounding;
}
/// Is it unknown by which angle about n v turns? Angles that count as one may have put it on n.
[[nodiscard]] inline bool is_lost(const vector3d& n, const vector3d& v) {
  return length_of(cross(n, v)) < 2 * one_angle;
}

/// The angle of a rotation about n.
[[nodiscard]] inline double angle_of(const quaternion<double>& q, const vector3d& n) {
  return 2 * std::atan2(n.x * q.x() + n.y * q.y() + n.z * q.z(), q.w());
}

/// The product of the rotations by α and β about axes a and b.
[[nodiscard]] inline quaternion<double> two_turns(const vector3d& a, double alpha,
                                                  const vector3d& b, double beta) {
  const sines_at_once<2> halves(alpha / 2, beta / 2);
  return turn_about(a, halves.sine(0), halves.cosine(0)) *
         turn_about(b, halves.sine(1), halves.cosine(1));
}

/// Calls visit(α, β, γ, multiplicity) where turns by α, β and γ about the axes of three joints are,
/// one after the other, a given one.
/// \return false where α or β are undetermined; an undetermined α is 0
template <class Visit>
bool visit_three_turns(const loop_joint& a, const loop_joint& b, const loop_joint& c,
                       const quaternion<double>& turn, const Visit& visit) {
  // The last axis stays where it is in the last turn, the angle between it and the first in that.
  const turned_vector last(b.axis, c.axis);
  const vector3d goal = rotated(turn, c.axis);
  bool is_determined = true;
  const bool has_beta =
      visit_zeros({dot(a.axis, last.along) - dot(a.axis, goal), dot(a.axis, last.across),
                   dot(a.axis, last.beside)},
                  [&](double beta, int multiplicity) {
                    const vector3d from = last.at(beta);
                    const bool is_free = is_on(a.axis, from);
                    const double alpha = is_free ? 0. : angle_about(a.axis, from, goal);
                    is_determined = is_determined && !is_lost(a.axis, from);
                    const quaternion<double> before = two_turns(a.axis, alpha, b.axis, beta);
                    visit(alpha, beta, angle_of(conj(before) * turn, c.axis), multiplicity);
                  });
  return has_beta && is_determined;
}

} // namespace duet::detail
