// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/vector_sine_cosine.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/robotics/branches/angle_pairs.hpp>
#include <duet/robotics/branches/connecting_rotation.hpp>
#include <duet/robotics/branches/loop_equation.hpp>
#include <duet/robotics/planning_model.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

/// \file
/// Rotations about given axes whose product is a given rotation.

namespace duet::detail {

[[nodiscard]] inline bool is_on(const vector3d& n, const vector3d& v) {
  constexpr double rounding = 1e-9;
  return length_of(cross(n, v)) < rounding;
}
/// Angle of a rotation about n.
[[nodiscard]] inline double angle_of(const quaternion<double>& q, const vector3d& n) {
  return 2 * std::atan2(n.x * q.x() + n.y * q.y() + n.z * q.z(), q.w());
}

/// Product of the rotations by α and β about axes a and b.
[[nodiscard]] inline quaternion<double> rotation_product(const vector3d& a, double alpha,
                                                         const vector3d& b, double beta) {
  const sines_at_once<2> halves(alpha / 2, beta / 2);
  return rotation_about_axis(a, halves.sine(0), halves.cosine(0)) *
         rotation_about_axis(b, halves.sine(1), halves.cosine(1));
}

/// Two rotations, first by β about b, then by α about a, that map one unit vector to another:
/// Paden–Kahan subproblem 2 for directions.
class subproblem2 {
public:
  struct solution {
    double alpha = 0, beta = 0;
    int multiplicity = 1;
  };

  /// Solves for both angles.
  ///
  /// \param error  error of the vectors, if it exceeds round-off
  subproblem2(const vector3d& a, const vector3d& b, const vector3d& from, const vector3d& to,
              double error = 0) {
    const rotating_vector by_b(b, from);
    connecting_rotation first(a, by_b, to);
    const bool has_beta = visit_zeros(
        {dot(a, by_b.along) - dot(a, to), dot(a, by_b.across), dot(a, by_b.normal)},
        [&](double near_beta, int near_multiplicity) {
          first(near_beta, 0, near_multiplicity, [&](double beta, double, double alpha, int m) {
            all_[std::size_t(count_++)] = {alpha, beta, m};
          });
        },
        error);
    nearest_ = !has_beta ? 0 : first.nearest();
    if (error > 0) {
      nearest_ = std::min(nearest_, length_of(cross(a, to)));
    }
  }

  [[nodiscard]] const solution* begin() const { return all_.data(); }
  [[nodiscard]] const solution* end() const { return all_.data() + count_; }
  /// Smallest distance of the rotated vector from the axis a; 0 if α or β is undetermined. With an
  /// error, which near the axis decides whether angles are complex, the distance of the target
  /// vector counts, too.
  [[nodiscard]] double nearest() const { return nearest_; }

private:
  std::array<solution, 4> all_; // two values of β, each of which may have a neighbour
  int count_ = 0;
  double nearest_ = 0;
};

/// Calls visit(α, β, γ, multiplicity) for each decomposition of a rotation into successive
/// rotations by α, β and γ about the axes of three joints.
///
/// \param error  error of the rotation, if it exceeds round-off
/// \return the sine of the smallest angle between the last axis and the first; 0 if
/// α or β is undetermined
template <class Visit>
double for_each_three_axis_decomposition(const loop_joint& a, const loop_joint& b,
                                         const loop_joint& c, const quaternion<double>& rotation,
                                         const Visit& visit, double error = 0) {
  // The last rotation leaves its axis invariant; the first one preserves the angle between that
  // axis and its own.
  const subproblem2 both(a.axis, b.axis, c.axis, rotated(rotation, c.axis), error);
  for (const auto& [alpha, beta, multiplicity] : both) {
    const quaternion<double> before = rotation_product(a.axis, alpha, b.axis, beta);
    visit(alpha, beta, angle_of(conj(before) * rotation, c.axis), multiplicity);
  }
  return both.nearest();
}

} // namespace duet::detail
